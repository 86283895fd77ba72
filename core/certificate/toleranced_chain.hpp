// SPDX-License-Identifier: MIT
/// Bodies one on the other, moved by screws, as Taylor models over a box: where the last one is (toleranced_prover.hpp), and how it moves
/// with each screw (toleranced_loop.hpp).
#pragma once

#include <optional>
#include <vector>

#include "core/certificate/taylor_model.hpp"

namespace fettle::core::certificate {

struct ModelPose {
    ModelMatrix rotation;
    Model3 place;
};
ModelPose unmoved_pose();
ModelPose composed(const ModelPose& outer, const ModelPose& inner);
Model3 exact_model(const Vector3& x);
Model3 cross(const Model3& a, const Model3& b);
geometry::Interval3 intervals(const Model3& x);

/// A screw goes by shift + scale d of its position's d.
struct ChainDrive {
    TaylorModel scale, shift;
};

struct ChainScrew {
    int position = 0;  ///< whose value moves it, in a list of positions
    Model3 point, axis;
    double turn = 0, slide = 0, start = 0;
    std::optional<ChainDrive> driven{};
};

/// Leads from a body's frame to the frame of whatever it hangs on.
struct ChainLink {
    std::vector<ChainScrew> screws;
    ModelMatrix rotation;
    Model3 place;
};

/// A screw where the chain has it: in the frame of the chain's first parent. The position of a driven one is not how far it goes.
struct PlacedScrew {
    int position = 0;
    double turn = 0, slide = 0;
    Model3 point, axis;
};

/// @param line  outermost first. @param screws  if not null, all of them are added, outermost first
ModelPose pose_along(const std::vector<ChainLink>& line, const std::vector<TaylorModel>& positions,
                     std::vector<PlacedScrew>* screws = nullptr);

}  // namespace fettle::core::certificate
