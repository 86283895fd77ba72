// SPDX-License-Identifier: MIT
#include "fettle/design/problem/toleranced_bodies.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

#include "fettle/core/base/text.hpp"
#include "fettle/core/clearance/made_bodies.hpp"
#include "fettle/core/expression/tape.hpp"
#include "fettle/core/scene/place.hpp"
#include "fettle/core/scene_files/scene_formulas.hpp"
#include "fettle/design/problem/moved_scene.hpp"

namespace fettle::design::problem {

namespace {

using core::certificate::NodePoint;
using core::certificate::Toleranced;
using core::certificate::TolerancedBody;
using core::clearance::LoopedRanges;
using core::expression::Number;
using core::expression::Tape;
using core::kinematics::Pose;
using core::model::Joint;
using core::scene_files::Number3;
using description::Design;
using description::Shape;
using description::Tolerance;
using NumberMatrix = std::array<Number3, 3>;  // rows

constexpr double allowed_mismatch = 1e-9;  // of a part drawn anew, of its size

Number3 sum(const Number3& a, const Number3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Number3 constant(const Vector3& x) { return {Number(x[0]), Number(x[1]), Number(x[2])}; }

Number3 product(const NumberMatrix& m, const Number3& x) {
    Number3 out;
    for (size_t i = 0; i < 3; ++i) out[i] = m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2];
    return out;
}

NumberMatrix constant(const Matrix3& m) {
    return {constant(Vector3(m.row(0).transpose())), constant(Vector3(m.row(1).transpose())), constant(Vector3(m.row(2).transpose()))};
}

bool is_constant(const Number3& x) {
    return std::all_of(x.begin(), x.end(), [](const Number& number) { return number.is_constant(); });
}

class Recorder {
public:
    Recorder(const Design& design, const std::vector<Tolerance>& tolerances, const core::model::Model& model,
             const std::optional<LoopedRanges>& ranges)
        : design_(design), tolerances_(tolerances), model_(model), ranges_(ranges) {}

    Result<Toleranced> run() {
        const VectorX base = base_of(tolerances_);
        const Result<MovedScene> moved =
            move_scene(design_, description::with_deviations(design_, tolerances_, base), SceneDerivative::not_wanted);
        if (!moved) return moved.errors();
        scene_ = moved->scene;
        record_numbers(base);
        if (ranges_) out_.coordinates = ranges_->ranges.linkage.coordinates;
        out_.bodies.resize(model_.bodies.size());
        for (int i = 0; i < count_of(model_.bodies); ++i) {
            record_vertices(i);
            record_pose(i);
        }
        record_loops();
        check_couplings();
        if (!errors_.empty()) return errors_;
        out_.nodes = tape_.nodes();
        compare_parts();
        if (!errors_.empty()) return errors_;
        return std::move(out_);
    }

private:
    // Each number of the scene that follows from parameters, as what it is of the deviations.
    void record_numbers(const VectorX& base) {
        std::vector<Number> parameters;
        for (const description::Parameter& parameter : design_.parameters) parameters.emplace_back(parameter.value);
        for (int k = 0; k < count_of(tolerances_); ++k) {
            const Tolerance& tolerance = tolerances_[k];
            const core::base::Unit& unit = design_.parameters[tolerance.parameter].unit;
            out_.deviations.push_back({tolerance.of, tolerance.deviation.lower, tolerance.deviation.upper, base[k],
                                       unit.dimension == Dimension::number ? "" : std::string(unit.name)});
            parameters[tolerance.parameter] = parameters[tolerance.parameter] + tape_.input(base[k]);
        }
        const std::vector<std::string> names = description::names_of(design_.parameters);
        for (const core::scene::BoundNumber& number : design_.numbers) {
            const auto place = core::scene::find_place(scene_, number.place);
            if (!place) continue;
            std::vector<Number> inputs;
            for (const int position : core::expression::positions_of(number.formula, names)) inputs.push_back(parameters[position]);
            numbers_[core::scene::pointer_to(scene_, *place)] = core::expression::value_of<Number>(number.formula, inputs);
        }
    }

    // The number at a place, whose value is known.
    Number number(const std::string& pointer, double value) const {
        const auto found = numbers_.find(pointer);
        return found == numbers_.end() ? Number(value) : found->second;
    }
    Number3 vector(const std::string& pointer, const Vector3& value) const {
        Number3 out;
        for (int k = 0; k < 3; ++k) out[static_cast<size_t>(k)] = number(pointer + "/" + std::to_string(k), value[k]);
        return out;
    }

