// SPDX-License-Identifier: MIT
#include "core/certificate/joint_prover.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/base/limits.hpp"
#include "core/base/parallel.hpp"
#include "core/certificate/interval_motion.hpp"
#include "core/linear/factorisations.hpp"

namespace fettle::core::certificate {
namespace {

using constraint::Row;
using measure::Measure;
using measure::MeasureKind;

constexpr int most_halvings = 6, most_boxes = 12, tightening_halvings = 3;
constexpr double largest_turn = 1.4;     // of both bodies of an angle, over a segment [rad]: it changes by less than 3
constexpr double inflation = 1 + 1e-10;  // of sums of up to 300 products that are not negative: far more than their rounding
constexpr double unit = 0x1p-52;

// Everything within `radius` of it.
Interval widened(const Interval& x, double radius) { return x + Interval(-radius, radius); }
Interval3 widened(const Interval3& x, double radius) { return {widened(x[0], radius), widened(x[1], radius), widened(x[2], radius)}; }

double up(double x, double y) { return geometry::upper(x * y); }  // x y, rounded up

// Part of a segment.
struct Part {
    double start = 0, end = 1;
    double middle() const { return 0.5 * (start + end); }
    double half() const { return geometry::upper(0.5 * (end - start)); }
};

// One vector of a frame over a part of a segment: what it is from its body's reference point, and where; and its derivatives in s.
struct MovingVector {
    Interval3 arm{0, 0, 0}, place{0, 0, 0}, rate{0, 0, 0}, second{0, 0, 0};
};

// A body over a part of a segment.
struct MovingBody {
    IntervalPose middle;
    Interval3 place_middle, drift;
    Interval3 omega, omega_rate;
    double swept = 0;  // how much a vector of length 1 can turn away from where it is at the middle
};

MovingBody moving_body(const BodyPath& path, const Part& part) {
    MovingBody out;
    out.middle = pose_at(path, part.middle());
    out.place_middle = path.place + Interval(part.middle()) * path.drift;
    out.drift = path.drift;
    const double half = part.half(), theta = geometry::upper(norm_bound(path.theta) + path.speed);
    const Interval t(theta);
    // |omega'| <= |k| |w| (1/6 + |theta|/12 + |theta|^2/60): c, b_g and c_g are means of cosines and sincs (interval_motion.cpp).
    const double rate =
        (Interval(path.twist_norm) * Interval(path.speed) * (Interval(1) / Interval(6) + t / Interval(12) + square(t) / Interval(60))).high;
    out.omega = widened(out.middle.omega, up(half, rate));
    out.omega_rate = widened(Interval3{0, 0, 0}, rate);
    out.swept = up(up(half, path.speed), path.base_norm);
    return out;
}

// `swept`: how far the body's turn within the box and the part moves a vector of length 1; `shifted`: the box's way.
MovingVector moving_vector(const MovingBody& body, const Vector3& X, bool is_point, double half, double turned, double shifted) {
    MovingVector out;
    const Interval3 x = exactly(X), at_middle = times(body.middle.rotation, x);
    const Interval3 along = widened(at_middle, up(body.swept, norm_bound(x)));
    out.arm = widened(along, up(turned, norm_bound(along)));
    out.rate = cross(body.omega, along);
    out.second = cross(body.omega_rate, along) + cross(body.omega, out.rate);
    out.place = out.arm;
    if (!is_point) return out;
    const Interval3 at = body.place_middle + Interval(-half, half) * body.drift;
    out.place = widened(at, shifted) + out.arm;
    out.rate = out.rate + body.drift;
    return out;
}

struct Derivatives {
    Interval value, rate, second;  // in s
    Interval3 force_a{0, 0, 0}, torque_a{0, 0, 0}, force_b{0, 0, 0}, torque_b{0, 0, 0};
};

// u . v, u of frame a, v of frame b.
Derivatives product_of(const MovingVector& u, const MovingVector& v) {
    Derivatives out;
    out.value = dot(u.arm, v.arm);
    out.rate = dot(u.rate, v.arm) + dot(u.arm, v.rate);
    out.second = dot(u.second, v.arm) + Interval(2) * dot(u.rate, v.rate) + dot(u.arm, v.second);
    out.torque_a = cross(u.arm, v.arm);
    out.torque_b = cross(v.arm, u.arm);
    return out;
}

Derivatives angle_of(const Derivatives& sine, const Derivatives& cosine, bool& is_usable) {
    Derivatives out;
    const Interval d = square(sine.value) + square(cosine.value);
    is_usable = d.low > 0.5;
    if (!is_usable) return out;
    const Interval n = cosine.value * sine.rate - sine.value * cosine.rate;
    const Interval d_rate = Interval(2) * (cosine.value * cosine.rate + sine.value * sine.rate);
    out.rate = n / d;
    out.second = (cosine.value * sine.second - sine.value * cosine.second) / d - n * d_rate / square(d);
    const Interval of_sine = cosine.value / d, of_cosine = sine.value / d;
    out.torque_a = of_sine * sine.torque_a - of_cosine * cosine.torque_a;
    out.torque_b = of_sine * sine.torque_b - of_cosine * cosine.torque_b;
    // The angle itself, within whole turns: atan2 is good to some ulps, and moves by no more than its arguments do over |d|.
    const double s = 0.5 * (sine.value.low + sine.value.high), c = 0.5 * (cosine.value.low + cosine.value.high);
    const double off = (sine.value - Interval(s)).magnitude() + (cosine.value - Interval(c)).magnitude();
    out.value = widened(Interval(std::atan2(s, c)), 2 * off + 8 * unit * std::numbers::pi);
    return out;
}

// How far a curve leaves the straight line through its values at two times: at its knots, and between them by its second derivative.
double second_derivative_bound(const scene::Curve& curve) {
    const auto& v = curve.values;
    const auto& t = curve.times;
    double most = 0;
    if (curve.kind == scene::CurveKind::linear || v.size() < 2) return 0;
    if (curve.kind == scene::CurveKind::control_points) {
        // A cubic B-spline's first derivative has control points 3 (v[i + 1] - v[i])/(knots apart), its second twice their differences over
        // as much; of clamped uniform ones knots are at least a span apart there.
        double rise = 0;
        for (std::size_t i = 1; i < v.size(); ++i) rise = std::max(rise, std::abs(v[i] - v[i - 1]));
        const double span = (t.back() - t.front()) / static_cast<double>(v.size() - 3);
        return 2 * 2 * 3 * rise / (span * span);
    }
    for (std::size_t i = 1; i < t.size(); ++i) {
        const double length = t[i] - t[i - 1];
        double rise = std::abs(v[i] - v[i - 1]) / length;
        // The slopes at a cubic's entries are means of the neighbouring stretches'; its second derivative is at most
        // (6 rise + 4 slope + 2 slope)/length.
        if (i > 1) rise = std::max(rise, std::abs(v[i - 1] - v[i - 2]) / (t[i - 1] - t[i - 2]));
        if (i + 1 < t.size()) rise = std::max(rise, std::abs(v[i + 1] - v[i]) / (t[i + 1] - t[i]));
        most = std::max(most, (curve.kind == scene::CurveKind::trapezoid ? 4.5 : 6 + 6) * rise / length);
    }
    return most;
}

double chord_deviation(const scene::Curve& curve, double begin, double end) {
    if (curve.values.empty() && !curve.stop_time) return 0;
    const double low = curve_value(curve, begin), high = curve_value(curve, end), length = end - begin;
    std::vector<double> knots = curve.times;
    if (curve.stop_time) knots.push_back(*curve.stop_time);
    double most = 0;
    for (const double knot : knots)
        if (knot > begin && knot < end)
            most = std::max(most, std::abs(curve_value(curve, knot) - (low + (high - low) * (knot - begin) / length)));
    return inflation * (most + length * length / 8 * second_derivative_bound(curve));
}

// What a row's target may be off by, in doubles.
double target_rounding(const Row& row, double time) {
    double size = std::abs(row.constant) + std::abs(row.curve.rate * time);
    for (const double value : row.curve.values) size = std::max(size, std::abs(value));
    return 1e-14 * size;
}

struct Entry {
    int column = 0;
    Interval value;
};

// The rows over a part of a segment.
struct RowSystem {
    std::vector<std::vector<Entry>> entries;  // [row]
    std::vector<Interval> second;             // [row] second derivative in s
    std::vector<Interval> measured;           // [measure] angles within whole turns of what they are
};

class Prover {
public:
    Prover(const IdealJoints& joints, const model::Model& model, const stepper::Trajectory& trajectory)
        : joints_(joints), model_(model), trajectory_(trajectory), slots_(model.bodies.size(), -1), used_(joints.set.measures.size()) {
        for (std::size_t i = 0; i < joints.bodies.size(); ++i) {
            const auto body = static_cast<std::size_t>(joints.bodies[i]);
            slots_[body] = static_cast<int>(i);
            const auto& vertices = model.bodies[body].mesh.vertices;
            radii_.push_back(vertices.cols() > 0 ? vertices.colwise().norm().maxCoeff() * inflation : 0);
            size_ = std::max(size_, 1 + radii_.back());
        }
        for (const Row& row : joints.rows)
            for (const constraint::RowPart& part : row.parts) use(part.measure);
        std::sort(framed_.begin(), framed_.end());
        framed_.erase(std::unique(framed_.begin(), framed_.end()), framed_.end());
        count_turns();
    }

