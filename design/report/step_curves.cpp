// SPDX-License-Identifier: MIT
#include "design/report/step_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "design/report/packed_numbers.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;
using core::scene::JointKind;

constexpr std::size_t most_lines = 8, most_instants = 2000;
constexpr double newton_millimetre = 1e-3, millijoule = 1e-3;
constexpr double least_drive = 1e-2;  // of the largest: what is less is left out

bool has_slide(JointKind kind) { return kind == JointKind::prismatic || kind == JointKind::cylindrical; }

std::vector<double> thinned(const std::vector<double>& all, std::size_t every) {
    std::vector<double> kept;
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, every)) kept.push_back(all[i]);
    return kept;
}

}  // namespace

LinearMotors linear_motors(const core::model::Model& model) {
    LinearMotors linear;
    for (const core::model::Joint& joint : model.mechanism.joints)
        if (joint.is_motor && has_slide(joint.kind)) linear.insert(joint.name);
    return linear;
}

LinearMotors linear_motors(const core::scene::Mechanism& mechanism) {
    LinearMotors linear;
    for (const core::scene::Motor& motor : mechanism.motors)
        for (const core::scene::Joint& joint : mechanism.joints)
            if (joint.name == motor.joint && has_slide(joint.kind)) linear.insert(motor.name);
    return linear;
}

void Curve::add(const std::string& name, double time, double value) {
    if (!std::isfinite(value)) value = std::numeric_limits<double>::quiet_NaN();  // tables have no other
    const std::size_t at = times_.try_emplace(time, times_.size()).first->second;
    lines_[name].emplace_back(at, value);
    double& largest = largest_[name];
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
}

void Curve::append_to(Json& list, const char* title, const char* quantity, const char* unit, double share) const {
    std::vector<std::pair<double, std::string>> order;
    double top = 0;
    for (const auto& [name, size] : largest_) top = std::max(top, size);
    for (const auto& [name, size] : largest_)
        if (size > share * top) order.emplace_back(-size, name);
    if (order.empty()) return;
    std::sort(order.begin(), order.end());
    const bool all = order.size() <= most_lines;
    if (!all) order.resize(most_lines);
    std::sort(order.begin(), order.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
    const std::size_t every = (times_.size() + most_instants - 1) / most_instants;
    Json lines = Json::array();
    for (const auto& [size, name] : order) lines.push_back({{"name", name}, {"values", packed(values(name, every))}});
    std::vector<double> times;
    for (const auto& [time, at] : times_) times.push_back(time);
    list.push_back({{"title", title},
                    {"quantity", quantity},
                    {"unit", unit},
                    {"note", all ? Json() : Json("the " + std::to_string(most_lines) + " largest of " + std::to_string(largest_.size()))},
                    {"time", packed(thinned(times, every))},
                    {"lines", lines}});
}

std::vector<double> Curve::values(const std::string& name, std::size_t every) const {
    std::vector<double> by_arrival(times_.size(), 0);
    for (const auto& [at, value] : lines_.at(name)) by_arrival[at] = value;
    std::vector<double> by_time;
    for (const auto& [time, at] : times_) by_time.push_back(by_arrival[at]);
    return thinned(by_time, every);
}

StepCurves::StepCurves(const core::model::Model& model, LinearMotors linear) : linear_(std::move(linear)) {
    for (const core::model::Body& body : model.bodies)
        if (body.type == core::scene::BodyType::static_body) fixed_.insert(body.name);
}

void StepCurves::add_energies(double time, double kinetic, double potential, double contact) {
    empty_ = false;
    energy_.add("kinetic", time, kinetic / millijoule);
    energy_.add("potential", time, potential / millijoule);
    energy_.add("contact", time, contact / millijoule);
}

void StepCurves::add_contact(double time, const std::string& a, const std::string& b, double normal) {
    normal_.add(a + " \u2013 " + b, time, normal);
}

void StepCurves::add_drive(double time, const std::string& body, const Vector3& force, const Vector3& torque) {
    if (fixed_.count(body) > 0) {
        held_.add(body, time, std::hypot(force.x(), force.y(), force.z()));
        return;
    }
    for (int k = 0; k < 3; ++k) {
        const char axis = "xyz"[k];
        driving_torques_.add(body + " about " + axis, time, torque[k] / newton_millimetre);
        driving_forces_.add(body + " along " + axis, time, force[k]);
    }
}

void StepCurves::add_joint(double time, const std::string& name, const Vector3& force, double effort) {
    const bool is_force = linear_.count(name) > 0;
    (is_force ? motor_forces_ : motor_torques_).add(name, time, is_force ? effort : effort / newton_millimetre);
    carried_.add(name, time, std::hypot(force.x(), force.y(), force.z()));
}

void StepCurves::add(const core::stepper::StepOutputs& step, const core::model::Model& model) {
    for (const core::stepper::JointForce& each : step.joints)
        add_joint(step.time, model.mechanism.joints[each.joint].name, each.force, each.effort);
    for (const core::stepper::DriveForce& each : step.drives) add_drive(step.time, model.bodies[each.body].name, each.force, each.torque);
    for (const core::stepper::ContactForce& each : step.contacts)
        add_contact(step.time, model.bodies[each.a].name, model.bodies[each.b].name, each.normal);
    add_energies(step.time, step.kinetic_energy, step.potential_energy, step.contact_energy);
}

Json StepCurves::charts() const {
    Json list = Json::array();
    motor_torques_.append_to(list, "Motor torque", "torque", "N mm");
    motor_forces_.append_to(list, "Motor force", "force", "N");
    carried_.append_to(list, "Joint force", "force", "N");
    driving_torques_.append_to(list, "Driving torque", "torque", "N mm", least_drive);
    driving_forces_.append_to(list, "Driving and guiding force", "force", "N", least_drive);
    held_.append_to(list, "Force on fixed parts", "force", "N");
    normal_.append_to(list, "Contact", "normal force", "N");
    energy_.append_to(list, "Energy", "energy", "mJ");
    return list;
}

}  // namespace fettle::design::report