    // Which tolerances numbers follow from.
    std::set<int> deviations_of(const std::vector<Number>& of) const {
        std::set<int> found;
        std::vector<bool> reached(tape_.nodes().size(), false);
        for (const Number& x : of)
            if (!x.is_constant()) reached[x.node] = true;
        for (size_t k = reached.size(); k-- > 0;) {
            if (!reached[k]) continue;
            const core::expression::Node& node = tape_.nodes()[k];
            if (node.operation == core::expression::Operation::input) found.insert(node.operands[0]);
            for (int i = 0; i < core::expression::operand_count(node.operation); ++i) reached[node.operands[static_cast<size_t>(i)]] = true;
        }
        return found;
    }
    // "`a`, `b`".
    std::string names_of(const std::vector<Number>& of) const {
        std::vector<std::string> names;
        for (const int k : deviations_of(of)) names.push_back("`" + tolerances_[k].of + "`");
        return core::base::joined(names);
    }

    void refuse(const std::vector<Number>& of, const std::string& what) {
        errors_.push_back({ErrorCode::unsupported, "tolerances",
                           names_of(of) + (names_of(of).find(',') == std::string::npos ? " moves " : " move ") + what +
                               ": within tolerances only lengths, and rotations of bodies without joints, can deviate"});
    }

    int node_of(const Number& x) {
        if (!x.is_constant()) return x.node;
        const auto [found, is_new] = constants_.try_emplace(x.value, 0);
        if (is_new) found->second = tape_.node_of(x);
        return found->second;
    }
    NodePoint nodes_of(const Number3& x) { return {node_of(x[0]), node_of(x[1]), node_of(x[2])}; }
    static std::string body_pointer(int i) { return "/bodies/" + std::to_string(i); }

    // --- parts

    std::vector<Number> dimensions_of(int i) const {
        std::vector<Number> out;
        const Shape* shape = description::shape_of(design_, i);
        if (shape == nullptr) return out;
        for (const description::ShapeDimension& dimension : shape->dimensions())
            out.push_back(number(body_pointer(i) + "/shape/dimensions/" + core::scene::escaped(dimension.name),
                                 scene_.bodies[i].shape->dimensions.at(dimension.name)));
        return out;
    }

    static bool varies(const std::vector<Number>& numbers) {
        return std::any_of(numbers.begin(), numbers.end(), [](const Number& x) { return !x.is_constant(); });
    }

    void record_vertices(int i) {
        const std::vector<Number> dimensions = dimensions_of(i);
        if (!varies(dimensions)) return;
        std::vector<double> values;
        for (const Number& x : dimensions) values.push_back(x.value);
        const Result<description::RecordedShape> recorded = description::shape_of(design_, i)->recorded(values);
        const std::string& name = model_.bodies[i].name;
        if (!recorded) {
            for (Error error : recorded.errors()) {
                error.where = "body " + name + ": " + error.where;
                error.message += "; tolerances that move it: " + names_of(dimensions);
                errors_.push_back(std::move(error));
            }
            return;
        }
        const std::vector<Number> of_nodes = core::expression::values<Number>(recorded->nodes, dimensions);
        const Vector3& reference = model_.bodies[i].reference_point;
        for (const auto& nodes : recorded->vertices) {
            Number3 x;
            for (size_t k = 0; k < 3; ++k) x[k] = of_nodes[nodes[k]] - Number(reference[static_cast<Eigen::Index>(k)]);
            out_.bodies[i].vertices.push_back(nodes_of(x));
        }
        drawn_.insert(i);
    }

    // The part at the base and at some ends of its tolerances, as it is made there, as the formulas have it, and with the facets that it is
    // made of as designed.
    void compare_parts() {
        for (const int i : drawn_) {
            const auto designed = remade(i, std::vector<double>(out_.deviations.size(), 0));
            if (!designed) continue;
            const std::set<int> found = deviations_of(dimensions_of(i));
            const std::vector<int> matter(found.begin(), found.end());
            const std::vector<double> base = core::clearance::base_deviations(out_);
            std::vector<std::vector<double>> ends{base};
            for (const int k : matter)
                for (const double end : {out_.deviations[k].lower, out_.deviations[k].upper}) {
                    ends.push_back(base);
                    ends.back()[k] = end;
                }
            for (unsigned corner = 0; corner < 16 && matter.size() > 1; ++corner) {
                ends.push_back(base);
                for (size_t j = 0; j < matter.size(); ++j) {
                    const core::certificate::Deviation& d = out_.deviations[matter[j]];
                    ends.back()[matter[j]] = (corner >> (j % 4) & 1) != 0 ? d.upper : d.lower;
                }
            }
            for (const auto& at : ends)
                if (!compare(i, at, designed->other_facets)) break;
        }
    }

