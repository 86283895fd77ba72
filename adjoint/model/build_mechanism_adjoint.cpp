// SPDX-License-Identifier: MIT
#include "adjoint/model/build_mechanism_adjoint.hpp"

#include <numbers>

#include "core/model/part_across.hpp"
#include "core/model/row_choice.hpp"

namespace fettle::adjoint::model {
namespace {

using core::kinematics::Pose;
using core::measure::FrameGradient;
using core::measure::Measure;
using core::model::LawKind;
using core::model::MeasureTerm;
using core::model::Mechanism;
using core::model::Origin;
using core::scene::JointKind;

// dJ/dv of n = v/|v|.
Vector3 normalised_adjoint(const Vector3& n, double length, const Vector3& bar) { return (bar - n * n.dot(bar)) / length; }

class MechanismAdjoint {
public:
    MechanismAdjoint(const core::scene::Scene& scene, const core::model::Model& model, const MechanismGradient& gradient,
                     WrittenStartGradient& start, core::scene::Mechanism& bar)
        : scene_(scene.mechanism),
          mechanism_(model.mechanism),
          gradient_(gradient),
          frames_bar_(gradient.frames),
          start_(start),
          written_(model.mechanism.written.poses),
          frames_(placed(model.mechanism.set.frames, written_)),
          value_bar_(model.mechanism.set.measures.size(), 0.0),
          out_(bar) {}

    void run() {
        for (std::size_t k = 0; k < mechanism_.terms.size(); ++k) reverse_term(k);
        for (const core::constraint::Row& row : all_rows(mechanism_)) reverse_row(row);
        reverse_values();
        for (std::size_t k = 0; k < mechanism_.ends.size(); ++k) reverse_ends(k);
    }

private:
    const core::scene::CoordinateForces& forces_of(const Origin& origin) const {
        const auto i = static_cast<std::size_t>(origin.index);
        return origin.list == Origin::List::joint ? scene_.joints[i].forces : scene_.springs[i].forces;
    }

    core::scene::CoordinateForces& forces_bar(const Origin& origin) {
        const auto i = static_cast<std::size_t>(origin.index);
        return origin.list == Origin::List::joint ? out_.joints[i].forces : out_.springs[i].forces;
    }

    void reverse_term(std::size_t k) {
        const MeasureTerm& term = mechanism_.terms[k];
        const double coefficient = gradient_.term_coefficient[k], reference = gradient_.term_reference[k];
        if (term.kind == LawKind::force) return reverse_force(k);
        core::scene::CoordinateForces& bar = forces_bar(term.origin);
        if (term.kind == LawKind::damper) bar.damping += coefficient;
        if (term.kind == LawKind::friction) bar.friction += coefficient;
        if (term.kind == LawKind::stop && is_swing(term)) return reverse_swing(term.origin, reference);
        if (term.kind == LawKind::stop) (*bar.limits)[term.sign > 0 ? 0 : 1] += reference;
        if (term.kind != LawKind::spring) return;
        const core::scene::CoordinateForces& from = forces_of(term.origin);
        bar.stiffness += coefficient;
        if (from.rest) {
            *bar.rest += reference;
            return;
        }
        value_bar_[term.measure] += reference;  // the start's, less preload/stiffness
        bar.preload -= reference / from.stiffness;
        bar.stiffness += reference * from.preload / (from.stiffness * from.stiffness);
    }

    bool is_swing(const MeasureTerm& term) const {
        return mechanism_.set.measures[term.measure].kind == core::measure::MeasureKind::product;
    }

    // reference = cos(swing).
    void reverse_swing(const Origin& origin, double reference_bar) {
        const auto i = static_cast<std::size_t>(origin.index);
        *out_.joints[i].swing -= std::sin(*scene_.joints[i].swing) * reference_bar;
    }

    void reverse_force(std::size_t k) {
        const Origin& origin = mechanism_.terms[k].origin;
        const auto i = static_cast<std::size_t>(origin.index);
        if (origin.list == Origin::List::load) {
            out_.loads[i].force += gradient_.term_values[k][0] * scene_.loads[i].force.normalized();
            return;
        }
        add_curve(gradient_.term_values[k], gradient_.term_rate[k], out_.motors[i].curve);
    }

    static void add_curve(const std::vector<double>& values, double rate, core::scene::Curve& out) {
        for (std::size_t k = 0; k < values.size(); ++k) out.values[k] += values[k];
        out.rate += rate;
    }

    double written_value(std::size_t measure) const { return value_of(mechanism_.set.measures[measure], frames_); }

    void reverse_row(const core::constraint::Row& row) {
        const auto i = static_cast<std::size_t>(row.number);
        const core::model::Joint& joint = mechanism_.joints[row.owner];
        const auto origin = static_cast<std::size_t>(joint.origin.index), first = static_cast<std::size_t>(row.parts[0].measure);
        const double constant = gradient_.row_constant[i];
        if (joint.is_motor) {
            add_curve(gradient_.row_values[i], gradient_.row_rate[i], out_.motors[origin].curve);
            value_bar_[first] += constant;
            return;
        }
        if (row.parts.size() < 2) return;  // 0 = what a joint holds
        core::scene::Joint& bar = out_.joints[origin];
        if (joint.kind == JointKind::screw) {
            value_bar_[first] += constant;
            bar.pitch -= gradient_.row_factors[i][1] / (2 * std::numbers::pi);
            return;
        }
        const auto second = static_cast<std::size_t>(row.parts[1].measure);
        bar.ratio += gradient_.row_factors[i][0] + constant * written_value(first);
        value_bar_[first] += constant * row.parts[0].factor;
        value_bar_[second] -= constant;
    }

