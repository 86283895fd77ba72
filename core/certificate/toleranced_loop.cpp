// SPDX-License-Identifier: MIT
#include "core/certificate/toleranced_loop.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace fettle::core::certificate {
namespace {

constexpr int most_newton_steps = 30;
constexpr int most_rounds = 8;
constexpr double largest_only = 0.25;    // [rad], or of the loop's size
constexpr double smallest_only = 1e-12;  // the same
constexpr double follows = 1e-9;         // what conditions that follow may be off by, of the size

using Rows = std::vector<TaylorModel>;

struct PlacedClosure {
    ModelPose a, b;
    std::vector<PlacedScrew> screws_a, screws_b;
    Model3 point_a, axis_a, point_b, axis_b;
};

PlacedClosure placed(const ModelledClosure& closure, const std::vector<TaylorModel>& positions) {
    PlacedClosure out;
    out.a = pose_along(closure.line_a, positions, &out.screws_a);
    out.b = pose_along(closure.line_b, positions, &out.screws_b);
    out.point_a = times(out.a.rotation, closure.point_a) + out.a.place;
    out.point_b = times(out.b.rotation, closure.point_b) + out.b.place;
    out.axis_a = times(out.a.rotation, closure.axis_a);
    out.axis_b = times(out.b.rotation, closure.axis_b);
    return out;
}

// All conditions of all closures.
Rows conditions(const ModelledLoop& loop, const std::vector<TaylorModel>& positions) {
    Rows out;
    for (const ModelledClosure& closure : loop.closures) {
        const PlacedClosure at = placed(closure, positions);
        const Model3 apart = at.point_a - at.point_b, tilt = cross(at.axis_a, at.axis_b);
        for (const TaylorModel& x : apart) out.push_back(x);
        for (const TaylorModel& x : tilt) out.push_back(scaled(loop.size, x));
    }
    return out;
}

Model3 scaled3(double by, const Model3& x) { return {scaled(by, x[0]), scaled(by, x[1]), scaled(by, x[2])}; }

// d(chosen conditions)/d(unknowns), row by row.
std::vector<Rows> jacobian(const ModelledLoop& loop, const std::vector<TaylorModel>& positions) {
    const std::size_t n = loop.unknowns.size();
    std::vector<Rows> out(n, Rows(n));
    for (std::size_t c = 0; c < loop.closures.size(); ++c) {
        const PlacedClosure at = placed(loop.closures[c], positions);
        for (std::size_t j = 0; j < n; ++j) {
            Model3 apart{}, tilt{};
            const auto add = [&](const std::vector<PlacedScrew>& screws, const Model3& point, bool is_a) {
                for (const PlacedScrew& screw : screws) {
                    if (screw.position != loop.unknowns[j]) continue;
                    const double sign = is_a ? 1 : -1;
                    const Model3 moved =
                        scaled3(sign * screw.turn, cross(screw.axis, point - screw.point)) + scaled3(sign * screw.slide, screw.axis);
                    apart = apart + moved;
                    const Model3 turned = scaled3(screw.turn, cross(screw.axis, is_a ? at.axis_a : at.axis_b));
                    tilt = tilt + (is_a ? cross(turned, at.axis_b) : cross(at.axis_a, turned));
                }
            };
            add(at.screws_a, at.point_a, true);
            add(at.screws_b, at.point_b, false);
            for (std::size_t i = 0; i < n; ++i) {
                const auto row = static_cast<std::size_t>(loop.rows[i]);
                if (row / closure_rows != c) continue;
                const std::size_t k = row % closure_rows;
                out[i][j] = k < 3 ? apart[k] : scaled(loop.size, tilt[k - 3]);
            }
        }
    }
    return out;
}

MatrixX centers_of(const std::vector<Rows>& rows) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    MatrixX out(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) out(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].center;
    return out;
}

Rows chosen(const ModelledLoop& loop, const Rows& all) {
    Rows out;
    for (const int row : loop.rows) out.push_back(all[static_cast<std::size_t>(row)]);
    return out;
}

TaylorModel row_times(const MatrixX& a, Eigen::Index row, const Rows& x) {
    TaylorModel out;
    for (std::size_t k = 0; k < x.size(); ++k) out = out + scaled(a(row, static_cast<Eigen::Index>(k)), x[k]);
    return out;
}

class Krawczyk {
public:
    Krawczyk(const ModelledLoop& loop, std::vector<TaylorModel> positions) : loop_(loop), positions_(std::move(positions)) {}

