// SPDX-License-Identifier: MIT
/// The mathematics of a box of tolerances (toleranced.hpp): bounds of the distance of two bodies over a box of their variables, coordinates
/// of joints and deviations together, in Taylor models (taylor_model.hpp), whose rounding is theirs. The checker accepts what this proves;
/// the search (clearance/toleranced_search.hpp) asks it which directions are good ones.
///
/// Let t be the variables over a box, each scaled to [-1, 1], and let R, q put body a into body b's frame. For a vector n that is fixed in
/// that frame, and vertices X_a(t), X_b(t),
///   s_a(t) = n.(R(t) X_a(t) + q(t)),   s_b(t) = n.X_b(t)
/// are numbers whose dependence on t is known to first order, and what they leave of it, to second. So
///   |n| dist >= min over t of min over a of s_a - max over b of s_b
///            >= min over pairs of vertices of (center - sum over k |slope_a,k - slope_b,k| - rest_a - rest_b),
/// in which what moves both alike cancels. Pieces of many vertices have, with any m,
///            >= min over a of (center_a - sum |slope_a,k - m_a,k| - rest_a) - max over b of (...) - sum |m_a,k - m_b,k|.
/// For two elements the vector may turn, n(t) = n_0 + sum over k of n_k t_k, as the direction between their nearest points does: then
///   max |n(t)| dist >= min over t and pairs of vertices of n(t).(x_a(t) - x_b(t)).
/// Which of the two it is is a leaf's kind. What either loses is of second order in the box, and not in the number of its variables: the
/// one that stays may be the best for the corner of the box where the bodies are nearest; the other keeps faces and edges apart that tilt.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/certificate/certified_body.hpp"
#include "core/certificate/loop_slices.hpp"
#include "core/certificate/placed_pair.hpp"
#include "core/certificate/toleranced.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::certificate {

/// Its functions are those of PathProver (interval_motion.hpp).
class TolerancedProver {
public:
    using Box = VariableBox;

    /// Contract: checked; the pair is of it, with at most most_coordinates and most_deviations.
    /// @param a, b  Vertices of the bodies' meshes, of those that have no formulas. Must stay where they are.
    TolerancedProver(const Toleranced& toleranced, const TolerancedPair& pair, const Matrix3X& a, const Matrix3X& b);

    int coordinates() const { return formulas_->variables(); }
    const VariableBox& box() const { return box_; }

    /// Valid until another box is asked for. The last one is kept: the pieces of a box are bounded one after the other.
    const PlacedPair& placed(const VariableBox& box);

    /// 1: the vector proves dist >= lower over the box; 0: it does not.
    long prove(const Region& a, const Region& b, const VariableBox& box, char kind, std::span<const Vector3> normals, double lower);
    /// Nothing: they are no points of the meshes.
    std::optional<Interval> distance_at(const geometry::Mesh& mesh_a, const CertifiedPoint& a, const geometry::Mesh& mesh_b,
                                        const CertifiedPoint& b, const VariableBox::Values& at);
    /// How far a point of body a is at most, as seen from b, from where the meshes and poses at hand have it, where all variables are at
    /// their base [m].
    double mismatch_at_base(const kinematics::Pose& pose_a, const kinematics::Pose& pose_b, const Matrix3X& a, const Matrix3X& b);
    /// Rounding of a witness's distance [m].
    double witness_room(const Interval3& X_a, const Interval3& X_b);
    /// Do all of its formulas have values, and bounded derivatives, over all of the box?
    bool is_bounded() const { return whole_rest_ < HUGE_VAL; }
    /// Why a loop is not known over all of its range; empty: it is.
    std::string loop_fault() const { return loops_ ? loops_->fault() : std::string(); }
    /// Those of the pair, in doubles; nothing where a loop is not known.
    std::optional<std::vector<double>> dependents_at(const VariableBox::Values& at);
    /// Sum of the bodies' radii [m].
    double size() const { return size_; }

private:
    std::shared_ptr<const ModelledPair> models(const VariableBox& box);
    PlacedPair placed_anew(const VariableBox& box);

    std::shared_ptr<const PairFormulas> formulas_;
    VariableBox box_, base_;
    std::map<std::vector<double>, std::shared_ptr<const ModelledPair>> known_;
    std::shared_ptr<const ModelledPair> whole_;  // over all of the box
    double whole_rest_ = 0, size_ = 0;
    VariableBox last_box_;
    std::optional<PlacedPair> last_;
    std::shared_ptr<const LoopSlices> loops_;  // null: not bounded
};

}  // namespace fettle::core::certificate
