// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/generated_part.hpp"

#include <catch2/catch.hpp>

namespace fettle::design::shapes::generated_part_test {

TEST_CASE("every generator is a shape: as drawn it is what generate makes, and its derivative too") {
    for (const GeneratorInfo& info : generator_table()) {
        INFO(info.name);
        const auto part = GeneratedPart::create(info.name, {});
        const auto shape = generate(info.name, {});
        REQUIRE(part);
        REQUIRE(shape);
        REQUIRE((*part)->dimensions().size() == info.dimensions.size());
        for (size_t k = 0; k < info.dimensions.size(); ++k) {
            CHECK((*part)->dimensions()[k].name == shape->dimensions[k]);
            CHECK((*part)->dimensions()[k].value == info.dimensions[k].default_value);
        }
        const auto drawn = design::description::as_drawn(**part);
        REQUIRE(drawn);
        CHECK(core::geometry::have_same_shape(drawn->mesh, shape->mesh));
        for (size_t k = 0; k < shape->jacobian.size(); ++k) CHECK(drawn->jacobian[k] == shape->jacobian[k]);
        CHECK((*part)->is_always_solid());
    }
}

TEST_CASE("a generated part keeps the dimensions it was drawn with, and refuses those of no part") {
    const auto part = GeneratedPart::create("pin", {{"radius", 3e-3}}, {.segments = 12});
    REQUIRE(part);
    CHECK((*part)->dimensions()[0].value == 3e-3);
    CHECK((*part)->at({4e-3, 1e-2})->mesh.vertices.topRows<2>().colwise().norm().maxCoeff() == Approx(4e-3));
    CHECK_FALSE((*part)->at({-1e-3, 1e-2}));
    CHECK_FALSE(GeneratedPart::create("pin", {{"radios", 3e-3}}));
    CHECK_FALSE(GeneratedPart::create("pim", {}));
}

}  // namespace fettle::design::shapes::generated_part_test
