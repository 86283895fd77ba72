// SPDX-License-Identifier: MIT
#include "core/stepper/rotation_lift.hpp"

#include <cmath>

#include "core/kinematics/rotation.hpp"

namespace fettle::core::stepper {
namespace {

constexpr double resolution = 1e-4;  // [rad]
constexpr double parallel_sine = 1e-12;
constexpr double longest_turn = 3;  // [rad]: beyond, a few samples could miss whole turns
constexpr int deepest = 20;         // halvings: then the rotation rests, and theta goes round a sphere of radius 2 pi k
constexpr double arc_angle = 0.01;  // of a chord of that sphere: it dips by 2 pi k angle^2/8 = 8e-5 k rad

// The rotation vector of `r` that is nearest to `guess`.
Vector3 nearest_branch(const Matrix3& r, const Vector3& guess) {
    const Vector3 principal = kinematics::rotation_vector(r);
    const double angle = principal.norm();
    if (angle <= parallel_sine && guess.isZero(0)) return principal;
    const Vector3 axis = angle > parallel_sine ? (principal / angle).eval() : guess.normalized();
    const double turns = std::round((guess.dot(axis) - angle) / (2 * M_PI));
    return (angle + 2 * M_PI * turns) * axis;
}

// The rotation vector of `r` on the branch whose size is nearest to that of `theta`.
Vector3 nearest_size(const Matrix3& r, const Vector3& theta) {
    const Vector3 principal = kinematics::rotation_vector(r);
    const double angle = principal.norm();
    if (angle <= parallel_sine) return theta;
    return (angle + 2 * M_PI * std::round((theta.norm() - angle) / (2 * M_PI))) * (principal / angle);
}

class Lift {
public:
    explicit Lift(std::vector<RotationNode>& out) : out_(out) {}

    void add(const Vector3& theta, const Vector3& turn, double from, double to, int depth) {
        if (theta.cross(turn).norm() <= parallel_sine * theta.norm() * turn.norm()) return out_.push_back({to, theta + turn});
        const Vector3 end = nearest_branch(kinematics::rotation(turn) * kinematics::rotation(theta), theta + turn);
        if (follows(theta, end, turn)) return out_.push_back({to, end});
        if (depth == deepest)
            return add_arc(theta, nearest_size(kinematics::rotation(turn) * kinematics::rotation(theta), theta), from, to);
        const double middle = 0.5 * (from + to);
        add(theta, 0.5 * turn, from, middle, depth + 1);
        const Vector3 reached = out_.back().theta;
        add(reached, 0.5 * turn, middle, to, depth + 1);
    }

private:
    static bool follows(const Vector3& theta, const Vector3& end, const Vector3& turn) {
        if (turn.norm() > longest_turn) return false;
        const Matrix3 start = kinematics::rotation(theta);
        for (const double s : {0.25, 0.5, 0.75}) {
            const Matrix3 off = kinematics::rotation(theta + s * (end - theta)) - kinematics::rotation(s * turn) * start;
            if (off.cwiseAbs().maxCoeff() > resolution) return false;
        }
        return true;
    }

    void add_arc(const Vector3& theta, const Vector3& end, double from, double to) {
        const Vector3 first = theta.normalized(), last = end.normalized();
        const double angle = std::atan2(first.cross(last).norm(), first.dot(last));
        const Vector3 across = (last - first.dot(last) * first).normalized();
        const int count = static_cast<int>(std::ceil(angle / arc_angle));
        for (int j = 1; j < count; ++j) {
            const double share = static_cast<double>(j) / count, radius = theta.norm() + share * (end.norm() - theta.norm());
            out_.push_back({from + share * (to - from), radius * (std::cos(share * angle) * first + std::sin(share * angle) * across)});
        }
        out_.push_back({to, end});
    }

    std::vector<RotationNode>& out_;
};

}  // namespace

std::vector<RotationNode> lifted_turn(const Vector3& theta, const Vector3& turn) {
    std::vector<RotationNode> out;
    Lift(out).add(theta, turn, 0, 1, 0);
    return out;
}

}  // namespace fettle::core::stepper