    ProvenDeviations run() const {
        ProvenDeviations out;
        std::vector<std::pair<int, int>> places;
        for (int t = 0; t < count_of(trajectory_.steps); ++t)
            for (int k = 0; k < segment_count(trajectory_, t); ++k) places.emplace_back(t, k);
        std::vector<std::vector<double>> found(places.size());
        std::vector<std::string> faults(places.size());
        base::parallel_for(count_of(places), 1, [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            const Segment segment = segment_of(places[at].first, places[at].second);
            faults[at] = refusal(segment);
            if (faults[at].empty() && !prove(segment, {0, 1}, most_halvings, found[at]))
                faults[at] = "joints are near a position where they leave the bodies more freedom, or path and joints are too far apart";
            if (!faults[at].empty()) faults[at] = "step " + std::to_string(segment.step + 1) + ": " + faults[at];
        });
        out.of_body.assign(joints_.bodies.size(), 0.0);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!faults[i].empty()) return {{}, faults[i]};
            for (std::size_t k = 0; k < out.of_body.size(); ++k) out.of_body[k] = std::max(out.of_body[k], found[i][k]);
        }
        return out;
    }

private:
    struct Segment {
        int step = 0, index = 0;
        std::vector<BodyPath> paths;  // of all bodies of frames; others empty
        double begin = 0, end = 0;    // [s]
    };
    struct Box {
        VectorX half;
    };

