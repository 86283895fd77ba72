// SPDX-License-Identifier: MIT
/// Pieces of scene files in the paper's format, to put together in tests.
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "core/scene_files/scene_reader.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::paper_scenes::test_support {

/// A tetrahedron, as text to splice into a body.
inline const std::string tet =
    R"("vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "edges": [[0,1],[0,2],[0,3],[1,2],[1,3],[2,3]], "faces": [[0,2,1],[0,1,3],[0,3,2],[1,2,3]])";

/// The scene of one body.
inline scene::Scene scene_with_body(const std::string& body, const std::string& top = "") {
    const auto scene = scene_files::parse_scene("{" + top + R"("rigid_body_problem": {"rigid_bodies": [{)" + body + "}]}}", "fixture.json");
    REQUIRE(scene);
    return *scene;
}

using fettle::tests::support::contains;

}  // namespace fettle::core::paper_scenes::test_support
