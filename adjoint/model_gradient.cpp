// SPDX-License-Identifier: MIT
#include "adjoint/model_gradient.hpp"

#include "core/model/row_choice.hpp"

namespace fettle::adjoint {
namespace {

MechanismGradient zero_mechanism_gradient(const core::model::Mechanism& mechanism) {
    MechanismGradient g;
    g.frames.resize(mechanism.set.frames.size());
    g.term_coefficient.assign(mechanism.terms.size(), 0);
    g.term_reference = g.term_rate = g.term_coefficient;
    for (const core::model::MeasureTerm& term : mechanism.terms) g.term_values.emplace_back(term.curve.values.size(), 0.0);
    const std::vector<core::constraint::Row> rows = all_rows(mechanism);
    g.row_constant.assign(rows.size(), 0);
    g.row_rate = g.row_constant;
    for (const core::constraint::Row& row : rows) {
        g.row_values.emplace_back(row.curve.values.size(), 0.0);
        g.row_factors.emplace_back(row.parts.size(), 0.0);
    }
    return g;
}

void add(std::vector<double>& sum, const std::vector<double>& part) {
    for (std::size_t i = 0; i < sum.size() && i < part.size(); ++i) sum[i] += part[i];
}

void add(std::vector<std::vector<double>>& sum, const std::vector<std::vector<double>>& part) {
    for (std::size_t i = 0; i < sum.size() && i < part.size(); ++i) add(sum[i], part[i]);
}

void add(MechanismGradient& sum, const MechanismGradient& part) {
    for (std::size_t i = 0; i < sum.frames.size() && i < part.frames.size(); ++i) {
        sum.frames[i].point += part.frames[i].point;
        sum.frames[i].axes += part.frames[i].axes;
    }
    add(sum.term_coefficient, part.term_coefficient);
    add(sum.term_reference, part.term_reference);
    add(sum.term_values, part.term_values);
    add(sum.term_rate, part.term_rate);
    add(sum.row_constant, part.row_constant);
    add(sum.row_rate, part.row_rate);
    add(sum.row_factors, part.row_factors);
    add(sum.row_values, part.row_values);
}

}  // namespace

TrajectoryGradient zero_trajectory_gradient(int steps, int bodies) {
    TrajectoryGradient g;
    g.pose_bar.assign(static_cast<std::size_t>(steps) + 1, std::vector<Matrix34>(bodies, Matrix34::Zero()));
    return g;
}

ModelGradient zero_model_gradient(const core::model::Model& model, int steps) {
    ModelGradient g;
    g.mechanism = zero_mechanism_gradient(model.mechanism);
    g.bodies.resize(model.bodies.size());
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        g.bodies[i].vertices_bar = Matrix3X::Zero(3, model.bodies[i].mesh.vertices.cols());
        g.bodies[i].increment_bar.assign(steps, Vector6::Zero());
    }
    return g;
}

void add(ModelGradient& sum, const ModelGradient& part) {
    for (std::size_t i = 0; i < sum.bodies.size(); ++i) {
        BodyGradient& to = sum.bodies[i];
        const BodyGradient& from = part.bodies[i];
        if (from.vertices_bar.cols() > 0) to.vertices_bar += from.vertices_bar;
        to.pose_start_bar += from.pose_start_bar;
        to.velocity_start_bar += from.velocity_start_bar;
        to.density_bar += from.density_bar;
        to.force_bar += from.force_bar;
        to.torque_bar += from.torque_bar;
        for (std::size_t t = 0; t < to.increment_bar.size() && t < from.increment_bar.size(); ++t)
            to.increment_bar[t] += from.increment_bar[t];
    }
    sum.gravity_bar += part.gravity_bar;
    sum.dmin_bar += part.dmin_bar;
    for (const auto& [pair, bar] : part.friction_bar) sum.friction_bar[pair] += bar;
    add(sum.mechanism, part.mechanism);
}

Seeds zero_seeds(const core::model::Model& model, int steps) {
    return {zero_trajectory_gradient(steps, count_of(model.bodies)), zero_model_gradient(model, steps)};
}

ModelTangent zero_model_tangent(const core::model::Model& model, int steps) {
    ModelTangent d;
    d.mechanism = zero_mechanism_gradient(model.mechanism);
    d.bodies.resize(model.bodies.size());
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        d.bodies[i].vertices_dot = Matrix3X::Zero(3, model.bodies[i].mesh.vertices.cols());
        d.bodies[i].increment_dot.assign(steps, Vector6::Zero());
    }
    return d;
}

}  // namespace fettle::adjoint
