// SPDX-License-Identifier: MIT
#include "core/certificate/toleranced_prover.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/limits.hpp"

namespace fettle::core::certificate {
namespace {

constexpr std::size_t most_models_kept = 64;  // boxes of deviations
constexpr double fine_rest = 1e-6;            // of the bodies' size: models of all deviations with less are good for parts of them

std::vector<int> vertices_of(const Region& region) {
    std::vector<int> out(region.vertices.begin(), region.vertices.end());
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

}  // namespace

TolerancedProver::TolerancedProver(const Toleranced& toleranced, const TolerancedPair& pair, const Matrix3X& a, const Matrix3X& b)
    : formulas_(std::make_shared<const PairFormulas>(toleranced, pair, a, b)) {
    for (std::size_t k = 0; k < pair.coordinates.size(); ++k) {
        const LinkageCoordinate& c = toleranced.coordinates[pair.coordinates[k]];
        box_.low[k] = c.low;
        box_.high[k] = c.high;
        base_.low[k] = base_.high[k] = c.start;
    }
    for (std::size_t j = 0; j < pair.deviations.size(); ++j) {
        const Deviation& d = toleranced.deviations[pair.deviations[j]];
        const std::size_t k = pair.coordinates.size() + j;
        box_.low[k] = d.lower;
        box_.high[k] = d.upper;
        base_.low[k] = base_.high[k] = d.base;
    }
    for (const Matrix3X* vertices : {&a, &b})
        if (vertices->cols() > 0) size_ += std::sqrt(vertices->colwise().squaredNorm().maxCoeff());
    whole_ = std::make_shared<const ModelledPair>(formulas_->over(box_));
    whole_rest_ = largest_rest(*whole_);
    if (is_bounded()) loops_ = std::make_shared<const LoopSlices>(*formulas_, *whole_, box_, base_);
}

std::optional<std::vector<double>> TolerancedProver::dependents_at(const VariableBox::Values& at) {
    if (formulas_->loops().empty()) return std::vector<double>{};
    const PlacedPair found = placed_anew({at, at});
    if (!found.is_known) return std::nullopt;
    std::vector<double> out;
    for (std::size_t k = static_cast<std::size_t>(formulas_->coordinates()); k < found.positions.size(); ++k)
        out.push_back(found.positions[k].center);
    return out;
}

std::shared_ptr<const ModelledPair> TolerancedProver::models(const VariableBox& box) {
    std::vector<double> key;
    for (int k = formulas_->coordinates(); k < formulas_->variables(); ++k) {
        const auto i = static_cast<std::size_t>(k);
        key.push_back(box.low[i]);
        key.push_back(box.high[i]);
    }
    bool is_point = true;
    for (std::size_t i = 0; i + 1 < key.size(); i += 2) is_point = is_point && key[i] == key[i + 1];
    // Made of given dimensions the bodies have no rest but rounding, and are hardly ever asked for again.
    if (is_point && !key.empty()) return std::make_shared<const ModelledPair>(formulas_->over(box));
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    const bool is_fine = whole_rest_ <= fine_rest * size_;
    const auto found = std::make_shared<const ModelledPair>(is_fine ? restricted(*whole_, box_, box) : formulas_->over(box));
    if (known_.size() > most_models_kept) known_.clear();
    return known_[key] = found;
}

const PlacedPair& TolerancedProver::placed(const VariableBox& box) {
    if (!last_ || !(last_box_ == box)) {
        last_ = placed_anew(box);
        last_box_ = box;
    }
    return *last_;
}

PlacedPair TolerancedProver::placed_anew(const VariableBox& box) {
    PlacedPair out;
    out.models = models(box);
    out.positions = formulas_->positions_over(box);
    out.is_known = formulas_->loops().empty() || (loops_ && loops_->fault().empty() && loops_->enclose(box, *out.models, out.positions));
    if (!out.is_known) return out;
    const ModelPose a = pose_along(out.models->line_a, out.positions), b = pose_along(out.models->line_b, out.positions);
    out.rotation = product(transposed(b.rotation), a.rotation);
    out.place = transposed_times(b.rotation, a.place - b.place);
    return out;
}

long TolerancedProver::prove(const Region& a, const Region& b, const VariableBox& box, char kind, std::span<const Vector3> normals,
                             double lower) {
    const std::size_t wanted_vectors = kind == still_leaf ? 1 : 1 + static_cast<std::size_t>(formulas_->variables());
    if (normals.size() != wanted_vectors) return 0;
    for (const Vector3& normal : normals)
        if (!normal.allFinite() || !(normal.norm() < 1e6)) return 0;
    if (!(normals[0].norm() > 1e-6)) return 0;
    const PlacedPair& at = placed(box);
    const std::vector<int> of_a = vertices_of(a), of_b = vertices_of(b);
    if (kind == turning_leaf) return least_turning(at, turning_vector(normals), of_a, of_b) >= lower ? 1 : 0;
    const double length = norm_bound(Interval3{normals[0][0], normals[0][1], normals[0][2]});
    return least_along(at, normals[0], of_a, of_b) >= (Interval(lower) * Interval(length)).high ? 1 : 0;
}

std::optional<Interval> TolerancedProver::distance_at(const geometry::Mesh& mesh_a, const CertifiedPoint& a, const geometry::Mesh& mesh_b,
                                                      const CertifiedPoint& b, const VariableBox::Values& at) {
    const PlacedPair placed_pair = placed_anew({at, at});
    if (!placed_pair.is_known) return Interval{0, infinity};
    Interval3 X_a, X_b;
    const auto of_a = [&](int v) { return intervals(placed_pair.models->a[v]); };
    const auto of_b = [&](int v) { return intervals(placed_pair.models->b[v]); };
    if (!point_of(mesh_a, a, of_a, X_a) || !point_of(mesh_b, b, of_b, X_b)) return std::nullopt;
    Interval squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        Interval x = placed_pair.place[i].interval() - X_b[i];
        for (std::size_t j = 0; j < 3; ++j) x = x + placed_pair.rotation[i][j].interval() * X_a[j];
        if (!std::isfinite(x.low) || !std::isfinite(x.high)) return Interval{0, infinity};
        squares = squares + square(x);
    }
    return sqrt(squares);
}

double TolerancedProver::mismatch_at_base(const kinematics::Pose& pose_a, const kinematics::Pose& pose_b, const Matrix3X& a,
                                          const Matrix3X& b) {
    const PlacedPair& at = placed(base_);
    if (!at.is_known) return infinity;
    const auto distance = [](const Model3& x, const Vector3& y) { return norm_bound(intervals(x - exact_model(y))); };
    double of_a = 0, of_b = 0, radius = 0;
    for (Eigen::Index v = 0; v < a.cols(); ++v) {
        of_a = std::max(of_a, distance(at.models->a[static_cast<std::size_t>(v)], a.col(v)));
        radius = std::max(radius, a.col(v).norm());
    }
    for (Eigen::Index v = 0; v < b.cols(); ++v) of_b = std::max(of_b, distance(at.models->b[static_cast<std::size_t>(v)], b.col(v)));
    const Matrix3 rotation = pose_b.rotation.transpose() * pose_a.rotation;
    const Vector3 place = pose_b.rotation.transpose() * (pose_a.position - pose_b.position);
    double turned = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        turned += distance(at.rotation[i], rotation.row(row).transpose());
    }
    const double sum = of_a + of_b + turned * radius * 1.001 + distance(at.place, place);
    // The products of doubles above are off by less than this.
    return sum * (1 + 1e-12) + 1e-14 * (radius + pose_a.position.norm() + pose_b.position.norm());
}

double TolerancedProver::witness_room(const Interval3&, const Interval3&) {
    const PlacedPair& at = placed(base_);
    return 1e-11 * (size_ + norm_bound(intervals(at.place))) * (1 + norm_bound(intervals(at.place))) + 1e-300;
}

}  // namespace fettle::core::certificate