    void use(int measure) {
        const Measure& m = joints_.set.measures[measure];
        used_[measure] = true;
        for (const int frame : {m.a, m.b}) {
            const int body = joints_.set.frames[frame].body;
            if (body != measure::world) framed_.push_back(body);
        }
    }

    // Whole turns of each angle at each node, as they come from the start.
    void count_turns() {
        std::vector<double> angles;
        for (std::size_t t = 0; t < trajectory_.steps.size(); ++t) {
            turned_.emplace_back();
            for (const auto& node : trajectory_.steps[t].nodes) {
                std::vector<kinematics::Pose> poses;
                for (std::size_t i = 0; i < node.size(); ++i)
                    poses.push_back({kinematics::rotation(node[i].rotation_vector) * trajectory_.poses[t][i].rotation, node[i].position});
                angles = constraint::angles_at(joints_.set, poses, angles);
                turned_.back().push_back(angles);
            }
        }
    }

    Segment segment_of(int step, int index) const {
        Segment out{step, index, std::vector<BodyPath>(model_.bodies.size()), time_at(trajectory_, step, index, 0),
                    time_at(trajectory_, step, index, 1)};
        for (const int body : framed_) out.paths[body] = body_path(trajectory_, step, index, body);
        return out;
    }

    // What this way of proving does not deal with; empty: nothing.
    std::string refusal(const Segment& segment) const {
        if (count_of(joints_.rows) > most_rows) return "more than " + std::to_string(most_rows) + " rows of joints";
        const auto speed = [&](int frame) {
            const int body = joints_.set.frames[frame].body;
            return body == measure::world ? 0.0 : segment.paths[body].speed;
        };
        for (const BodyPath& path : segment.paths)
            if (!(path.magnitude < base::largest_magnitude)) return "numbers too large";
        for (std::size_t i = 0; i < used_.size(); ++i) {
            const Measure& m = joints_.set.measures[i];
            if (used_[i] && m.kind == MeasureKind::angle && !(speed(m.a) + speed(m.b) < largest_turn))
                return "bodies turn so far between two nodes that the direction is ambiguous";
        }
        return {};
    }

