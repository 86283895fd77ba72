// SPDX-License-Identifier: MIT
#include "core/model/build_mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "core/model/branch_of_joint.hpp"
#include "core/model/choose_kappa.hpp"
#include "core/model/limits.hpp"
#include "core/model/mechanism_start.hpp"
#include "core/model/part_across.hpp"

namespace fettle::core::model {
namespace {

using base::ErrorCode;
using base::Errors;
using measure::Measure;
using measure::MeasureKind;
using measure::OffsetAxis;
using scene::JointKind;

constexpr int x_axis = 0, y_axis = 1, z_axis = 2;

bool turns(JointKind kind) { return kind == JointKind::revolute || kind == JointKind::screw; }

const char* kind_of(const scene::Joint&) { return "joint"; }
const char* kind_of(const scene::Spring&) { return "spring"; }
const char* kind_of(const scene::Motor&) { return "motor"; }
const char* kind_of(const scene::PointLoad&) { return "load"; }

// In its file; of what was made in memory by its name.
template <class Part>
std::string place_of_part(const Part& part) {
    return part.where.empty() ? std::string(kind_of(part)) + " `" + part.name + "`" : part.where;
}

// Two unit vectors across z, the same for the same z.
Matrix3 axes_about(const Vector3& z) {
    Matrix3 axes;
    int least = 0;
    z.cwiseAbs().minCoeff(&least);
    axes.col(0) = Vector3::Unit(least).cross(z).normalized();
    axes.col(1) = z.cross(axes.col(0));
    axes.col(2) = z;
    return axes;
}

class MechanismBuilder {
public:
    MechanismBuilder(const scene::Scene& scene, Model& model, const TermScales& scales)
        : scene_(scene), model_(model), out_(model.mechanism), radii_(scales.radii) {
        for (std::size_t i = 0; i < model.bodies.size(); ++i) body_of_name_[model.bodies[i].name] = static_cast<int>(i);
        for (std::size_t i = radii_.size(); i < model.bodies.size(); ++i) radii_.push_back(model.bodies[i].radius);
    }

    Errors build() {
        const scene::Mechanism& from = scene_.mechanism;
        for_each(from.joints, Origin::List::joint, [&](const scene::Joint& joint) {
            if (!scene::couples_joints(joint.kind)) add_joint(joint);
        });
        for_each(from.joints, Origin::List::joint, [&](const scene::Joint& joint) {
            if (scene::couples_joints(joint.kind)) add_coupling(joint);
        });
        if (errors_.empty()) errors_ = add_branches(scene_, model_);
        check_names(from.springs, "spring or damper");
        check_names(from.motors, "motor");
        check_names(from.loads, "load");
        for_each(from.springs, Origin::List::spring, [&](const scene::Spring& spring) { add_spring(spring); });
        for_each(from.motors, Origin::List::motor, [&](const scene::Motor& motor) { add_motor(motor); });
        for_each(from.loads, Origin::List::load, [&](const scene::PointLoad& load) { add_load(load); });
        std::sort(out_.not_colliding.begin(), out_.not_colliding.end());
        out_.not_colliding.erase(std::unique(out_.not_colliding.begin(), out_.not_colliding.end()), out_.not_colliding.end());
        return std::move(errors_);
    }

private:
    // The ends of a joint or spring.
    struct Ends {
        int frame_a = 0, frame_b = 0;
        int a = measure::world, b = measure::world;
    };

    template <class Part, class Add>
    void for_each(const std::vector<Part>& list, Origin::List name, const Add& add) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            origin_ = {name, static_cast<int>(i)};
            add(list[i]);
        }
    }

    void fail(ErrorCode code, const std::string& where, const std::string& message) { errors_.push_back({code, where, message}); }

    // Those that have none are asked for by nobody.
    template <class Part>
    void check_names(const std::vector<Part>& list, const std::string& kind) {
        std::set<std::string_view> names;
        for (const Part& part : list) {
            if (part.name.empty() || names.insert(part.name).second) continue;
            fail(ErrorCode::inconsistent, place_of_part(part),
                 "another " + kind + " is called `" + part.name + "` already; names are unique");
        }
    }

    std::optional<int> find_body(const std::string& name, const std::string& where) {
        if (name.empty()) return measure::world;
        const auto found = body_of_name_.find(name);
        if (found != body_of_name_.end()) return found->second;
        fail(ErrorCode::inconsistent, where, "no body is called `" + name + "`");
        return std::nullopt;
    }

    kinematics::Pose pose_of(int body) const { return body == measure::world ? kinematics::Pose{} : model_.bodies[body].pose_start; }

    double value_as_written(int measure) const {
        std::vector<kinematics::Pose> poses;
        for (const Body& body : model_.bodies) poses.push_back(body.pose_start);
        return value_of(out_.set.measures[measure], placed(out_.set.frames, poses));
    }