    // Nothing: an error told why.
    std::optional<description::RemadeShape> remade(int i, const std::vector<double>& deviations) {
        const Shape& shape = *description::shape_of(design_, i);
        VectorX d = Eigen::Map<const VectorX>(deviations.data(), static_cast<Eigen::Index>(deviations.size()));
        const VectorX p = description::with_deviations(design_, tolerances_, d);
        const std::vector<std::string> names = description::names_of(design_.parameters);
        std::vector<double> values;
        for (const description::ShapeDimension& dimension : shape.dimensions()) {
            const std::string pointer = body_pointer(i) + "/shape/dimensions/" + core::scene::escaped(dimension.name);
            values.push_back(value_at(pointer, scene_.bodies[i].shape->dimensions.at(dimension.name), p, names));
        }
        Result<description::RemadeShape> made = shape.remade(values);
        if (made) return *std::move(made);
        for (Error error : made.errors()) {
            error.where = "body " + model_.bodies[i].name + ": " + error.where;
            error.message = "within the tolerances it cannot be made: " + error.message;
            errors_.push_back(std::move(error));
        }
        return std::nullopt;
    }

    bool compare(int i, const std::vector<double>& deviations, const std::vector<std::string>& facets_as_designed) {
        const auto there = remade(i, deviations);
        if (!there) return false;
        const core::clearance::MadeBodies made(out_, deviations);
        const Matrix3X& nominal = model_.bodies[i].mesh.vertices;
        bool same = there->other_facets == facets_as_designed && there->mesh.vertices.cols() == nominal.cols();
        if (same) {
            const Matrix3X vertices = made.vertices(i, nominal).colwise() + model_.bodies[i].reference_point;
            same = (vertices - there->mesh.vertices).cwiseAbs().maxCoeff() <= allowed_mismatch * nominal.cwiseAbs().maxCoeff();
        }
        if (same) return true;
        const std::string which = there->other_facets.empty() ? "" : " (" + core::base::joined(there->other_facets) + ")";
        errors_.push_back(
            {ErrorCode::unsupported, "body " + model_.bodies[i].name,
             "its part is made of other facets at an end of its tolerances than as designed" + which +
                 ": what holds for the one is not known of the other; let a circle have another number of them (\"counts\": "
                 "{\"segments\": 49} of the shape), of which no arc has just a whole number, or make the tolerances smaller"});
        return false;
    }

    double value_at(const std::string& pointer, double value, const VectorX& p, const std::vector<std::string>& names) const {
        for (const core::scene::BoundNumber& number : design_.numbers) {
            const auto place = core::scene::find_place(scene_, number.place);
            if (!place || core::scene::pointer_to(scene_, *place) != pointer) continue;
            std::vector<double> inputs;
            for (const int position : core::expression::positions_of(number.formula, names)) inputs.push_back(p[position]);
            return core::expression::value_of<double>(number.formula, inputs);
        }
        return value;
    }

    // --- poses

    // Of a body's file frame, as written.
    NumberMatrix rotation_of(int i) const {
        const core::scene::Body& body = scene_.bodies[i];
        const bool is_vector = body.orientation.kind == core::scene::Orientation::Kind::vector;
        const Number3 numbers = vector(body_pointer(i) + (is_vector ? "/rotation_vector" : "/rotation"), body.orientation.numbers);
        const Number3 turn = vector(body_pointer(i) + "/turn", body.turn);
        if (is_constant(numbers) && is_constant(turn)) return constant(body.pose.rotation);
        const NumberMatrix written =
            is_vector ? core::scene_files::rotation_of_vector(numbers) : core::scene_files::rotation_of_angles(numbers);
        if (is_constant(turn) && body.turn.isZero(0)) return written;
        const NumberMatrix turned = core::scene_files::rotation_of_vector(turn);
        NumberMatrix out;
        for (size_t i_row = 0; i_row < 3; ++i_row)
            for (size_t j = 0; j < 3; ++j)
                out[i_row][j] = turned[i_row][0] * written[0][j] + turned[i_row][1] * written[1][j] + turned[i_row][2] * written[2][j];
        return out;
    }

    static bool is_constant_matrix(const NumberMatrix& m) { return is_constant(m[0]) && is_constant(m[1]) && is_constant(m[2]); }

