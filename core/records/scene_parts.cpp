// SPDX-License-Identifier: MIT
#include "core/records/scene_parts.hpp"

#include <cstdint>

#include "core/files/hash.hpp"

namespace fettle::core::records {
namespace {

// Numbers and matrices of them, each with its size where that may vary.
class Part {
public:
    Part& add(double x) {
        hash_.add(x);
        return *this;
    }
    template <class Derived>
    Part& add(const Eigen::MatrixBase<Derived>& values) {
        hash_.add(static_cast<std::uint64_t>(values.size()));
        for (Eigen::Index j = 0; j < values.cols(); ++j)
            for (Eigen::Index i = 0; i < values.rows(); ++i) hash_.add(static_cast<double>(values(i, j)));
        return *this;
    }
    Part& add(const std::vector<double>& values) {
        hash_.add(static_cast<std::uint64_t>(values.size()));
        for (const double x : values) hash_.add(x);
        return *this;
    }
    Part& add(const kinematics::Pose& pose) { return add(pose.rotation).add(pose.position); }

    std::string value() const { return files::hexadecimal(hash_.value()); }

private:
    files::Fnv1a hash_;
};

template <class Add>
std::string of_bodies(const model::Model& model, const Add& add) {
    Part part;
    for (const model::Body& body : model.bodies) add(part, body);
    return part.value();
}

void add_motion(Part& part, const model::Body& body) {
    for (const auto& curve : body.prescribed) {
        part.add(curve ? 1 : 0);
        if (!curve) continue;
        part.add(curve->rate).add(curve->times).add(curve->values).add(curve->stop_time ? 1 : 0).add(curve->stop_time.value_or(0));
    }
    part.add(body.script.times);
    for (const kinematics::Pose& pose : body.script.poses) part.add(pose);
}

// What only some scenes have is left out of the others' parts.
void add_loads(Part& part, const model::Body& body) {
    part.add(body.force).add(body.torque);
    if (body.damping.linear > 0 || body.damping.angular > 0) part.add(body.damping.linear).add(body.damping.angular);
}

void add_curve(Part& part, const scene::Curve& curve) {
    part.add(static_cast<double>(curve.kind)).add(curve.rate).add(curve.times).add(curve.values);
    part.add(curve.stop_time ? 1 : 0).add(curve.stop_time.value_or(0));
}

void add_row(Part& part, const constraint::Row& row) {
    for (const constraint::RowPart& p : row.parts) part.add(p.measure).add(p.factor);
    part.add(row.constant).add(row.length);
    add_curve(part, row.curve);
}

std::string mechanism_hash(const model::Mechanism& mechanism) {
    Part part;
    for (const measure::Frame& f : mechanism.set.frames) part.add(f.body).add(f.point).add(f.axes);
    for (const measure::Measure& m : mechanism.set.measures) {
        for (const int number : {static_cast<int>(m.kind), m.a, m.b, m.axis_a, m.axis_b, static_cast<int>(m.offset_axis)}) part.add(number);
    }
    for (const constraint::Row& row : mechanism.rows) add_row(part, row);
    for (const constraint::Row& row : mechanism.dependent) add_row(part, row);
    for (const model::MeasureTerm& term : mechanism.terms) {
        part.add(static_cast<double>(term.kind))
            .add(term.measure)
            .add(term.coefficient)
            .add(term.reference)
            .add(term.sign)
            .add(term.length);
        add_curve(part, term.curve);
    }
    for (const auto& [a, b] : mechanism.not_colliding) part.add(a).add(b);
    return part.value();
}

std::string integrator_hash(const model::Model& model) {
    Part part;
    part.add(static_cast<double>(model.integrator));
    if (model.integrator == scene::Integrator::quasi_static) part.add(model.proximal_weight);
    return part.value();
}

std::string contact_model(const model::Model& model) {
    Part part;
    part.add(model.dhat).add(model.dmin).add(model.kappa).add(model.adaptive_kappa ? 1 : 0).add(model.area_weighted ? 1 : 0);
    if (model.round_reach > 0) part.add(model.round_reach);
    for (const model::FacetSides& sides : model.facet_sides) part.add(sides.a).add(sides.side_a).add(sides.b).add(sides.side_b);
    if (model.contact_damping_time > 0) part.add(model.contact_damping_time);
    for (const auto& [a, b] : model.ignored) part.add(a).add(b);
    return part.value();
}

std::string solver_settings(const model::Model& model) {
    Part part;
    part.add(model.velocity_tolerance);
    if (model.solve_accuracy > 0) part.add(model.solve_accuracy);
    if (model.for_gradient) part.add(1);
    return part.value();
}

}  // namespace

std::vector<ScenePart> scene_parts(const model::Model& model) {
    std::vector<ScenePart> parts{
        {"time step", Part().add(model.timestep).value()},
        {"integrator", integrator_hash(model)},
        {"gravity", Part().add(model.gravity).value()},
        {"contact model", contact_model(model)},
        {"friction", Part().add(model.friction.mu).add(model.friction.eps_v).add(model.friction.rounds).value()},
        {"solver's tolerance", solver_settings(model)},
        {"body types and groups", of_bodies(model, [](Part& p, const auto& b) { p.add(static_cast<double>(b.type)).add(b.group); })},
        {"masses", of_bodies(model, [](Part& p, const auto& b) { p.add(b.moments); })},
        {"materials", of_bodies(model, [](Part& p, const auto& b) { p.add(b.material); })},
        {"start poses", of_bodies(model, [](Part& p, const auto& b) { p.add(b.pose_start); })},
        {"start velocities", of_bodies(model, [](Part& p, const auto& b) { p.add(b.velocity_start); })},
        {"motors and scripts", of_bodies(model, add_motion)},
        {"loads", of_bodies(model, add_loads)},
    };
    if (!model.mechanism.empty()) parts.push_back({"joints, springs and motors", mechanism_hash(model.mechanism)});
    return parts;
}

}  // namespace fettle::core::records
