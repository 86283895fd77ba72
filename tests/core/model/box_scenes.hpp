// SPDX-License-Identifier: MIT
/// Boxes as a scene has them, and the one error that is expected, for the tests of models.
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/scene/scene.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::tests {

inline core::scene::Body box_body(const std::string& name, const Vector3& low, const Vector3& high) {
    core::scene::Body body;
    body.name = name;
    body.where = "a.scene.json#/bodies/" + name;
    body.mesh = box_mesh(low, high);
    return body;
}

inline core::scene::Scene scene_of(std::vector<core::scene::Body> bodies) {
    core::scene::Scene scene;
    scene.path = "a.scene.json";
    scene.bodies = std::move(bodies);
    return scene;
}

template <class T>
core::base::Error only_error(const core::base::Result<T>& result) {
    REQUIRE(result.errors().size() == 1);
    return result.errors().front();
}

}  // namespace fettle::tests
