// SPDX-License-Identifier: MIT
// Handles of a mesh: for each kind its exact derivative and its formulas, corners that stay bit for bit; refusals with their place.
#include "core/features/handled_mesh.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "core/expression/tape.hpp"
#include "core/solids/mesh_validity.hpp"
#include "tests/core/features/known_parts.hpp"

namespace fettle::core::features::handled_mesh_test {

using namespace known_parts;  // NOLINT(google-build-using-namespace)

namespace {

// A block of 40 x 20 x 6 mm with bores of 4 mm at its middle and of 2 mm at x = 14 mm, and a post of 3 mm on it at x = -12 mm, 5 mm high.
geometry::Mesh block() {
    return drawn_mesh([](Drawing& d) {
        const auto profile = with_holes(*filled(rectangle({-20 * mm, -10 * mm}, 40 * mm, 20 * mm, "block")),
                                        {circle({}, 4 * mm, "middle"), circle({14 * mm, 0}, 2 * mm, "side")});
        const auto plate = extruded(d, *profile, 0, 6 * mm);
        const auto post = extruded(d, *filled(circle({-12 * mm, 0}, 3 * mm, "post")), 5 * mm, 11 * mm);
        return united(d, {*plate, *post});
    });
}

const Feature* flat_face(const Features& features, const Vector3& axis, double height) {
    for (const Feature& feature : features.features)
        if (feature.surface.kind == SurfaceKind::plane && std::abs(feature.surface.axis.dot(axis)) > 0.999 &&
            std::abs(axis.dot(feature.surface.point) - height) < 1e-6)
            return &feature;
    return nullptr;
}

std::string name_of_bore(const Features& features, double radius) {
    for (const Feature& feature : features.features)
        if (feature.is_hole && std::abs(feature.surface.radius - radius) < 0.1 * mm) return feature.name;
    return "none";
}

HandleRegion box(const Vector3& low, const Vector3& high, double falloff = 0) {
    return {.kind = HandleRegion::Kind::box, .low = low, .high = high, .falloff = falloff};
}

struct Known {
    geometry::Mesh mesh = block();
    Features features = find_features(mesh);
    std::string middle = name_of_bore(features, 4 * mm), side = name_of_bore(features, 2 * mm);
    std::string top_of_post = flat_face(features, Vector3::UnitZ(), 11 * mm)->name;
    std::string right = flat_face(features, Vector3::UnitX(), 20 * mm)->name, left = flat_face(features, Vector3::UnitX(), -20 * mm)->name;

    // One of each kind, and a value beside the drawn one.
    std::vector<std::pair<Handle, double>> each() const {
        Matrix3X twisted = mesh.vertices;
        twisted.row(1) += 0.1 * twisted.row(0);
        return {{{.name = "bore", .kind = HandleKind::radius, .features = {middle}}, 4.3 * mm},
                {{.name = "hole", .kind = HandleKind::diameter, .features = {side}, .holes = true}, 3.6 * mm},
                {{.name = "post", .kind = HandleKind::radius, .features = {"P1"}, .holes = false}, 2.5 * mm},
                {{.name = "height", .kind = HandleKind::offset, .features = {top_of_post}}, 1.5 * mm},
                {{.name = "width", .kind = HandleKind::offset, .features = {right, left}}, -0.8 * mm},
                {{.name = "place", .kind = HandleKind::move, .features = {side}, .axis = Vector3(0.6, 0.8, 0)}, 1.1 * mm},
                {{.name = "shear",
                  .kind = HandleKind::move,
                  .region = box({20.5 * mm, -11 * mm, -1 * mm}, {22 * mm, 11 * mm, 12 * mm}, 2 * mm),
                  .axis = Vector3::UnitY()},
                 0.7 * mm},
                {{.name = "swing",
                  .kind = HandleKind::turn,
                  .region = box({-16 * mm, -4 * mm, -1 * mm}, {-8 * mm, 4 * mm, 12 * mm}),
                  .axis = Vector3::UnitZ(),
                  .point = Vector3(-12 * mm, 0, 0)},
                 0.2},
                {{.name = "longer", .kind = HandleKind::stretch, .from = 6 * mm, .to = 9 * mm}, 5 * mm},
                {{.name = "bulge",
                  .kind = HandleKind::lattice,
                  .region = box({-21 * mm, -11 * mm, -1 * mm}, {21 * mm, 11 * mm, 12 * mm}),
                  .axis = Vector3::UnitZ(),
                  .lattice = {3, 3, 3},
                  .controls = {{1, 1, 1}, {1, 1, 2}}},
                 0.5 * mm},
                {{.name = "twist", .kind = HandleKind::morph, .target = twisted}, 0.3}};
    }