    measure::Frame frame_of(int body, const scene::Attachment& end) const {
        const Vector3 reference = body == measure::world ? Vector3(Vector3::Zero()) : model_.bodies[body].reference_point;
        return {body, end.point - reference, axes_about(end.axis.normalized())};
    }

    // b's x axis where a's is at the start, turned into the plane across b's z axis.
    void align(const measure::Frame& a, measure::Frame& b) const {
        const Matrix3 to_b = pose_of(b.body).rotation.transpose() * pose_of(a.body).rotation;
        const Vector3 z = b.axes.col(2), x = to_b * a.axes.col(0);
        const std::optional<Vector3> across = part_across(z, x);
        if (!across) return;
        b.axes.col(0) = across->normalized();
        b.axes.col(1) = z.cross(b.axes.col(0));
    }

    std::optional<Ends> add_ends(const scene::Attachment& from_a, const scene::Attachment& from_b, const std::string& where) {
        const std::optional<int> a = find_body(from_a.body, where), b = find_body(from_b.body, where);
        if (!a || !b) return std::nullopt;
        if (*a == *b) {
            fail(ErrorCode::inconsistent, where, "two different bodies are expected, or one and the world");
            return std::nullopt;
        }
        if (!(from_a.axis.norm() > 0) || !(from_b.axis.norm() > 0)) {
            fail(ErrorCode::out_of_range, where, "an axis needs a length greater than 0");
            return std::nullopt;
        }
        measure::Frame frame_a = frame_of(*a, from_a), frame_b = frame_of(*b, from_b);
        align(frame_a, frame_b);
        out_.set.frames.push_back(frame_a);
        out_.set.frames.push_back(frame_b);
        out_.ends.push_back(origin_);
        const int first = count_of(out_.set.frames) - 2;
        return Ends{first, first + 1, *a, *b};
    }

    int add_measure(const Measure& measure) {
        out_.set.measures.push_back(measure);
        return count_of(out_.set.measures) - 1;
    }

    // m = constant.
    void add_row(int measure, double length, double constant = 0) {
        out_.rows.push_back({count_of(out_.joints) - 1, {{measure, 1}}, constant, {}, length});
    }

    double lever(int a, int b) const {
        double most = model_.dhat;
        for (const int body : {a, b})
            if (body != measure::world) most = std::max(most, model_.bodies[body].radius);
        return most;
    }

    // The lever of a term.
    double term_lever(const measure::Measure& m) const {
        double most = model_.dhat;
        for (const int frame : {m.a, m.b}) {
            const int body = out_.set.frames[frame].body;
            if (body != measure::world) most = std::max(most, radii_[body]);
        }
        return most;
    }

    void add_joint(const scene::Joint& from) {
        if (!joint_of_name_.try_emplace(from.name, count_of(out_.joints)).second)
            return fail(ErrorCode::inconsistent, place_of_part(from), "another joint is called `" + from.name + "` already");
        const std::optional<Ends> ends = add_ends(from.a, from.b, place_of_part(from));
        if (!ends) return;
        Joint joint;
        joint.name = from.name;
        joint.kind = from.kind;
        joint.origin = origin_;
        joint.a = ends->a;
        joint.b = ends->b;
        joint.frame_a = ends->frame_a;
        joint.frame_b = ends->frame_b;
        out_.joints.push_back(joint);
        add_point_rows(*ends, from.kind);
        add_direction_rows(*ends, from.kind);
        add_coordinate(*ends, from);
        if (!from.collide && joint.a != measure::world && joint.b != measure::world)
            out_.not_colliding.emplace_back(std::minmax(joint.a, joint.b));
    }

    void add_point_rows(const Ends& e, JointKind kind) {
        const bool holds_point = kind == JointKind::ball || kind == JointKind::revolute || kind == JointKind::fixed;
        const bool slides = kind == JointKind::prismatic || kind == JointKind::cylindrical || kind == JointKind::screw;
        for (const int axis : {x_axis, y_axis, z_axis}) {
            if (holds_point) add_row(add_measure({MeasureKind::offset, e.frame_a, e.frame_b, axis, 0, OffsetAxis::of_world}), 1);
            if ((slides && axis != z_axis) || (kind == JointKind::planar && axis == z_axis))
                add_row(add_measure({MeasureKind::offset, e.frame_a, e.frame_b, axis, 0, OffsetAxis::of_a}), 1);
        }
    }

    void add_direction_rows(const Ends& e, JointKind kind) {
        if (kind == JointKind::ball) return;
        const double length = lever(e.a, e.b);
        add_row(add_measure({MeasureKind::product, e.frame_a, e.frame_b, x_axis, z_axis, {}}), length);
        add_row(add_measure({MeasureKind::product, e.frame_a, e.frame_b, y_axis, z_axis, {}}), length);
        if (kind == JointKind::fixed || kind == JointKind::prismatic)
            add_row(add_measure({MeasureKind::product, e.frame_a, e.frame_b, y_axis, x_axis, {}}), length);
    }