    std::optional<LoopEnclosure> run(const std::vector<double>& guess) {
        if (!find_middle(guess) || !find_slopes()) return std::nullopt;
        const auto n = static_cast<Eigen::Index>(loop_.unknowns.size());
        const Rows residual = chosen(loop_, conditions(loop_, at_linear(VectorX::Zero(n))));
        VectorX off(n);
        for (Eigen::Index i = 0; i < n; ++i) off[i] = row_times(inverse_, i, residual).magnitude();
        if (!off.allFinite()) return std::nullopt;
        // The widest box in which the solution is the only one; then how near it is.
        for (double share = largest_only; share > smallest_only; share /= 4) {
            VectorX w(n);
            for (Eigen::Index i = 0; i < n; ++i) w[i] = share;
            VectorX image = image_of(off, w);
            if (!((image - w).maxCoeff() < 0)) continue;  // also what is no number
            found_.only.assign(w.begin(), w.end());
            // Its width beyond |A F| is squared each time.
            for (int round = 0; round < most_rounds; ++round) {
                const VectorX narrower = image.cwiseMin(image_of(off, image));
                const bool is_done = narrower.sum() > 0.9 * image.sum();
                image = narrower;
                if (is_done) break;
            }
            found_.rest.assign(image.begin(), image.end());
            if (!others_follow(image)) return std::nullopt;
            return std::move(found_);
        }
        return std::nullopt;
    }

private:
    std::vector<TaylorModel> at_linear(const VectorX& rest) const {
        std::vector<TaylorModel> out = positions_;
        for (std::size_t i = 0; i < loop_.unknowns.size(); ++i) {
            TaylorModel x = found_.linear[i];
            x.rest = rest[static_cast<Eigen::Index>(i)];
            out[static_cast<std::size_t>(loop_.unknowns[i])] = x;
        }
        return out;
    }

    // By Newton's method, in the middle of the box.
    bool find_middle(const std::vector<double>& guess) {
        std::vector<TaylorModel> middle;
        for (const TaylorModel& x : positions_) middle.emplace_back(x.center);
        std::vector<double> z = guess;
        for (int step = 0; step < most_newton_steps; ++step) {
            for (std::size_t i = 0; i < z.size(); ++i) middle[static_cast<std::size_t>(loop_.unknowns[i])] = TaylorModel(z[i]);
            const Rows off = chosen(loop_, conditions(loop_, middle));
            VectorX f(static_cast<Eigen::Index>(off.size()));
            for (std::size_t i = 0; i < off.size(); ++i) f[static_cast<Eigen::Index>(i)] = off[i].center;
            const Eigen::FullPivLU<MatrixX> lu(centers_of(jacobian(loop_, middle)));
            if (!f.allFinite() || !lu.isInvertible()) return false;
            inverse_ = lu.inverse();
            const VectorX way = inverse_ * f;
            if (!way.allFinite() || way.cwiseAbs().maxCoeff() > 1) return false;
            for (std::size_t i = 0; i < z.size(); ++i) z[i] -= way[static_cast<Eigen::Index>(i)];
            if (way.cwiseAbs().maxCoeff() > 1e-13) continue;
            for (const double value : z) found_.linear.emplace_back(value);
            return true;
        }
        return false;
    }

    // - A dF/dt.
    bool find_slopes() {
        const auto n = static_cast<Eigen::Index>(loop_.unknowns.size());
        const Rows off = chosen(loop_, conditions(loop_, at_linear(VectorX::Zero(n))));
        for (std::size_t k = 0; k < most_variables; ++k) {
            VectorX slope(n);
            for (Eigen::Index i = 0; i < n; ++i) slope[i] = off[static_cast<std::size_t>(i)].slopes[k];
            const VectorX z = -inverse_ * slope;
            if (!z.allFinite()) return false;
            for (Eigen::Index i = 0; i < n; ++i) found_.linear[static_cast<std::size_t>(i)].slopes[k] = z[i];
        }
        return true;
    }

    // |A F| + |1 - A dF/dz| w, upper bounds.
    VectorX image_of(const VectorX& off, const VectorX& w) const {
        const std::vector<Rows> slopes = jacobian(loop_, at_linear(w));
        const Eigen::Index n = w.size();
        VectorX out = off;
        for (Eigen::Index j = 0; j < n; ++j) {
            Rows column;
            for (Eigen::Index i = 0; i < n; ++i) column.push_back(slopes[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
            for (Eigen::Index i = 0; i < n; ++i) {
                const TaylorModel left = TaylorModel(i == j ? 1 : 0) - row_times(inverse_, i, column);
                out[i] += left.magnitude() * w[j];
            }
        }
        return out * (1 + 0x1p-45);
    }

    bool others_follow(const VectorX& rest) const {
        const Rows all = conditions(loop_, at_linear(rest));
        for (std::size_t row = 0; row < all.size(); ++row) {
            if (std::find(loop_.rows.begin(), loop_.rows.end(), static_cast<int>(row)) != loop_.rows.end()) continue;
            if (!(all[row].magnitude() <= follows * loop_.size)) return false;
        }
        return true;
    }

    const ModelledLoop& loop_;
    std::vector<TaylorModel> positions_;
    MatrixX inverse_;
    LoopEnclosure found_;
};

}  // namespace

std::vector<TaylorModel> LoopEnclosure::positions() const {
    std::vector<TaylorModel> out = linear;
    for (std::size_t i = 0; i < out.size(); ++i) out[i].rest = rest[i];
    return out;
}

std::optional<LoopEnclosure> enclosed_loop(const ModelledLoop& loop, std::vector<TaylorModel> positions, const std::vector<double>& guess) {
    return Krawczyk(loop, std::move(positions)).run(guess);
}

bool is_same_branch(const LoopEnclosure& of, const LoopEnclosure& in) {
    for (std::size_t i = 0; i < of.linear.size(); ++i) {
        const double apart = (of.linear[i] - in.linear[i]).magnitude();
        if (!(apart + of.rest[i] < (1 - 1e-12) * in.only[i])) return false;
    }
    return true;
}

}  // namespace fettle::core::certificate
