// SPDX-License-Identifier: MIT
/// Certified clearance: proven bounds of the least distance of pairs of bodies, over the continuous curved path.
///   lower <= min over the time range of dist(A(t), B(t)) <= upper,   rounding error charged to `lower`.
/// A theorem about the meshes as stored and the path as stored (method.md section 8), not about samples.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::core::clearance {

enum class PairStatus {
    clear,      ///< lower >= minimum
    violated,   ///< upper < minimum
    undecided,  ///< the minimum lies between the bounds, closer than the tolerance (or the budget ran out)
    contact     ///< minimum is 0 and the bodies come within the activation distance: reported, not judged
};
const char* to_string(PairStatus status);

/// Which two primitives are closest, when, and where.
struct Witness {
    int step = -1;              ///< of the trajectory; -1: as assembled (the start pose)
    int segment = 0;            ///< of the step's path
    double s = 0;               ///< in [0, 1] along that segment
    double time = 0;            ///< [s]
    bool edge_edge = false;     ///< else a vertex of `vertex_body` against a triangle of the other
    bool vertex_on_a = true;    ///< vertex-triangle: is the vertex on body a?
    int primitive_a = -1;       ///< index into a's mesh: vertex, triangle or edge
    int primitive_b = -1;
    Vector3 point_a = Vector3::Zero();  ///< world [m]
    Vector3 point_b = Vector3::Zero();
};

struct PairRequest {
    int a = 0, b = 0;           ///< bodies
    double minimum = 0;         ///< required clearance [m]
};

struct ClearanceOptions {
    double tolerance = 1e-6;    ///< wanted upper - lower [m]
    bool motion = false;        ///< over the whole trajectory; false: at poses[0]
    long max_evaluations = 50'000'000;         ///< box pairs per pair of bodies; beyond it: undecided with true bounds
    std::function<void(int done, int of)> on_pair;  ///< optional progress
};

struct PairClearance {
    int a = 0, b = 0;
    double minimum = 0;
    double lower = 0, upper = 0;   ///< [m]
    PairStatus status = PairStatus::undecided;
    Witness witness;               ///< attains `upper`
};

/// Bounds for each pair asked for, in their order. The path of `trajectory` must be of the model's bodies.
std::vector<PairClearance> certify_clearance(const model::Model& model, const stepper::Trajectory& trajectory,
                                             const std::vector<PairRequest>& pairs, const ClearanceOptions& options);

/// The start configuration as a trajectory without steps.
stepper::Trajectory as_assembled(const model::Model& model);

}  // namespace fettle::core::clearance
