// SPDX-License-Identifier: MIT
#include "design/problem/toleranced_bodies.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

#include "core/clearance/driven_ranges.hpp"
#include "core/clearance/made_bodies.hpp"
#include "core/scene/mass_kind.hpp"
#include "core/scene/place.hpp"
#include "core/scene_files/scene_formulas.hpp"
#include "design/problem/deviating_numbers.hpp"
#include "design/problem/deviating_places.hpp"
#include "design/problem/moved_scene.hpp"

namespace fettle::design::problem {

namespace {

using core::certificate::NodePoint;
using core::certificate::Toleranced;
using core::certificate::TolerancedBody;
using core::clearance::LoopedRanges;
using core::kinematics::Pose;
using core::model::Joint;
using description::Design;
using description::Shape;
using description::Tolerance;

constexpr double allowed_mismatch = 1e-9;  // of a part drawn anew, of its size

constexpr double allowed_gap = 1e-12;  // of the scene: slides that the assembly would not close

class Recorder {
public:
    /// @param scene  At the base.
    Recorder(const Design& design, const std::vector<Tolerance>& tolerances, const core::model::Model& model,
             const std::optional<LoopedRanges>& ranges, core::scene::Scene scene)
        : design_(design),
          tolerances_(tolerances),
          model_(model),
          ranges_(ranges),
          probe_(design, tolerances, base_of(tolerances), scene),
          numbers_(design, tolerances, base_of(tolerances), std::move(scene)),
          scene_(numbers_.scene()) {}

    Result<Toleranced> run() {
        Errors refused = refused_places(probe_, model_, ranges_);
        if (ranges_ && ranges_->of == LoopedRanges::Of::joints)
            for (const Joint& joint : model_.mechanism.joints)
                if (joint.kind == core::scene::JointKind::ball && !joint.is_motor)
                    refused.push_back(
                        {ErrorCode::unsupported, "joint `" + joint.name + "`",
                         "over tolerances nothing is proven of the positions of a ball joint; as assembled it is, and without "
                         "--tolerances"});
        if (!refused.empty()) return refused;
        hang();
        out_.deviations = numbers_.deviations();
        if (ranges_) out_.coordinates = ranges_->ranges.linkage.coordinates;
        out_.bodies.resize(model_.bodies.size());
        for (int i = 0; i < count_of(model_.bodies); ++i) {
            record_vertices(i);
            record_pose(i);
        }
        drive_screws();
        record_loops();
        if (!errors_.empty()) return errors_;
        out_.nodes = numbers_.nodes();
        compare_parts();
        if (!errors_.empty()) return errors_;
        return std::move(out_);
    }

private:
    Number number(const std::string& pointer, double value) const { return numbers_.number(pointer, value); }
    Number3 vector(const std::string& pointer, const Vector3& value) const { return numbers_.vector(pointer, value); }
    NodePoint nodes_of(const Number3& x) { return numbers_.nodes_of(x); }
    static Number3 constant(const Vector3& x) { return constant_vector(x); }
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
                error.message += "; tolerances that move it: " + numbers_.names_of(dimensions);
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
            const std::set<int> found = numbers_.deviations_of(dimensions_of(i));
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
        if (turns_about_its_middle(i) && centre_moves(i, there->mesh)) {
            errors_.push_back(
                {ErrorCode::unsupported, "body " + model_.bodies[i].name,
                 "its prescribed motion turns it about its centre of mass, which tolerances move: give it a `reference_point`"});
            return false;
        }
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

