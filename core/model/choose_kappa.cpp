// SPDX-License-Identifier: MIT
#include "core/model/choose_kappa.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/measure/measure.hpp"

namespace fettle::core::model {
namespace {

using measure::PlacedFrame;

constexpr double strain = 0.25;  // expected of a spring without stops: radians, or radii of the larger of its bodies

double largest_radius(const Model& model, const measure::Measure& m) {
    double radius = 0;
    for (const int frame : {m.a, m.b}) {
        const int body = model.mechanism.set.frames[frame].body;
        if (body != measure::world) radius = std::max(radius, model.bodies[body].radius);
    }
    return radius;
}

// At the start, at the stops of its coordinate, or strained as expected, whichever is most.
double largest_force(const Model& model, const MeasureTerm& spring, const std::vector<PlacedFrame>& frames) {
    const measure::Measure& m = model.mechanism.set.measures[spring.measure];
    double stretch = m.kind == measure::MeasureKind::angle ? strain : strain * largest_radius(model, m);
    stretch = std::max(stretch, std::abs(measure::value_of(m, frames) - spring.reference));
    for (const MeasureTerm& stop : model.mechanism.terms)
        if (stop.kind == LawKind::stop && stop.measure == spring.measure)
            stretch = std::max(stretch, std::abs(stop.reference - spring.reference));
    return spring.coefficient * stretch;
}

double largest_force(const scene::Curve& curve) {
    double force = curve.times.empty() ? std::abs(curve.rate * curve.stop_time.value_or(0)) : 0;
    for (const double value : curve.values) force = std::max(force, std::abs(value));
    return force;
}

// Per body, of springs, loads and motors of given effort, torques at the lever of their bodies.
std::vector<double> mechanism_forces(const Model& model) {
    const Mechanism& mechanism = model.mechanism;
    std::vector<double> forces(model.bodies.size(), 0.0);
    std::vector<kinematics::Pose> poses;
    for (const Body& body : model.bodies) poses.push_back(body.pose_start);
    const std::vector<PlacedFrame> frames = placed(mechanism.set.frames, poses);
    for (const MeasureTerm& term : mechanism.terms) {
        double force = 0;
        if (term.kind == LawKind::spring) force = largest_force(model, term, frames) / term.length;
        if (term.kind == LawKind::force) force = largest_force(term.curve) / term.length;
        const measure::Measure& m = mechanism.set.measures[term.measure];
        for (const int frame : {m.a, m.b})
            if (const int body = mechanism.set.frames[frame].body; body != measure::world) forces[body] += force;
    }
    return forces;
}

bool is_dynamic(const Body& body) { return body.type == scene::BodyType::dynamic_body; }

}  // namespace

double choose_kappa(const Model& model) {
    std::vector<double> loads = mechanism_forces(model);
    bool is_loaded = false;
    for (std::size_t i = 0; i < loads.size(); ++i) {
        const Body& body = model.bodies[i];
        if (!is_dynamic(body)) continue;
        const double mass = body.moments(3, 3);
        loads[i] += mass * (model.gravity + body.force / mass).norm();
        is_loaded = is_loaded || loads[i] > 0;
    }
    const bool loads_alone = model.integrator == scene::Integrator::quasi_static && is_loaded;
    double kappa = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
        const Body& body = model.bodies[i];
        if (!is_dynamic(body)) continue;
        const double inertial = loads_alone ? 0 : 0.1 * body.moments(3, 3) / (model.timestep * model.timestep);
        const double wanted = std::max(inertial, 4 * loads[i] / model.dhat);
        // Half of a twentieth of its surface is what a body may rest on.
        const double area = std::accumulate(body.vertex_area.begin(), body.vertex_area.end(), 0.0) / 40;
        kappa = std::max(kappa, model.area_weighted && area > 0 ? wanted / area : wanted);
    }
    return kappa > 0 ? kappa : 1;
}

double choose_stop_stiffness(const Model& model) {
    if (!model.area_weighted) return model.kappa;
    Model plain = model;
    plain.area_weighted = false;
    return choose_kappa(plain);
}

}  // namespace fettle::core::model
