// SPDX-License-Identifier: MIT
#include "tests/support/chain_net.hpp"

#include <catch2/catch.hpp>

#include "core/scene_files/scene_reader.hpp"
#include "tests/support/shared_files.hpp"

namespace fettle::tests::support::chain_net_test {

TEST_CASE("the generated net of 4 x 4 is the paper's", "[support]") {
    FETTLE_NEEDS_SHARED();
    for (const auto& [name, mesh] : {std::pair{"chain/chain-net/chain-net-4x4", "wrecking-ball/link.obj"},
                                     std::pair{"codimensional/edges/chain-net-4x4", "codimensional/edges/link.obj"}}) {
        INFO(name);
        const std::string path = shared_file(std::string("scenes/fixtures/") + name + ".json");
        const auto theirs = core::scene_files::read_scene(path), ours = core::scene_files::parse_scene(chain_net_scene(4, mesh), path);
        REQUIRE(theirs.has_value());
        REQUIRE(ours.has_value());
        CHECK(ours->timestep == theirs->timestep);
        CHECK(ours->end_time == theirs->end_time);
        CHECK(ours->gravity == theirs->gravity);
        REQUIRE(ours->bodies.size() == theirs->bodies.size());
        for (std::size_t i = 0; i < ours->bodies.size(); ++i) {
            const auto &a = ours->bodies[i], &b = theirs->bodies[i];
            INFO(i);
            CHECK(a.type == b.type);
            CHECK(a.density == b.density);
            CHECK(a.pose.position == b.pose.position);
            CHECK(a.pose.rotation == b.pose.rotation);
            CHECK(a.mesh.vertices == b.mesh.vertices);
        }
    }
}

TEST_CASE("a net of n x n has its bodies and its links", "[support]") {
    FETTLE_NEEDS_SHARED();
    const std::string path = (shared_folder() / "scenes/fixtures/chain/chain-net/generated.json").string();
    for (const int n : {3, 8}) {
        const auto scene = core::scene_files::parse_scene(chain_net_scene(n), path);
        REQUIRE(scene.has_value());
        CHECK(count_of(scene->bodies) == n * n - 4 + 2 * (n - 2) * (n - 1));
    }
}

}  // namespace fettle::tests::support::chain_net_test