    // What hangs a body on its parent; null: nothing.
    const Joint* joint_of(int i) const {
        if (!ranges_) return joint_as_assembled(i);
        if (ranges_->ranges.joint_of[i] >= 0) return &model_.mechanism.joints[ranges_->ranges.joint_of[i]];
        const int parent = ranges_->ranges.linkage.bodies[i].parent;
        for (const Joint& joint : model_.mechanism.joints)
            if (joint.kind == core::scene::JointKind::fixed && !joint.is_motor && ends(joint, i, parent)) return &joint;
        return nullptr;
    }
    bool is_fixed_in_the_world(int body) const { return body < 0 || model_.bodies[body].type == core::scene::BodyType::static_body; }
    bool ends(const Joint& joint, int body, int parent) const {
        const int other = joint.a == body ? joint.b : joint.b == body ? joint.a : -2;
        if (other == -2 || is_fixed_in_the_world(body)) return false;
        return parent >= 0 ? other == parent : is_fixed_in_the_world(other);
    }

    // As assembled: the joints' tree, from what stands in the world. (Loops have ranges that are pinned.)
    const Joint* joint_as_assembled(int i) const {
        const auto found = hung_.find(i);
        return found == hung_.end() ? nullptr : found->second;
    }

public:
    /// As assembled: which joint hangs which body.
    void hang() {
        if (ranges_) return;
        std::set<int> reached;
        for (int i = 0; i < count_of(model_.bodies); ++i)
            if (is_fixed_in_the_world(i)) reached.insert(i);
        reached.insert(-1);
        std::set<const Joint*> used;
        for (int next = -1; next < count_of(model_.bodies); ++next) {
            if (next >= 0 && !reached.insert(next).second) continue;
            for (bool again = true; again;) {
                again = false;
                for (const Joint& joint : model_.mechanism.joints) {
                    if (joint.is_motor || joint.frame_a < 0 || used.count(&joint) > 0) continue;
                    const bool has_a = reached.count(joint.a) > 0, has_b = reached.count(joint.b) > 0;
                    if (!has_a && !has_b) continue;
                    used.insert(&joint);
                    again = true;
                    const int child = has_a ? joint.b : joint.a;
                    if (has_a && has_b) continue;
                    hung_[child] = &joint;
                    reached.insert(child);
                }
            }
        }
    }

private:
    void record_pose(int i) {
        TolerancedBody& out = out_.bodies[i];
        const Joint* joint = joint_of(i);
        if (joint == nullptr) {
            const NumberMatrix rotation = rotation_of(i);
            const Number3 position = vector(body_pointer(i) + "/position", scene_.bodies[i].pose.position);
            for (size_t k = 0; k < 3; ++k) out.rotation[k] = nodes_of(rotation[k]);
            out.place = nodes_of(sum(product(rotation, constant(model_.bodies[i].reference_point)), position));
            if (ranges_)  // a script's, about where the body is
                for (const core::certificate::Screw& screw : ranges_->ranges.linkage.bodies[i].screws)
                    out.screws.push_back({screw.coordinate, out.place, nodes_of(constant(screw.axis)), screw.turn, screw.slide});
            return;
        }
        hang_on(i, *joint, out);
    }

    // A joint's point in a body's frame, or in the world.
    Number3 point_of(const Joint& joint, bool end_a) const {
        const core::scene::Joint& from = scene_.mechanism.joints[joint.origin.index];
        const core::scene::Attachment& end = end_a ? from.a : from.b;
        const int body = end_a ? joint.a : joint.b;
        const Number3 point = vector("/joints/" + std::to_string(joint.origin.index) + (end_a ? "/point_a" : "/point_b"), end.point);
        return body < 0 ? point : sum(point, constant(Vector3(-model_.bodies[body].reference_point)));
    }

    Pose pose_at_base(int body) const { return body < 0 ? Pose{} : model_.bodies[body].pose_start; }

    void hang_on(int i, const Joint& joint, TolerancedBody& out) {
        const bool is_b = joint.b == i;
        const int parent = is_b ? joint.a : joint.b;
        out.parent = parent;
        check_joint(joint, i, parent);
        const Pose of_parent = pose_at_base(parent), of_body = pose_at_base(i);
        const Matrix3 to_parent = of_parent.rotation.transpose();
        const Matrix3 rotation = to_parent * of_body.rotation;
        const Number3 on_parent = point_of(joint, is_b), on_body = point_of(joint, !is_b);
        const auto value = [](const Number3& x) { return Vector3(x[0].value, x[1].value, x[2].value); };
        // How far the two points are apart, as a slide is.
        const Vector3 between = to_parent * (core::kinematics::world_position(of_body, value(on_body)) -
                                             core::kinematics::world_position(of_parent, value(on_parent)));
        Number3 back = product(constant(rotation), on_body);
        for (Number& x : back) x = -x;
        for (size_t k = 0; k < 3; ++k)
            out.rotation[k] = nodes_of(constant(Vector3(rotation.row(static_cast<Eigen::Index>(k)).transpose())));
        out.place = nodes_of(sum(sum(on_parent, constant(between)), back));
        if (!ranges_) return;
        for (const core::certificate::Screw& screw : ranges_->ranges.linkage.bodies[i].screws)
            out.screws.push_back(
                {screw.coordinate, nodes_of(on_parent), nodes_of(constant(Vector3(to_parent * screw.axis))), screw.turn, screw.slide});
    }

