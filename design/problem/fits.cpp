// SPDX-License-Identifier: MIT
#include "design/problem/fits.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/clearance/clearance.hpp"
#include "core/constraint/row.hpp"
#include "core/contact/contact_set.hpp"
#include "core/contact/round_contacts.hpp"
#include "core/model/row_choice.hpp"

namespace fettle::design::problem {

namespace {

using core::contact::ContactPair;
using core::kinematics::Pose;
using core::model::Model;

// What joints, motors and held coordinates leave free where the bodies are: a basis, orthonormal where a turn counts by the body's radius.
class FreeMotions {
public:
    FreeMotions(const Model& model, const std::vector<Pose>& poses) : model_(model), dofs_(core::model::free_dofs(model)) {
        const core::model::Mechanism& mechanism = model.mechanism;
        const core::constraint::RowJacobian rows = core::constraint::row_jacobian(mechanism.set, core::model::all_rows(mechanism),
                                                                                  core::measure::placed(mechanism.set.frames, poses));
        if (rows.count() == 0 || dofs_.count == 0) {
            basis_ = MatrixX::Identity(dofs_.count, dofs_.count);
            return;
        }
        MatrixX columns = MatrixX::Zero(dofs_.count, rows.count());
        for (int r = 0; r < rows.count(); ++r)
            for (int e = rows.first[r]; e < rows.first[r + 1]; ++e) add(rows.entries[e].body, rows.entries[e].gradient, columns.col(r));
        for (int r = 0; r < rows.count(); ++r)
            if (const double size = columns.col(r).norm(); size > 0) columns.col(r) /= size;
        Eigen::ColPivHouseholderQR<MatrixX> qr(columns);
        qr.setThreshold(1e-9);
        const MatrixX q = qr.householderQ() * MatrixX::Identity(dofs_.count, dofs_.count);
        basis_ = q.rightCols(dofs_.count - qr.rank());
    }

    bool is_still(int body) const { return core::linear::is_none_free(dofs_.index[body]); }

    // A gap's gradient in these motions; without entries where they change it hardly: the bodies slide past each other there, or are held.
    VectorX gradient(const std::vector<std::pair<int, Vector6>>& of_bodies) const {
        VectorX all = VectorX::Zero(dofs_.count);
        for (const auto& [body, of_body] : of_bodies) add(body, of_body, all);
        VectorX free = basis_.transpose() * all;
        if (!(free.norm() > core::contact::largest_slant)) return {};  // the normal's length is 1
        return free;
    }

private:
    template <class Column>
    void add(int body, const Vector6& gradient, Column&& to) const {
        const double radius = std::max(model_.bodies[body].radius, model_.dhat);
        for (int k = 0; k < 6; ++k)
            if (const int dof = dofs_.index[body][k]; dof >= 0) to[dof] += gradient[k] / (k < 3 ? 1 : radius);
    }