    void add_coordinate(const Ends& e, const scene::Joint& from) {
        const bool slides = from.kind == JointKind::prismatic || from.kind == JointKind::cylindrical;
        Joint& joint = out_.joints.back();
        if (slides) joint.coordinate = add_measure({MeasureKind::offset, e.frame_a, e.frame_b, z_axis, 0, OffsetAxis::of_a});
        if (turns(from.kind)) joint.coordinate = add_measure({MeasureKind::angle, e.frame_a, e.frame_b, 0, 0, {}});
        if (from.kind == JointKind::screw) {
            const int slide = add_measure({MeasureKind::offset, e.frame_a, e.frame_b, z_axis, 0, OffsetAxis::of_a});
            add_row(slide, 1, value_as_written(slide));
            out_.rows.back().parts.push_back({joint.coordinate, -from.pitch / (2 * std::numbers::pi)});
        }
        if (joint.coordinate >= 0) add_forces(from.forces, joint.coordinate, from.name);
        if (from.swing) add_swing(e, *from.swing, from.name);
    }

    // cos(angle of the axes) >= cos(swing): smooth where the axes are one, as their angle is not.
    void add_swing(const Ends& e, double swing, const std::string& name) {
        const int cosine = add_measure({MeasureKind::product, e.frame_a, e.frame_b, z_axis, z_axis, {}});
        const double length = term_lever(out_.set.measures[cosine]);
        out_.terms.push_back({LawKind::stop, cosine, 0, std::cos(swing), 1, length, {}, name, origin_});
    }

    void add_forces(const scene::CoordinateForces& from, int measure, const std::string& name) {
        const Measure& m = out_.set.measures[measure];
        const double length = m.kind == MeasureKind::angle ? term_lever(m) : 1;
        const double start = value_as_written(measure);
        if (from.stiffness > 0) {
            const double rest = from.rest.value_or(start - from.preload / from.stiffness);
            out_.terms.push_back({LawKind::spring, measure, from.stiffness, rest, 1, length, {}, name, origin_});
        }
        if (from.damping > 0) out_.terms.push_back({LawKind::damper, measure, from.damping, 0, 1, length, {}, name, origin_});
        if (from.friction > 0) out_.terms.push_back({LawKind::friction, measure, from.friction, 0, 1, length, {}, name, origin_});
        if (!from.limits) return;
        out_.terms.push_back({LawKind::stop, measure, 0, (*from.limits)[0], 1, length, {}, name, origin_});
        out_.terms.push_back({LawKind::stop, measure, 0, (*from.limits)[1], -1, length, {}, name, origin_});
    }

    // A joint by name, with a coordinate.
    const Joint* find_joint(const std::string& name, const std::string& where) {
        const auto found = joint_of_name_.find(name);
        const auto index = found == joint_of_name_.end() ? out_.joints.size() : static_cast<std::size_t>(found->second);
        if (index >= out_.joints.size()) {
            fail(ErrorCode::inconsistent, where, "no joint is called `" + name + "`");
            return nullptr;
        }
        if (out_.joints[index].coordinate >= 0) return &out_.joints[index];
        fail(ErrorCode::inconsistent, where,
             "`" + name + "` has no one coordinate: a revolute, prismatic, cylindrical or screw joint is expected");
        return nullptr;
    }

    // ratio (first) - second = constant.
    void add_coupling(const scene::Joint& from) {
        const Joint *first = find_joint(from.of[0], place_of_part(from)), *second = find_joint(from.of[1], place_of_part(from));
        if (!first || !second) return;
        const bool same = turns(first->kind) == turns(second->kind);
        const bool fits = from.kind == JointKind::gear ? same : turns(first->kind) && !same;
        if (first == second || !fits)
            return fail(ErrorCode::inconsistent, place_of_part(from),
                        from.kind == JointKind::gear ? "a gear couples the angles, or the slides, of two different joints"
                                                     : "a rack couples an angle and a slide: a revolute joint, then a prismatic one");
        const std::vector<constraint::RowPart> parts{{first->coordinate, from.ratio}, {second->coordinate, -1}};
        const double constant = from.ratio * value_as_written(first->coordinate) - value_as_written(second->coordinate);
        const double length = turns(second->kind) ? lever(second->a, second->b) : 1;
        Joint joint;
        joint.name = from.name;
        joint.kind = from.kind;
        joint.origin = origin_;
        out_.joints.push_back(joint);
        out_.rows.push_back({count_of(out_.joints) - 1, parts, constant, {}, length});
    }