    HandledMesh with(const std::vector<Handle>& handles, double wall = 0) const {
        const auto made = HandledMesh::create(mesh, handles, wall);
        REQUIRE(made);
        return *made;
    }
    std::string refusal(const Handle& handle) const {
        const auto made = HandledMesh::create(mesh, {handle});
        return made ? "" : made.errors().front().where + ": " + made.errors().front().message;
    }
    std::string fault(const Handle& handle, double value, double wall = 0) const {
        const auto made = with({handle}, wall).at({value});
        return made ? "" : made.errors().front().where + ": " + made.errors().front().message;
    }
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("handles: of each kind the derivative is that of differences, and the formulas are what is made") {
    const Known known;
    std::vector<Handle> all;
    std::vector<double> drawn, moved;
    for (const auto& [handle, value] : known.each()) {
        CAPTURE(handle.name);
        const HandledMesh part = known.with({handle});
        CHECK(part.at({part.drawn_value(0)})->vertices == known.mesh.vertices);
        const double step = 1e-3 * std::abs(value - part.drawn_value(0));
        const auto before = part.at({value - step}), here = part.at({value}), after = part.at({value + step});
        for (const auto* made : {&before, &here, &after})
            if (!*made) FAIL(made->errors().front().where + ": " + made->errors().front().message);
        CHECK(solids::validate_mesh(*here, {}).empty());
        const Matrix3X slope = part.jacobian({value})[0], differences = (after->vertices - before->vertices) / (2 * step);
        CHECK(slope.norm() > 0);
        CHECK((slope - differences).norm() <= 1e-7 * slope.norm());
        int still = 0;
        for (int v = 0; v < known.mesh.vertices.cols(); ++v) {
            if (slope.col(v) != Vector3::Zero()) continue;
            ++still;
            CHECK(here->vertices.col(v) == known.mesh.vertices.col(v));
        }
        if (handle.kind != HandleKind::morph && handle.kind != HandleKind::lattice) CHECK(still > 0);
        const HandledMesh::Recorded recorded = part.recorded({value});
        const std::vector<double> inputs{value};
        const std::vector<double> nodes = expression::values<double>(recorded.nodes, std::span<const double>(inputs));
        REQUIRE(count_of(recorded.vertices) == known.mesh.vertices.cols());
        for (int v = 0; v < known.mesh.vertices.cols(); ++v)
            for (int k = 0; k < 3; ++k) CHECK(std::abs(nodes[recorded.vertices[v][k]] - here->vertices(k, v)) <= 1e-17);
        all.push_back(handle);
        drawn.push_back(part.drawn_value(0));
        moved.push_back(value);
    }
}

TEST_CASE("handles: radii, faces and places are what their values say") {
    const Known known;
    const auto features_of = [&](const Handle& handle, double value) { return find_features(*known.with({handle}).at({value})); };
    const auto wide = features_of({.name = "d", .kind = HandleKind::diameter, .features = {known.middle}}, 9 * mm);
    CHECK(name_of_bore(wide, 4.5 * mm) != "none");
    const auto high = features_of({.name = "h", .kind = HandleKind::offset, .features = {known.top_of_post}}, 2 * mm);
    CHECK(flat_face(high, Vector3::UnitZ(), 13 * mm) != nullptr);
    const auto broad = features_of({.name = "w", .kind = HandleKind::offset, .features = {known.left, known.right}}, 1 * mm);
    CHECK(flat_face(broad, Vector3::UnitX(), 21 * mm) != nullptr);
    CHECK(flat_face(broad, Vector3::UnitX(), -21 * mm) != nullptr);
    const auto placed = features_of({.name = "p", .kind = HandleKind::move, .features = {known.side}, .axis = Vector3::UnitY()}, 2 * mm);
    const Feature& side = placed.features[placed.find(name_of_bore(placed, 2 * mm))];
    CHECK(side.origin.y() == Approx(2 * mm).epsilon(1e-9));
    CHECK(side.origin.x() == Approx(14 * mm).epsilon(1e-9));
    const auto longer = features_of({.name = "l", .kind = HandleKind::stretch, .from = 6 * mm, .to = 9 * mm}, 5 * mm);
    CHECK(flat_face(longer, Vector3::UnitX(), 25 * mm) != nullptr);
    const Feature& moved = longer.features[longer.find(name_of_bore(longer, 2 * mm))];
    CHECK(moved.origin.x() == Approx(19 * mm).epsilon(1e-9));
    // A slanted wall keeps its plane when the face above it is raised.
    const auto wedge = drawn_mesh([](Drawing& d) {
        return extruded(d, *filled(polygon({{0, 0}, {10 * mm, 0}, {6 * mm, 8 * mm}, {0, 8 * mm}}, "wedge")), 0, 5 * mm);
    });
    const Features faces = find_features(wedge);
    const auto raised = HandledMesh::create(
        wedge, {{.name = "up", .kind = HandleKind::offset, .features = {flat_face(faces, Vector3::UnitY(), 8 * mm)->name}}});
    REQUIRE(raised);
    const auto up = raised->at({1 * mm});
    REQUIRE(up);
    CHECK(find_features(*up).features.size() == faces.features.size());
    CHECK(up->vertices.row(1).maxCoeff() == Approx(9 * mm));
}

TEST_CASE("handles: several at once add up, and corners of two faces follow both") {
    const Known known;
    const HandledMesh part = known.with({{.name = "bore", .kind = HandleKind::radius, .features = {known.middle}},
                                         {.name = "end", .kind = HandleKind::offset, .features = {known.right}},
                                         {.name = "longer", .kind = HandleKind::stretch, .from = 6 * mm, .to = 9 * mm}});
    const auto made = part.at({3.5 * mm, 1 * mm, 4 * mm});
    REQUIRE(made);
    CHECK(solids::validate_mesh(*made, {}).empty());
    const Features found = find_features(*made);
    CHECK(name_of_bore(found, 3.5 * mm) != "none");
    CHECK(flat_face(found, Vector3::UnitX(), 25 * mm) != nullptr);
    const HandledMesh sides =
        known.with({{.name = "x", .kind = HandleKind::offset, .features = {known.right}},
                    {.name = "y", .kind = HandleKind::offset, .features = {flat_face(known.features, Vector3::UnitY(), 10 * mm)->name}}});
    const auto larger = sides.at({1 * mm, 2 * mm});
    REQUIRE(larger);
    CHECK(larger->vertices.row(0).maxCoeff() == Approx(21 * mm));
    CHECK(larger->vertices.row(1).maxCoeff() == Approx(12 * mm));
    CHECK(find_features(*larger).features.size() == known.features.features.size());
}

TEST_CASE("handles: what the mesh does not have, and what would spoil it, is refused with its place") {
    const Known known;
    CHECK(contains(known.refusal({.name = "h", .features = {"B9"}}), "h: the mesh has no feature `B9`"));
    CHECK(contains(known.refusal({.name = "h", .features = {known.right}}), "is of another kind"));
    CHECK(contains(known.refusal({.name = "h", .features = {"P1"}, .holes = true}), "is of another kind"));
    CHECK(contains(known.refusal({.name = "h", .features = {known.middle, known.side}}), "a handle is of one radius"));
    CHECK(contains(known.refusal({.name = "h", .kind = HandleKind::morph, .target = Matrix3X::Zero(3, 4)}), "4 corners"));
    CHECK(contains(known.refusal({.name = "h", .kind = HandleKind::move, .region = box(Vector3::Constant(1), Vector3::Constant(2))}),
                   "moves nothing"));
    const Handle bore{.name = "bore", .features = {known.middle}};
    CHECK(contains(known.fault(bore, 0), "more than 0 is expected"));
    CHECK(known.fault(bore, 13 * mm) != "");  // beyond the other bore and the edge
    CHECK(contains(known.fault(bore, 7.5 * mm, 3 * mm), known.middle + ": a wall of "));
    CHECK(known.fault(bore, 6.5 * mm, 3 * mm).empty());
    const Handle low{.name = "height", .kind = HandleKind::offset, .features = {known.top_of_post}};
    CHECK(known.fault(low, -6 * mm) != "");  // below the plate
    const Handle across{.name = "longer", .kind = HandleKind::stretch, .from = 13 * mm, .to = 15 * mm};
    CHECK(contains(known.fault(across, 3 * mm), "longer: " + known.side + " near"));
    CHECK(contains(known.fault(across, 3 * mm), "would bend"));
    const Handle out{.name = "place", .kind = HandleKind::move, .features = {known.side}, .axis = Vector3::UnitZ()};
    CHECK(contains(known.fault(out, 1 * mm), "would bend"));
    const Handle sheared{.name = "lean",
                         .kind = HandleKind::move,
                         .region = box({-16 * mm, -4 * mm, 7 * mm}, {-8 * mm, 4 * mm, 12 * mm}),
                         .axis = Vector3::UnitY()};
    CHECK(contains(known.fault(sheared, 1 * mm), "lean: P1 near"));
    const Handle away{.name = "place", .kind = HandleKind::move, .features = {known.side}, .axis = Vector3::UnitX()};
    CHECK(known.fault(away, 5 * mm) != "");  // over the edge of the block
}

}  // namespace fettle::core::features::handled_mesh_test