    const Model& model_;
    core::linear::FreeDofs dofs_;
    MatrixX basis_;
};

// How one contact keeps two bodies apart.
struct Side {
    VectorX direction;  ///< of the gap in the motions that are free, of length 1; empty: none of these changes it
    double rate = 0;    ///< of the gap along it
    double gap = 0;
};

// Gradient of the gap, whose line of action goes along `normal` through `place`.
Side side_along(const FreeMotions& motions, const std::vector<Pose>& poses, int first, int second, const Vector3& normal,
                const Vector3& place, double gap) {
    const auto of = [&](int body, const Vector3& n) {
        Vector6 gradient;
        gradient << n, (place - poses[body].position).cross(n);
        return std::pair<int, Vector6>(body, gradient);
    };
    VectorX gradient = motions.gradient({of(first, normal), of(second, -normal)});
    const double rate = gradient.norm();
    if (rate > 0) gradient /= rate;
    return {std::move(gradient), rate, gap};
}

// One, or where one circle lies within the other those all round.
std::vector<Side> sides_of(const FreeMotions& motions, const std::vector<Pose>& poses, int first, int second, const ContactPair& pair) {
    Vector3 place = Vector3::Zero();
    for (int i = 0; i < core::geometry::first_count(pair.type); ++i) place += pair.closest.weight[i] * pair.x[i];
    const Vector3 normal = core::contact::contact_normal(pair);
    const auto side = [&](const Vector3& along, double gap) { return side_along(motions, poses, first, second, along, place, gap); };
    if (!pair.round.has_far) return {side(pair.round.side < 0 ? Vector3(-normal) : normal, core::contact::gap_of(pair))};
    const double radius = pair.round.radius(), distance = std::sqrt(pair.closest.distance_squared);
    const Vector3 across = (pair.x[2] - pair.x[1]).cross(normal).normalized();
    return {side(-normal, radius - distance), side(normal, radius + distance), side(across, radius), side(-across, radius)};
}

// sum f gap / sum f of forces that hold each other, nothing where there are none: the point of the directions' hull that is nearest to 0
// (Gilbert's algorithm), which is 0 then.
std::optional<double> play_between(const std::vector<Side>& sides) {
    constexpr int most_steps = 1000;
    constexpr double nothing = 0.02;  // of a direction's length
    if (sides.empty()) return std::nullopt;
    VectorX share = VectorX::Zero(static_cast<Eigen::Index>(sides.size())), nearest = sides.front().direction;
    share[0] = 1;
    for (int step = 0; step < most_steps && nearest.norm() > nothing; ++step) {
        Eigen::Index best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (Eigen::Index k = 0; k < share.size(); ++k) {
            const double along = sides[k].direction.dot(nearest);
            if (along < least) {
                least = along;
                best = k;
            }
        }
        if (least > nothing * nearest.norm()) return std::nullopt;  // all of the hull lies on that side of 0
        const VectorX way = sides[best].direction - nearest;
        const double along = std::clamp(-nearest.dot(way) / way.squaredNorm(), 0.0, 1.0);
        nearest += along * way;
        share *= 1 - along;
        share[best] += along;
    }
    if (nearest.norm() > nothing) return std::nullopt;
    double play = 0, forces = 0;
    for (Eigen::Index k = 0; k < share.size(); ++k) {
        play += share[k] / sides[k].rate * sides[k].gap;
        forces += share[k] / sides[k].rate;
    }
    return play / forces;
}

std::pair<int, int> in_order(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

double Fits::play() const {
    if (fits.empty()) return 0;
    std::vector<double> plays;
    for (const Fit& fit : fits) plays.push_back(fit.play);
    const auto middle = plays.begin() + static_cast<long>((plays.size() - 1) / 2);
    std::nth_element(plays.begin(), middle, plays.end());
    return *middle;
}

Fits fits_of(const Model& model) {
    const std::vector<Pose> poses = core::clearance::as_assembled(model).poses.front();
    const FreeMotions motions(model, poses);
    Model reaching = model;
    reaching.dhat = fit_reach * model.dhat;
    const core::contact::ContactSet near = core::contact::find_contacts(reaching, core::ccd::find_candidates(reaching, poses, 0), poses);
    // Bodies that cannot move are one: what lies between two of them is kept from both sides.
    struct Between {
        std::set<std::pair<int, int>> bodies;
        std::vector<Side> sides;
    };
    std::map<std::pair<int, int>, Between> all;
    Fits out;
    out.nearest_other = std::numeric_limits<double>::infinity();
    const auto look_at_other = [&](double gap) {
        if (gap > model.dhat) out.nearest_other = std::min(out.nearest_other, gap);
    };
    const auto group = [&](int body) { return motions.is_still(body) ? -1 : body; };
    for (const core::contact::BodyPairContacts& list : near.pairs)
        for (const ContactPair& pair : list.contacts) {
            if (pair.weight < 0) continue;  // counted twice, taken off once
            for (Side& side : sides_of(motions, poses, list.first, list.second, pair)) {
                if (side.direction.size() == 0) {
                    look_at_other(side.gap);
                    continue;
                }
                Between& between = all[in_order(group(list.first), group(list.second))];
                between.bodies.insert(in_order(list.first, list.second));
                between.sides.push_back(std::move(side));
            }
        }
    for (const auto& [groups, between] : all) {
        const std::optional<double> play = play_between(between.sides);
        if (play)
            for (const auto& [a, b] : between.bodies) out.fits.push_back({a, b, *play});
        else
            for (const Side& side : between.sides) look_at_other(side.gap);
    }
    std::sort(out.fits.begin(), out.fits.end(), [](const Fit& x, const Fit& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
    return out;
}

std::optional<Touching> touching_without_fit(const Model& model, const core::stepper::Trajectory& motion, const Fits& fits) {
    std::set<std::pair<int, int>> known;  // fits, and what slides
    for (const Fit& fit : fits.fits) known.insert({fit.a, fit.b});
    for (int t = 0; t < count_of(motion.steps); ++t) {
        const std::vector<Pose>& poses = motion.poses[t + 1];
        std::optional<core::contact::ContactSet> found;
        const auto& kept = motion.steps[t].contacts;
        if (kept.empty()) found = core::contact::find_contacts(model, core::ccd::find_candidates(model, poses, 0), poses);
        std::optional<FreeMotions> motions;
        for (const core::contact::BodyPairContacts& list : (found ? *found : kept.back()->contacts).pairs) {
            if (known.count(in_order(list.first, list.second)) > 0) continue;
            if (!motions) motions.emplace(model, poses);
            for (const ContactPair& pair : list.contacts)
                for (const Side& side : sides_of(*motions, poses, list.first, list.second, pair))
                    if (side.gap < model.dhat && side.direction.size() > 0) {
                        const auto [a, b] = in_order(list.first, list.second);
                        return Touching{a, b, t};
                    }
            known.insert(in_order(list.first, list.second));
        }
    }
    return std::nullopt;
}

}  // namespace fettle::design::problem