    void add_spring(const scene::Spring& from) {
        if (!from.joint.empty()) {
            const Joint* joint = find_joint(from.joint, place_of_part(from));
            if (joint) add_forces(from.forces, joint->coordinate, from.name);
            return;
        }
        const std::optional<Ends> ends = add_ends(from.a, from.b, place_of_part(from));
        if (!ends) return;
        const int length = add_measure({MeasureKind::distance, ends->frame_a, ends->frame_b, 0, 0, {}});
        if (!(value_as_written(length) > 0))
            return fail(ErrorCode::out_of_range, place_of_part(from),
                        "the ends of `" + from.name + "` are at one place: it has no direction");
        add_forces(from.forces, length, from.name);
    }

    // The largest stride of a curve in one time step, while its table runs and after.
    double largest_stride(const scene::Curve& curve) const {
        constexpr int most_steps = 100000;
        const double h = model_.timestep, end = curve.times.empty() ? 0 : curve.times.back();
        const int steps = static_cast<int>(std::min<double>(most_steps, std::max(0.0, std::ceil(end / h)))) + 1;
        double most = 0, before = curve_value(curve, 0);
        for (int k = 1; k <= steps; ++k) {
            const double after = curve_value(curve, k * h);
            most = std::max(most, std::abs(after - before));
            before = after;
        }
        return most;
    }

    void add_motor(const scene::Motor& from) {
        const Joint* joint = find_joint(from.joint, place_of_part(from));
        if (!joint) return;
        const int coordinate = joint->coordinate;
        const double length = turns(joint->kind) ? lever(joint->a, joint->b) : 1;
        if (from.kind == scene::MotorKind::effort) {
            out_.terms.push_back({LawKind::force, coordinate, 1, 0, 1, length, from.curve, from.name, origin_});
            return;
        }
        if (turns(joint->kind) && largest_stride(from.curve) > 0.9 * std::numbers::pi)
            return fail(ErrorCode::out_of_range, place_of_part(from),
                        "`" + from.name +
                            "` turns by half a turn or more in one time step, so that its turns cannot be counted: use a "
                            "shorter time step");
        Joint motor = *joint;
        motor.name = from.name;
        motor.is_motor = true;
        motor.origin = origin_;
        out_.joints.push_back(motor);
        out_.rows.push_back({count_of(out_.joints) - 1, {{coordinate, 1}}, value_as_written(coordinate), from.curve, length});
    }

    // f . x: the offset from the world's origin along the force.
    void add_load(const scene::PointLoad& from) {
        if (from.force.isZero(0)) return;
        scene::Attachment origin;
        origin.axis = from.force;
        const std::optional<Ends> ends = add_ends(origin, {from.body, from.point, Vector3::UnitZ()}, place_of_part(from));
        if (!ends) return;
        const int along = add_measure({MeasureKind::offset, ends->frame_a, ends->frame_b, z_axis, 0, OffsetAxis::of_a});
        scene::Curve constant;
        constant.times = {0};
        constant.values = {from.force.norm()};
        out_.terms.push_back({LawKind::force, along, 1, 0, 1, 1, constant, from.name, origin_});
    }

    const scene::Scene& scene_;
    Model& model_;
    Mechanism& out_;
    std::vector<double> radii_;
    Origin origin_;  // of what is being added
    std::map<std::string, int> body_of_name_, joint_of_name_;
    Errors errors_;
};

// A stop is no force that brings things back from beyond it.
Errors beyond_at_start(const scene::Scene& scene, const Model& model) {
    Errors errors;
    for (const std::string& what : beyond_limits(model, start_poses(model), model.mechanism.angles_start))
        errors.push_back({ErrorCode::out_of_range, scene.path + "#/joints",
                          "at the start " + what + ": place its bodies within them, or widen `limits`"});
    return errors;
}

}  // namespace

Errors build_mechanism(const scene::Scene& scene, Model& model, const TermScales& scales) {
    if (scene.mechanism.empty()) return {};
    if (Errors errors = MechanismBuilder(scene, model, scales).build(); !errors.empty()) return errors;
    if (model.integrator == scene::Integrator::newmark && !model.mechanism.rows.empty())
        return {{ErrorCode::unsupported, scene.path + "#/integrator",
                 "`newmark` lets joints oscillate; `implicit_euler`, `bdf2` and `quasi_static` can have them"}};
    if (Errors errors = settle_start(scene, model); !errors.empty()) return errors;
    return beyond_at_start(scene, model);
}

void stiffen_stops(Model& model, const TermScales& scales) {
    const double stiffness = scales.stop_stiffness ? *scales.stop_stiffness : choose_stop_stiffness(model);
    for (MeasureTerm& term : model.mechanism.terms)
        if (term.kind == LawKind::stop) term.coefficient = stiffness;
}

}  // namespace fettle::core::model