    void record_loops() {
        if (!ranges_) return;
        for (const core::clearance::ClosedLoop& from : ranges_->loops) {
            core::certificate::TolerancedLoop& loop = out_.loops.emplace_back();
            loop.unknowns = from.unknowns;
            loop.rows = from.rows;
            loop.size = model_.diagonal;
            for (const int k : from.closing) {
                const Joint& joint = model_.mechanism.joints[k];
                check_joint(joint, joint.a, joint.b);
                const auto axis_of = [&](int frame) { return constant(Vector3(model_.mechanism.set.frames[frame].axes.col(2))); };
                loop.closures.push_back({joint.a, joint.b, nodes_of(point_of(joint, true)), nodes_of(axis_of(joint.frame_a)),
                                         nodes_of(point_of(joint, false)), nodes_of(axis_of(joint.frame_b))});
            }
        }
    }

    void check_joint(const Joint& joint, int body, int parent) {
        const std::string at = "/joints/" + std::to_string(joint.origin.index);
        const core::scene::Joint& from = scene_.mechanism.joints[joint.origin.index];
        std::vector<Number> numbers{number(at + "/pitch", from.pitch)};
        for (const auto& [key, end] : {std::pair{"/axis_a", &from.a}, {"/axis_b", &from.b}})
            for (const Number& x : vector(at + key, end->axis)) numbers.push_back(x);
        if (varies(numbers)) refuse(numbers, "the axis or the pitch of joint `" + joint.name + "`");
        std::vector<Number> limits;
        for (int k = 0; k < 2; ++k) limits.push_back(number(at + "/limits/" + std::to_string(k), 0));
        if (ranges_ && varies(limits)) refuse(limits, "the limits of joint `" + joint.name + "`");
        for (const int each : {body, parent}) {
            if (each < 0) continue;
            const NumberMatrix rotation = rotation_of(each);
            if (is_constant_matrix(rotation)) continue;
            std::vector<Number> all;
            for (const Number3& row : rotation) all.insert(all.end(), row.begin(), row.end());
            refuse(all, "the rotation of body `" + model_.bodies[each].name + "`, which joint `" + joint.name + "` holds");
        }
    }

    void check_couplings() {
        if (!ranges_) return;
        for (const Joint& joint : model_.mechanism.joints) {
            if (joint.is_motor || joint.frame_a >= 0) continue;
            const std::string at = "/joints/" + std::to_string(joint.origin.index);
            const std::vector<Number> ratio{number(at + "/ratio", 1), number(at + "/radius", 1)};
            if (varies(ratio)) refuse(ratio, "the ratio of `" + joint.name + "`");
        }
    }

    const Design& design_;
    const std::vector<Tolerance>& tolerances_;
    const core::model::Model& model_;
    const std::optional<LoopedRanges>& ranges_;
    core::scene::Scene scene_;  // at the base
    Tape tape_;
    std::map<std::string, Number> numbers_;  // by pointer
    std::map<double, int> constants_;        // nodes
    std::map<int, const Joint*> hung_;
    std::set<int> drawn_;  // bodies whose vertices are formulas
    Toleranced out_;
    Errors errors_;
};

}  // namespace

VectorX base_of(const std::vector<Tolerance>& tolerances) {
    VectorX out(count_of(tolerances));
    for (int k = 0; k < count_of(tolerances); ++k) {
        const tolerances::Distribution& d = tolerances[k].deviation;
        out[k] = d.lower <= 0 && 0 <= d.upper ? 0 : 0.5 * d.lower + 0.5 * d.upper;
    }
    return out;
}

Result<Toleranced> toleranced_bodies(const Design& design, const std::vector<Tolerance>& tolerances, const core::model::Model& model,
                                     const std::optional<LoopedRanges>& ranges) {
    Recorder recorder(design, tolerances, model, ranges);
    recorder.hang();
    return recorder.run();
}

}  // namespace fettle::design::problem
