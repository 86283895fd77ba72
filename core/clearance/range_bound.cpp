// SPDX-License-Identifier: MIT
#include "core/clearance/range_bound.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/rounding.hpp"
#include "core/clearance/segment_bound.hpp"
#include "core/kinematics/rotation.hpp"

namespace fettle::core::clearance {
namespace {

using certificate::LinkedPair;
using certificate::Screw;
using kinematics::Pose;

ScrewedBody screwed_body(const std::vector<Screw>& screws, const Coordinates& start, const Pose& pose) {
    ScrewedBody out{screws, {}, {}, pose};
    for (std::size_t j = 0; j < screws.size(); ++j) {
        out.starts.push_back(start[screws[j].coordinate]);
        double tilt = 0;
        for (std::size_t i = 0; i < j; ++i)
            if (screws[i].turn != 0) tilt += 2 * screws[i].axis.cross(screws[j].axis).norm();
        out.tilt.push_back(tilt + 0x1p-48);
    }
    return out;
}

// A screw as a motion of the world.
Pose motion_of(const Screw& screw, double d) {
    const Matrix3 turn = kinematics::rotation(Vector3(screw.turn * d * screw.axis));
    return {turn, screw.point - turn * screw.point + screw.slide * d * screw.axis};
}

Pose after(const Pose& outer, const Pose& inner) {
    return {outer.rotation * inner.rotation, outer.rotation * inner.position + outer.position};
}

// How large numbers get, and how far angles.
double slack_of(const ScrewedPair& pair) {
    double reach = pair.a.radius() + pair.b.radius(), angle = 0;
    std::size_t screws = 0;
    for (const ScrewedBody* body : {&pair.body_a, &pair.body_b}) {
        reach += body->start.position.norm();
        for (const Screw& screw : body->screws) {
            const auto k = static_cast<std::size_t>(screw.coordinate);
            const double d = pair.ranges.high[k] - pair.ranges.low[k];
            reach += screw.point.norm() + std::abs(screw.slide) * d;
            angle = std::max(angle, std::abs(screw.turn) * d);
        }
        screws += body->screws.size();
    }
    return 64 * base::unit_roundoff * static_cast<double>(4 + screws) * (1 + angle) * reach;
}

double line_distance(const Screw& screw, const Vector3& y) { return screw.axis.cross(y - screw.point).norm(); }

// n.x over a piece at a pose, the least.
double least(const Vector3& n, const Pose& pose, const Piece& piece, const Corners* element) {
    const Vector3 f = pose.rotation.transpose() * n;
    const double offset = n.dot(pose.position);
    if (element != nullptr) return (f.transpose() * element->x).minCoeff() + offset;
    return f.dot(piece.center) - (piece.axes.transpose() * f).cwiseAbs().dot(piece.half_extent) + offset;
}

Corners placed_corners(const Corners& element, const Pose& pose) {
    Corners out = element;
    out.x = (pose.rotation * element.x).colwise() + pose.position;
    return out;
}

}  // namespace

Coordinates middle_of(const CoordinateBox& box) {
    Coordinates out{};
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = 0.5 * (box.low[k] + box.high[k]);
    return out;
}

ScrewedPair screwed_pair(const PieceTree& a, const PieceTree& b, const certificate::Linkage& linkage, const LinkedPair& linked,
                         const Pose& start_a, const Pose& start_b) {
    ScrewedPair out{a, b, {}, {}, count_of(linked.coordinates), {}, {}, {}, 0};
    std::array<int, most_coordinates> screws{};
    for (std::size_t k = 0; k < linked.coordinates.size(); ++k) {
        const certificate::LinkageCoordinate& c = linkage.coordinates[linked.coordinates[k]];
        out.start[k] = c.start;
        out.ranges.low[k] = c.low;
        out.ranges.high[k] = c.high;
    }
    for (const auto* side : {&linked.a, &linked.b})
        for (const Screw& screw : *side) ++screws[screw.coordinate];
    for (std::size_t k = 0; k < screws.size(); ++k) out.is_single[k] = screws[k] == 1;
    out.body_a = screwed_body(linked.a, out.start, start_a);
    out.body_b = screwed_body(linked.b, out.start, start_b);
    out.slack = slack_of(out);
    out.revolution = revolution_of(linked);
    return out;
}

Pose moved(const Screw& screw, double d, const Pose& pose) { return after(motion_of(screw, d), pose); }

Pose pose_of(const ScrewedBody& body, const Coordinates& at) {
    Pose out = body.start;
    for (std::size_t j = body.screws.size(); j-- > 0;) out = moved(body.screws[j], at[body.screws[j].coordinate] - body.starts[j], out);
    return out;
}

BoxBound::BoxBound(const ScrewedPair& pair, const CoordinateBox& box)
    : pair_(pair), a_(view_of(pair.body_a, box)), b_(view_of(pair.body_b, box)) {
    for (std::size_t k = 0; k < half_.size(); ++k) half_[k] = 0.5 * (box.high[k] - box.low[k]) * base::rounded_up;
}

BoxBound::View BoxBound::view_of(const ScrewedBody& body, const CoordinateBox& box) const {
    View out{body, body.start, std::vector<Pose>(std::size_t{1} << pair_.count, body.start), std::vector<Pose>(body.screws.size())};
    const Coordinates middle = middle_of(box);
    for (std::size_t j = body.screws.size(); j-- > 0;) {
        const Screw& screw = body.screws[j];
        const auto k = static_cast<std::size_t>(screw.coordinate);
        out.inner[j] = out.middle;
        out.middle = moved(screw, middle[k] - body.starts[j], out.middle);
        const Pose low = motion_of(screw, box.low[k] - body.starts[j]), high = motion_of(screw, box.high[k] - body.starts[j]);
        for (std::size_t c = 0; c < out.corners.size(); ++c) out.corners[c] = after((c >> k & 1) != 0 ? high : low, out.corners[c]);
    }
    return out;
}

ElementPairDistance BoxBound::distance(const Corners& a, const Corners& b, int corner) const {
    const auto c = static_cast<std::size_t>(corner);
    return element_pair_distance(placed_corners(a, corner < 0 ? a_.middle : a_.corners[c]),
                                 placed_corners(b, corner < 0 ? b_.middle : b_.corners[c]));
}

BoxBound::Radii BoxBound::radii(const View& view, const Piece& piece, const Corners* element) const {
    Radii out{};
    double moved = 0;
    for (std::size_t j = view.body.screws.size(); j-- > 0;) {
        const Screw& screw = view.body.screws[j];
        const double half = half_[screw.coordinate];
        double r = 0;
        if (element != nullptr) {
            for (int i = 0; i < element->count; ++i)
                r = std::max(r, line_distance(screw, kinematics::world_position(view.inner[j], element->x.col(i))));
        } else {
            r = line_distance(screw, kinematics::world_position(view.inner[j], piece.center)) + piece.size;
        }
        out[j] = (r + moved + pair_.slack) * base::rounded_up;
        moved += (std::min(std::abs(screw.turn) * half, 2.0) * out[j] + std::abs(screw.slide) * half) * base::rounded_up;
    }
    return out;
}

// `change`: how much the vectors differ along each coordinate, at most; all 0: they are one.
void BoxBound::add_losses(const View& view, const Radii& r, const std::vector<Vector3>& normals, const Coordinates& change,
                          Losses& losses) const {
    for (std::size_t j = 0; j < view.body.screws.size(); ++j) {
        const Screw& screw = view.body.screws[j];
        const auto k = static_cast<std::size_t>(screw.coordinate);
        const double turn = std::abs(screw.turn) * half_[k], slide = std::abs(screw.slide) * half_[k];
        double across = 0;
        for (const Vector3& n : normals) across = std::max(across, n.cross(screw.axis).norm());
        across = std::min(1.0, across + view.body.tilt[j]);
        double arc = 0.5 * turn * turn;
        if (pair_.is_single[k] && normals.size() == 1) arc = std::min(arc, 2.0);
        double loss = arc * r[j] * across + 0.5 * change[k] * (turn * r[j] + slide);
        for (std::size_t i = 0; i < j; ++i)
            if (view.body.screws[i].coordinate == screw.coordinate)
                loss += std::abs(view.body.screws[i].turn) * half_[k] * (turn * r[j] + slide);
        losses.along[k] += loss * base::rounded_up;
        losses.total += loss * base::rounded_up;
    }
}

RangeBound BoxBound::bound(const std::array<double, 1 << most_coordinates>& values, double at_middle, const Losses& losses) const {
    RangeBound out;
    double low = std::numeric_limits<double>::infinity(), widest = -1;
    for (int c = 0; c < corners(); ++c) low = least_of(low, values[c]);
    out.lower = low - losses.total * base::rounded_up - pair_.slack;
    out.loosened = at_middle - out.lower;
    for (std::size_t k = 0; k < static_cast<std::size_t>(pair_.count); ++k) {
        double spread = losses.along[k];
        for (std::size_t c = 0; c < static_cast<std::size_t>(corners()); ++c)
            if ((c >> k & 1) == 0) spread = std::max(spread, losses.along[k] + 0.5 * std::abs(values[c | std::size_t{1} << k] - values[c]));
        if (!(spread > widest)) continue;
        widest = spread;
        out.widest = static_cast<int>(k);
    }
    return out;
}

RangeBound BoxBound::along(const Vector3& n, const Piece& a, const Piece& b, const Corners* element_a, const Corners* element_b) const {
    Losses losses;
    const std::vector<Vector3> normals{n};
    if (pair_.count > 0) {
        add_losses(a_, radii(a_, a, element_a), normals, {}, losses);
        add_losses(b_, radii(b_, b, element_b), normals, {}, losses);
    }
    std::array<double, 1 << most_coordinates> values{};
    const auto apart = [&](const Pose& pose_a, const Pose& pose_b) {
        return least(n, pose_a, a, element_a) + least(Vector3(-n), pose_b, b, element_b);
    };
    for (int c = 0; c < corners(); ++c) {
        const auto i = static_cast<std::size_t>(c);
        values[i] = apart(a_.corners[i], b_.corners[i]);
    }
    return bound(values, apart(a_.middle, b_.middle), losses);
}

RangeBound BoxBound::along(const std::vector<Vector3>& normals, const Corners& element_a, const Corners& element_b) const {
    const Piece none;
    Coordinates change{};
    std::array<double, 1 << most_coordinates> values{};
    double most = 0;
    for (std::size_t c = 0; c < normals.size(); ++c) {
        values[c] = least(normals[c], a_.corners[c], none, &element_a) + least(Vector3(-normals[c]), b_.corners[c], none, &element_b);
        most = std::max(most, values[c]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(pair_.count); ++k)
            if ((c >> k & 1) == 0)
                change[k] = std::max(change[k], (normals[c | std::size_t{1} << k] - normals[c]).norm() * base::rounded_up);
    }
    Losses losses;
    add_losses(a_, radii(a_, none, &element_a), normals, change, losses);
    add_losses(b_, radii(b_, none, &element_b), normals, change, losses);
    return bound(values, most, losses);
}

}  // namespace fettle::core::clearance
