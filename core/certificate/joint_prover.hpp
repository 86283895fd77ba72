// SPDX-License-Identifier: MIT
/// How far the bodies of a stored path are, between its nodes, from where joints and motors would have them (ideal_joints.hpp): proven, in
/// interval arithmetic.
///
/// Let z = (dq_i, phi_i) move every body i that the rows move away from its place on the path, x = q_i(s) + dq_i + exp([phi_i]) R_i(s) X,
/// and F(z; s) = 0 be the rows at the segment's time at s, as many as there are z. With A any matrix, C(z; s) = dF/dz, and a box |z| <= b,
///   |A F(0; s)| + |1 - A C| b < b   for all s and all z of the box
/// says that z - A F(z; s) maps the box into its inside, for every s: so there is one zero of F in it (Krawczyk), which is where the rows
/// have the bodies, and it moves continuously with s. Then no point of body i is farther from its ideal place than |b_q| + |b_phi| r_i.
/// - C over a span of s and the box: the rows' gradients (constraint/row.hpp) of vectors that are enclosed by their value at the middle of
///   the span, the span's half length times their speed, and the box's turn; their part in phi times the left Jacobian, which is within
///   |phi|/2 of 1. A is the inverse at the middle.
/// - F(0; s): off the line through its values at the span's ends by a share of its second derivative, from 0 to e^2/2, e half the span, the
///   same for all rows. That is enclosed as C is, from z' = omega x z and z'' = omega' x z + omega x (omega x z). Motors' curves leave
///   their chord by what their knots do and by their own second derivative.
/// Angles are counted by the nodes: less than half a turn between two of them. A span over which the box cannot be found is halved.
#pragma once

#include <string>
#include <vector>

#include "core/certificate/ideal_joints.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::certificate {

struct ProvenDeviations {
    std::vector<double> of_body;  ///< as IdealJoints::bodies, the largest over the path [m]; empty if there is a fault
    std::string fault;            ///< where it could not be proven, and why
};

/// Bodies that more rows than this connect are not dealt with.
inline constexpr int most_rows = 300;

/// Contract: check_joints found nothing; the trajectory is the model's. Deviations claimed are not looked at.
ProvenDeviations prove_deviations(const IdealJoints& joints, const model::Model& model, const stepper::Trajectory& trajectory);

}  // namespace fettle::core::certificate