    Matrix3 rotation_of(int body) const { return body == core::measure::world ? Matrix3(Matrix3::Identity()) : written_[body].rotation; }

    int body_of(int frame) const { return mechanism_.set.frames[frame].body; }

    void add_pose(int body, const Vector6& bar) {
        if (body != core::measure::world) start_.pose_bar[body] += bar;
    }

    // Reverses measures' values as written: in frames and poses.
    void reverse_values() {
        std::vector<Matrix3> rotations;
        for (const core::measure::Frame& f : mechanism_.set.frames) rotations.push_back(rotation_of(f.body));
        for (std::size_t k = 0; k < value_bar_.size(); ++k) {
            if (value_bar_[k] == 0) continue;
            const Measure& m = mechanism_.set.measures[k];
            const core::measure::VectorFunction f = vector_function(m, frames_);
            add_placement_gradient(f, value_bar_[k], rotations, frames_bar_);
            const core::measure::PoseGradients g = pose_gradients(m, f, frames_);
            add_pose(body_of(m.a), value_bar_[k] * tangent_gradient(g.a));
            add_pose(body_of(m.b), value_bar_[k] * tangent_gradient(g.b));
        }
    }

    // Axes about z made without any other: into z.
    static Vector3 free_axes_adjoint(const Matrix3& axes, const Matrix3& bar) {
        const Vector3 x = axes.col(0), z = axes.col(2);
        int least = 0;
        z.cwiseAbs().minCoeff(&least);
        const Vector3 e = Vector3::Unit(least);
        const Vector3 x_bar = bar.col(0) + bar.col(1).cross(z);
        return bar.col(2) + x.cross(bar.col(1)) + normalised_adjoint(x, e.cross(z).norm(), x_bar).cross(e);
    }

    // Axes of b: into z, and into the axes of a and both poses.
    Vector3 aligned_axes_adjoint(int frame_a, int frame_b) {
        const core::measure::Frame &a = mechanism_.set.frames[frame_a], &b = mechanism_.set.frames[frame_b];
        const Matrix3& bar = frames_bar_[frame_b].axes;
        const Matrix3 rotation_b = rotation_of(b.body);
        const Vector3 x = b.axes.col(0), z = b.axes.col(2), world = rotation_of(a.body) * a.axes.col(0);
        const Vector3 seen = rotation_b.transpose() * world;
        const std::optional<Vector3> across = core::model::part_across(z, seen);
        if (!across) return free_axes_adjoint(b.axes, bar);
        const Vector3 x_bar = bar.col(0) + bar.col(1).cross(z), across_bar = normalised_adjoint(x, across->norm(), x_bar);
        const Vector3 seen_bar = rotation_b * (across_bar - z * z.dot(across_bar)), turn = world.cross(seen_bar);
        frames_bar_[frame_a].axes.col(0) += rotation_of(a.body).transpose() * seen_bar;
        Vector6 of_pose = Vector6::Zero();
        of_pose.tail<3>() = turn;
        add_pose(a.body, of_pose);
        add_pose(b.body, -of_pose);
        return bar.col(2) + x.cross(bar.col(1)) - z.dot(seen) * across_bar - seen * z.dot(across_bar);
    }

    void reverse_ends(std::size_t k) {
        const int frame_a = static_cast<int>(2 * k), frame_b = frame_a + 1;
        const Vector3 z_bar_b = aligned_axes_adjoint(frame_a, frame_b);
        const core::measure::Frame& a = mechanism_.set.frames[frame_a];
        const FrameGradient &bar_a = frames_bar_[frame_a], &bar_b = frames_bar_[frame_b];
        const Vector3 z_bar_a = free_axes_adjoint(a.axes, bar_a.axes);
        const Origin& origin = mechanism_.ends[k];
        const auto i = static_cast<std::size_t>(origin.index);
        if (origin.list == Origin::List::load) {
            out_.loads[i].point += bar_b.point;
            out_.loads[i].force += normalised_adjoint(a.axes.col(2), scene_.loads[i].force.norm(), z_bar_a);
            return;
        }
        const bool is_joint = origin.list == Origin::List::joint;
        const core::scene::Attachment &from_a = is_joint ? scene_.joints[i].a : scene_.springs[i].a,
                                      &from_b = is_joint ? scene_.joints[i].b : scene_.springs[i].b;
        core::scene::Attachment &out_a = is_joint ? out_.joints[i].a : out_.springs[i].a,
                                &out_b = is_joint ? out_.joints[i].b : out_.springs[i].b;
        out_a.point += bar_a.point;
        out_b.point += bar_b.point;
        out_a.axis += normalised_adjoint(a.axes.col(2), from_a.axis.norm(), z_bar_a);
        out_b.axis += normalised_adjoint(mechanism_.set.frames[frame_b].axes.col(2), from_b.axis.norm(), z_bar_b);
    }

    const core::scene::Mechanism& scene_;
    const Mechanism& mechanism_;
    const MechanismGradient& gradient_;
    std::vector<FrameGradient> frames_bar_;
    WrittenStartGradient& start_;
    const std::vector<Pose>& written_;
    const std::vector<core::measure::PlacedFrame> frames_;  // as written
    std::vector<double> value_bar_;                         // of the measures' values as written
    core::scene::Mechanism& out_;
};

}  // namespace

void build_mechanism_adjoint(const core::scene::Scene& scene, const core::model::Model& model, const MechanismGradient& gradient,
                             WrittenStartGradient& start, core::scene::Mechanism& bar) {
    if (!scene.mechanism.empty()) MechanismAdjoint(scene, model, gradient, start, bar).run();
}

}  // namespace fettle::adjoint::model