    // About what a script turns a body that names no point.
    bool turns_about_its_middle(int i) const {
        const auto& screws = out_.bodies[i].screws;
        const bool is_scripted = ranges_ && ranges_->of == LoopedRanges::Of::motion && ranges_->ranges.joint_of[i] < 0;
        return is_scripted && !scene_.bodies[i].reference_point &&
               std::any_of(screws.begin(), screws.end(), [](const auto& screw) { return screw.turn != 0; });
    }
    bool centre_moves(int i, const core::geometry::Mesh& made) const {
        core::geometry::Mesh designed = model_.bodies[i].mesh;
        designed.vertices.colwise() += model_.bodies[i].reference_point;
        const auto before = core::scene::centre_of_mass(designed, model_.bodies[i].mass_kind),
                   after = core::scene::centre_of_mass(made, model_.bodies[i].mass_kind);
        return !before || !after || (*after - *before).norm() > allowed_mismatch * model_.bodies[i].radius;
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

    // The rotation of a body's file frame, as written.
    NumberMatrix rotation_of(int i) const {
        const core::scene::Body& body = scene_.bodies[i];
        const bool is_vector = body.orientation.kind == core::scene::Orientation::Kind::vector;
        const Number3 numbers = vector(body_pointer(i) + (is_vector ? "/rotation_vector" : "/rotation"), body.orientation.numbers);
        const Number3 turn = vector(body_pointer(i) + "/turn", body.turn);
        if (!varies(numbers) && !varies(turn)) return constant_matrix(body.pose.rotation);
        const NumberMatrix written =
            is_vector ? core::scene_files::rotation_of_vector(numbers) : core::scene_files::rotation_of_angles(numbers);
        if (!varies(turn) && body.turn.isZero(0)) return written;
        const NumberMatrix turned = core::scene_files::rotation_of_vector(turn);
        NumberMatrix out;
        for (size_t i_row = 0; i_row < 3; ++i_row)
            for (size_t j = 0; j < 3; ++j)
                out[i_row][j] = turned[i_row][0] * written[0][j] + turned[i_row][1] * written[1][j] + turned[i_row][2] * written[2][j];
        return out;
    }

    // What hangs a body on its parent; null: nothing.
    const Joint* joint_of(int i) const {
        if (!ranges_) return joint_as_assembled(i);
        if (ranges_->ranges.joint_of[i] >= 0) return &model_.mechanism.joints[ranges_->ranges.joint_of[i]];
        const int parent = ranges_->ranges.linkage.bodies[i].parent;
        for (const Joint& joint : model_.mechanism.joints)
            if (joint.kind == core::scene::JointKind::fixed && !joint.is_motor && ends(joint, i, parent)) return &joint;
        return nullptr;
    }
    bool is_fixed_in_the_world(int body) const {
        for (int k = 0; body >= 0 && k < 6; ++k)
            if (core::model::is_free(model_.bodies[body], k)) return false;
        return true;
    }
    bool ends(const Joint& joint, int body, int parent) const {
        const int other = joint.a == body ? joint.b : joint.b == body ? joint.a : -2;
        if (other == -2 || is_fixed_in_the_world(body)) return false;
        return parent >= 0 ? other == parent : is_fixed_in_the_world(other);
    }

    const Joint* joint_as_assembled(int i) const {
        const auto found = hung_.find(i);
        return found == hung_.end() ? nullptr : found->second;
    }

    // As assembled: which joint of the tree hangs which body, from what stands in the world. (Loops have ranges that are pinned.)
    void hang() {
        if (ranges_) return;
        std::set<int> reached{-1};
        for (int i = 0; i < count_of(model_.bodies); ++i)
            if (is_fixed_in_the_world(i)) reached.insert(i);
        std::set<const Joint*> used;
        for (int next = -1; next < count_of(model_.bodies); ++next) {
            if (next >= 0 && !reached.insert(next).second) continue;
            while (hang_next(reached, used)) {
            }
        }
    }
    bool hang_next(std::set<int>& reached, std::set<const Joint*>& used) {
        bool found = false;
        for (const Joint& joint : model_.mechanism.joints) {
            if (joint.is_motor || joint.frame_a < 0 || used.count(&joint) > 0) continue;
            const bool has_a = reached.count(joint.a) > 0, has_b = reached.count(joint.b) > 0;
            if (!has_a && !has_b) continue;
            found = used.insert(&joint).second;
            const int child = has_a ? joint.b : joint.a;
            if (has_a && has_b) continue;
            hung_[child] = &joint;
            reached.insert(child);
        }
        return found;
    }

    void record_pose(int i) {
        TolerancedBody& out = out_.bodies[i];
        const Joint* joint = joint_of(i);
        if (joint == nullptr) {
            NumberMatrix rotation = rotation_of(i);
            Number3 place = sum(product(rotation, constant(model_.bodies[i].reference_point)),
                                vector(body_pointer(i) + "/position", scene_.bodies[i].pose.position));
            const bool stays =
                !varies(place) && std::none_of(rotation.begin(), rotation.end(), [](const Number3& row) { return varies(row); });
            if (stays && is_moved_by_assembly(i)) {
                rotation = constant_matrix(model_.bodies[i].pose_start.rotation);
                place = constant(model_.bodies[i].pose_start.position);
            }
            for (size_t k = 0; k < 3; ++k) out.rotation[k] = nodes_of(rotation[k]);
            out.place = nodes_of(place);
            if (ranges_)  // a script's, about where the body is
                for (const core::certificate::Screw& screw : ranges_->ranges.linkage.bodies[i].screws)
                    out.screws.push_back({screw.coordinate, out.place, nodes_of(constant(screw.axis)), screw.turn, screw.slide});
            return;
        }
        hang_on(i, *joint, out);
    }

    bool is_moved_by_assembly(int i) const {
        const auto& written = model_.mechanism.written.poses;
        const Pose& start = model_.bodies[i].pose_start;
        return !written.empty() && (written[i].rotation != start.rotation || written[i].position != start.position);
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
        const Pose of_parent = pose_at_base(parent), of_body = pose_at_base(i);
        const Matrix3 to_parent = of_parent.rotation.transpose();
        const Matrix3 rotation = to_parent * of_body.rotation;
        const Number3 on_parent = point_of(joint, is_b), on_body = point_of(joint, !is_b);
        // How far the two points are apart, as a slide is.
        Number3 between = constant(to_parent * (core::kinematics::world_position(of_body, value_of(on_body)) -
                                                core::kinematics::world_position(of_parent, value_of(on_parent))));
        if (const Number3 more = slide_beyond(joint, i); varies(more)) {
            const Matrix3 from_a = (is_b ? 1 : -1) * (to_parent * pose_at_base(joint.a).rotation);
            between = sum(between, product(constant_matrix(from_a), more));
        }
        Number3 back = product(constant_matrix(rotation), on_body);
        for (Number& x : back) x = -x;
        for (size_t k = 0; k < 3; ++k)
            out.rotation[k] = nodes_of(constant(Vector3(rotation.row(static_cast<Eigen::Index>(k)).transpose())));
        out.place = nodes_of(sum(sum(on_parent, between), back));
        if (!ranges_) return;
        for (const core::certificate::Screw& screw : ranges_->ranges.linkage.bodies[i].screws)
            out.screws.push_back(
                {screw.coordinate, nodes_of(on_parent), nodes_of(constant(Vector3(to_parent * screw.axis))), screw.turn, screw.slide});
    }

    // How far a joint starts beyond where it starts as designed; of one whose slide the ranges or a loop decide it does not matter.
    Number3 slide_beyond(const Joint& joint, int body) const {
        const Number3 none = constant(Vector3::Zero());
        const bool is_decided = ranges_ && (ranges_->of == LoopedRanges::Of::joints || is_unknown_of_loop(*ranges_, body));
        if (is_decided && joint.kind != core::scene::JointKind::screw) return none;
        const Number3 found = written_slide(probe_, model_, joint);
        const bool is_none =
            std::all_of(found.begin(), found.end(), [&](const Number& x) { return probe_.is_none(x, allowed_gap * model_.diagonal); });
        return is_none ? none : written_slide(numbers_, model_, joint);
    }

    // How far screws go where the curves that move them deviate.
    void drive_screws() {
        if (!ranges_) return;
        for (const core::clearance::DrivenSource& source : ranges_->driven) {
            const std::optional<Drive> drive = drive_of(source);
            if (!drive) continue;
            const core::certificate::DrivenNodes nodes{numbers_.node_of(drive->scale), numbers_.node_of(drive->shift)};
            for (const auto& [body, screw] : source.screws) out_.bodies[body].screws[static_cast<size_t>(screw)].driven = nodes;
        }
    }

    struct Drive {
        Number scale, shift;
    };
    // Several sources share the time, by their rates. One alone comes from the least to the largest value of its curve; as made these are
    // others, and what lies between is stretched.
    std::optional<Drive> drive_of(const core::clearance::DrivenSource& source) {
        const core::scene::Curve& curve = source.curve;
        const Number rate = rate_of(source);
        std::vector<Number> values;
        for (size_t k = 0; k < curve.values.size(); ++k)
            values.push_back(source.motor < 0 ? Number(curve.values[k])
                                              : at_place("/motors/" + std::to_string(source.motor) + "/curve/values/" + std::to_string(k),
                                                         curve.values[k]));
        if (rate.is_constant() && !varies(values)) return std::nullopt;
        if (ranges_->driven.size() > 1) return Drive{rate / Number(curve.rate), Number(0)};
        std::vector<Number> ways;
        for (const double time : core::clearance::turning_times(curve, ranges_->duration)) {
            Number way = rate * Number(curve_running_time(curve, time)) - Number(curve_value(curve, 0));
            const std::vector<double> weights = curve_weights(curve, time);
            for (size_t k = 0; k < values.size(); ++k)
                if (weights[k] != 0) way = way + Number(weights[k]) * values[k];
            const auto is_same = [&](const Number& other) { return numbers_.is_none(way - other, 1e-15); };
            if (std::none_of(ways.begin(), ways.end(), is_same)) ways.push_back(way);
        }
        Number low = ways.front(), high = low;
        for (const Number& way : ways) {
            low = minimum(low, way);
            high = maximum(high, way);
        }
        const Number scale = (high - low) / Number(high.value - low.value);
        return Drive{scale, Number(source.units) * (low - scale * Number(low.value))};
    }
    Number rate_of(const core::clearance::DrivenSource& source) const {
        if (source.motor >= 0) return at_place("/motors/" + std::to_string(source.motor) + "/curve/rate", source.curve.rate);
        constexpr std::array dofs{"px", "py", "pz", "rx", "ry", "rz"};
        if (source.dof < 0) return {source.curve.rate};
        return at_place(body_pointer(source.body) + "/prescribed/" + dofs[static_cast<size_t>(source.dof)] + "/rate", source.curve.rate);
    }
    // By any of a place's pointers.
    Number at_place(const std::string& pointer, double value) const {
        return number(core::scene::pointer_to(scene_, core::scene::find_place(scene_, pointer).value()), value);
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
                const auto axis_of = [&](int frame) { return constant(Vector3(model_.mechanism.set.frames[frame].axes.col(2))); };
                loop.closures.push_back({joint.a, joint.b, nodes_of(point_of(joint, true)), nodes_of(axis_of(joint.frame_a)),
                                         nodes_of(point_of(joint, false)), nodes_of(axis_of(joint.frame_b))});
            }
        }
    }

    const Design& design_;
    const std::vector<Tolerance>& tolerances_;
    const core::model::Model& model_;
    const std::optional<LoopedRanges>& ranges_;
    const DeviatingNumbers probe_;  // of the same numbers: for questions that leave nothing in the list of operations
    DeviatingNumbers numbers_;
    const core::scene::Scene& scene_;  // at the base
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
    const VectorX base = base_of(tolerances);
    Result<MovedScene> moved = move_scene(design, description::with_deviations(design, tolerances, base), SceneDerivative::not_wanted);
    if (!moved) return moved.errors();
    return Recorder(design, tolerances, model, ranges, std::move(moved->scene)).run();
}

}  // namespace fettle::design::problem