    Derivatives derivatives(const Measure& m, const std::vector<MovingBody>& bodies, double half, const Box* box, bool& is_usable) const {
        const auto vector = [&](int frame, int axis) {
            const measure::Frame& f = joints_.set.frames[frame];
            const bool is_point = axis < 0;
            const Vector3 X = is_point ? f.point : Vector3(f.axes.col(axis));
            if (f.body == measure::world) return MovingVector{is_point ? Interval3{0, 0, 0} : exactly(X), exactly(X), {0, 0, 0}, {0, 0, 0}};
            const int slot = slots_[f.body];
            double turned = 0, shifted = 0;
            if (box != nullptr && slot >= 0) {
                shifted = box->half.segment<3>(6 * slot).norm() * inflation;
                turned = box->half.segment<3>(6 * slot + 3).norm() * inflation;
            }
            return moving_vector(bodies[f.body], X, is_point, half, turned, shifted);
        };
        if (m.kind == MeasureKind::product) return product_of(vector(m.a, m.axis_a), vector(m.b, m.axis_b));
        if (m.kind == MeasureKind::angle) {
            const MovingVector x_b = vector(m.b, 0);
            return angle_of(product_of(vector(m.a, 1), x_b), product_of(vector(m.a, 0), x_b), is_usable);
        }
        const MovingVector x_a = vector(m.a, -1), x_b = vector(m.b, -1);
        MovingVector n{exactly(Vector3::Unit(m.axis_a)), {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        if (m.offset_axis == measure::OffsetAxis::of_a) n = vector(m.a, m.axis_a);
        if (m.offset_axis == measure::OffsetAxis::of_b) n = vector(m.b, m.axis_a);
        const Interval3 d = x_b.place - x_a.place, d_rate = x_b.rate - x_a.rate;
        Derivatives out;
        out.value = dot(n.arm, d);
        out.rate = dot(n.rate, d) + dot(n.arm, d_rate);
        out.second = dot(n.second, d) + Interval(2) * dot(n.rate, d_rate) + dot(n.arm, x_b.second - x_a.second);
        out.force_b = n.arm;
        out.force_a = Interval(-1) * n.arm;
        out.torque_b = cross(x_b.arm, n.arm);
        out.torque_a = Interval(-1) * cross(x_a.arm, n.arm);
        if (m.offset_axis == measure::OffsetAxis::of_a) out.torque_a = out.torque_a + cross(n.arm, d);
        if (m.offset_axis == measure::OffsetAxis::of_b) out.torque_b = out.torque_b + cross(n.arm, d);
        return out;
    }

    // Nothing where an angle has no value.
    std::optional<RowSystem> system_over(const Segment& segment, const Part& part, const Box* box) const {
        std::vector<MovingBody> bodies(model_.bodies.size());
        for (const int body : framed_) bodies[body] = moving_body(segment.paths[body], part);
        std::vector<Derivatives> of(joints_.set.measures.size());
        for (std::size_t i = 0; i < of.size(); ++i) {
            bool is_usable = true;
            if (used_[i]) of[i] = derivatives(joints_.set.measures[i], bodies, part.half(), box, is_usable);
            if (!is_usable) return std::nullopt;
        }
        RowSystem out;
        for (const Derivatives& each : of) out.measured.push_back(each.value);
        for (const Row& row : joints_.rows) {
            Interval second = 0;
            std::vector<Entry> entries;
            for (const constraint::RowPart& each : row.parts) {
                const auto k = static_cast<std::size_t>(each.measure);
                const Interval factor(each.factor);
                second = second + factor * of[k].second;
                add_entries(joints_.set.measures[k].a, factor, of[k].force_a, of[k].torque_a, box, entries);
                add_entries(joints_.set.measures[k].b, factor, of[k].force_b, of[k].torque_b, box, entries);
            }
            out.second.push_back(second);
            out.entries.push_back(std::move(entries));
        }
        return out;
    }

    // One body's part of a row's gradient; the same column may come more than once.
    void add_entries(int frame, const Interval& factor, const Interval3& force, const Interval3& torque, const Box* box,
                     std::vector<Entry>& entries) const {
        const int body = joints_.set.frames[frame].body;
        if (body == measure::world || slots_[body] < 0) return;
        const int column = 6 * slots_[body];
        // The left Jacobian of the box's turn is within |phi|/2 of 1.
        const double turn = box == nullptr ? 0 : 0.5 * box->half.segment<3>(column + 3).norm() * inflation;
        const double skewed = up(turn, norm_bound(torque));
        for (int k = 0; k < 3; ++k) {
            const auto i = static_cast<std::size_t>(k);
            entries.push_back({column + k, factor * force[i]});
            entries.push_back({column + 3 + k, factor * widened(torque[i], skewed)});
        }
    }

    // F(0; s) over the part: on the line between its values at the ends, less a share of the second derivative that is the same for all
    // rows; and what motors' curves add.
    struct Residual {
        std::vector<Interval> low, high, bent;
        VectorX off;
    };
    std::optional<Residual> residual_over(const Segment& segment, const Part& part, const RowSystem& over) const {
        const auto low = system_over(segment, {part.start, part.start}, nullptr),
                   high = system_over(segment, {part.end, part.end}, nullptr);
        if (!low || !high) return std::nullopt;
        const double length = segment.end - segment.begin;
        const double begin = segment.begin + part.start * length, end = segment.begin + part.end * length;
        const Interval most = square(Interval(part.half())) * Interval(0.5);
        Residual out;
        out.off.resize(joints_.rows.size());
        for (std::size_t r = 0; r < joints_.rows.size(); ++r) {
            const Row& row = joints_.rows[r];
            out.low.push_back(unmet(segment, row, *low, part.start));
            out.high.push_back(unmet(segment, row, *high, part.end));
            out.bent.push_back(Interval(most.high) * over.second[r]);
            out.off[r] = chord_deviation(row.curve, begin, end) + 4 * target_rounding(row, end);
        }
        return out;
    }

    // A row's value less its target after a share of the segment's time.
    Interval unmet(const Segment& segment, const Row& row, const RowSystem& at, double share) const {
        const double time = segment.begin + share * (segment.end - segment.begin);
        Interval out = -widened(Interval(target_at(row, time)), target_rounding(row, time));
        for (const constraint::RowPart& part : row.parts)
            out = out + Interval(part.factor) * counted(segment, part.measure, at.measured[part.measure], share);
        return out;
    }

    // An angle with the whole turns that the nodes say: between them it is less than half of one off the mean of theirs.
    Interval counted(const Segment& segment, int index, const Interval& value, double share) const {
        const auto m = static_cast<std::size_t>(index);
        if (joints_.set.measures[m].kind != MeasureKind::angle) return value;
        const auto& nodes = turned_[segment.step];
        const auto k = static_cast<std::size_t>(segment.index);
        const double near = nodes[k][m] + share * (nodes[k + 1][m] - nodes[k][m]);
        const double turns = std::round((near - 0.5 * (value.low + value.high)) / (2 * std::numbers::pi));
        return value + Interval(turns) * widened(Interval(2 * std::numbers::pi), 4 * unit * std::numbers::pi);
    }

    // In halves where the whole proves nothing, or little because C varies over it.
    bool prove(const Segment& segment, const Part& part, int halvings, std::vector<double>& deviations) const {
        bool is_tight = false;
        const bool is_proven = prove_whole(segment, part, deviations, is_tight);
        if ((is_proven && is_tight) || halvings == 0 || (is_proven && halvings <= most_halvings - tightening_halvings)) return is_proven;
        std::vector<double> first, second;
        if (!prove(segment, {part.start, part.middle()}, halvings - 1, first) ||
            !prove(segment, {part.middle(), part.end}, halvings - 1, second))
            return is_proven;
        deviations.resize(first.size());
        for (std::size_t i = 0; i < first.size(); ++i) deviations[i] = std::max(first[i], second[i]);
        return true;
    }

    bool prove_whole(const Segment& segment, const Part& part, std::vector<double>& deviations, bool& is_tight) const {
        const auto over = system_over(segment, part, nullptr);
        const auto middle = system_over(segment, {part.middle(), part.middle()}, nullptr);
        if (!over || !middle) return false;
        const auto residual = residual_over(segment, part, *over);
        if (!residual) return false;
        linear::DenseLu lu;
        lu.factorise(middles(*middle));
        const MatrixX A = lu.inverse();
        if (!A.allFinite()) return false;
        const VectorX v = inflation * (product_bound(A, residual->low).cwiseMax(product_bound(A, residual->high)) +
                                       product_bound(A, residual->bent) + A.cwiseAbs() * residual->off);
        Box box{1.1 * v + floor_of()};
        for (int i = 0; i < most_boxes; ++i) {
            if (!box.half.allFinite() || !(box.half.maxCoeff() < 0.1 * size_)) return false;
            const auto around = system_over(segment, part, &box);
            if (!around) return false;
            const VectorX mapped = inflation * (v + unlikeness(A, *around) * box.half);
            if ((mapped.array() < box.half.array()).all()) {
                const VectorX least =
                    mapped.cwiseMin(inflation * (v + unlikeness(A, *around) * mapped));  // it is in there, so in this, too
                deviations = deviations_of(least);
                const std::vector<double> at_best = deviations_of(v + floor_of());
                is_tight =
                    *std::max_element(deviations.begin(), deviations.end()) <= 1.5 * *std::max_element(at_best.begin(), at_best.end());
                return true;
            }
            box.half = 1.2 * mapped + floor_of();
        }
        return false;
    }

    VectorX floor_of() const { return VectorX::Constant(joints_.rows.size(), 1e-13 * size_); }

    MatrixX middles(const RowSystem& system) const {
        const auto n = static_cast<Eigen::Index>(joints_.rows.size());
        MatrixX out = MatrixX::Zero(n, n);
        for (Eigen::Index r = 0; r < n; ++r)
            for (const Entry& e : system.entries[r]) out(r, e.column) += 0.5 * (e.value.low + e.value.high);
        return out;
    }

    // |A x| from above.
    static VectorX product_bound(const MatrixX& A, const std::vector<Interval>& x) {
        const auto n = static_cast<Eigen::Index>(x.size());
        VectorX middle(n), radius(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const Interval& each = x[i];
            middle[i] = 0.5 * (each.low + each.high);
            radius[i] = (each - Interval(middle[i])).magnitude();
        }
        const double rounding = static_cast<double>(n + 2) * unit;
        return inflation * ((A * middle).cwiseAbs() + A.cwiseAbs() * (radius + rounding * middle.cwiseAbs()));
    }

    // |1 - A C| from above.
    MatrixX unlikeness(const MatrixX& A, const RowSystem& system) const {
        const auto n = static_cast<Eigen::Index>(joints_.rows.size());
        const double rounding = static_cast<double>(4 * n + 64) * unit;  // of a column's sum, in the sizes of its terms
        MatrixX off = MatrixX::Identity(n, n), loose = rounding * MatrixX::Identity(n, n);
        for (Eigen::Index r = 0; r < n; ++r)
            for (const Entry& e : system.entries[r]) {
                const double middle = 0.5 * (e.value.low + e.value.high);
                off.col(e.column) -= middle * A.col(r);
                loose.col(e.column) += ((e.value - Interval(middle)).magnitude() + rounding * e.value.magnitude()) * A.col(r).cwiseAbs();
            }
        return inflation * (off.cwiseAbs() + loose);
    }

    std::vector<double> deviations_of(const VectorX& half) const {
        std::vector<double> out;
        for (std::size_t i = 0; i < radii_.size(); ++i) {
            const auto at = static_cast<Eigen::Index>(6 * i);
            out.push_back(inflation * (half.segment<3>(at).norm() + half.segment<3>(at + 3).norm() * radii_[i]));
        }
        return out;
    }

    const IdealJoints& joints_;
    const model::Model& model_;
    const stepper::Trajectory& trajectory_;
    std::vector<int> slots_;                                // [body] place among those that move; -1: none
    std::vector<double> radii_;                             // of those
    std::vector<char> used_;                                // [measure] by a row
    std::vector<int> framed_;                               // bodies of their frames, increasing
    double size_ = 1;                                       // [m] of what is small by itself
    std::vector<std::vector<std::vector<double>>> turned_;  // [step][node][measure]
};

// What rows connect through bodies that they move: each part of the whole is proven by itself.
std::vector<IdealJoints> connected_parts(const IdealJoints& joints) {
    std::vector<int> root(joints.bodies.size());
    std::iota(root.begin(), root.end(), 0);
    const auto root_of = [&](int i) {
        while (root[i] != i) i = root[i];
        return i;
    };
    std::vector<int> first_of_row;  // a body that it moves; -1: none
    for (const Row& row : joints.rows) {
        int first = -1;
        for (const constraint::RowPart& part : row.parts) {
            const Measure& m = joints.set.measures[part.measure];
            for (const int frame : {m.a, m.b}) {
                const int body = joints.set.frames[frame].body;
                const auto found = std::lower_bound(joints.bodies.begin(), joints.bodies.end(), body);
                if (found == joints.bodies.end() || *found != body) continue;
                const int slot = root_of(static_cast<int>(found - joints.bodies.begin()));
                if (first >= 0) root[slot] = root_of(first);
                if (first < 0) first = slot;
            }
        }
        first_of_row.push_back(first);
    }
    std::vector<IdealJoints> parts(joints.bodies.size());
    for (std::size_t r = 0; r < joints.rows.size(); ++r)
        if (first_of_row[r] >= 0) parts[root_of(first_of_row[r])].rows.push_back(joints.rows[r]);
    for (std::size_t i = 0; i < joints.bodies.size(); ++i) {
        IdealJoints& part = parts[root_of(static_cast<int>(i))];
        part.set = joints.set;
        part.bodies.push_back(joints.bodies[i]);
    }
    parts.erase(std::remove_if(parts.begin(), parts.end(), [](const IdealJoints& part) { return part.bodies.empty(); }), parts.end());
    return parts;
}

}  // namespace

ProvenDeviations prove_deviations(const IdealJoints& joints, const model::Model& model, const stepper::Trajectory& trajectory) {
    ProvenDeviations out;
    out.of_body.assign(joints.bodies.size(), 0.0);
    for (const IdealJoints& part : connected_parts(joints)) {
        if (part.rows.size() != 6 * part.bodies.size()) return {{}, "joints and motors do not determine every body that they move"};
        const ProvenDeviations of_part = Prover(part, model, trajectory).run();
        if (!of_part.fault.empty()) return of_part;
        for (std::size_t i = 0; i < part.bodies.size(); ++i) {
            const auto at = std::lower_bound(joints.bodies.begin(), joints.bodies.end(), part.bodies[i]) - joints.bodies.begin();
            out.of_body[at] = of_part.of_body[i];
        }
    }
    return out;
}

}  // namespace fettle::core::certificate
