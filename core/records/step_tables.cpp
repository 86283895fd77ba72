// SPDX-License-Identifier: MIT
#include "core/records/step_tables.hpp"

#include <charconv>
#include <cmath>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"

namespace fettle::core::records {
namespace {

class Row {
public:
    explicit Row(std::string& text) : text_(text) {}
    ~Row() { text_ += '\n'; }
    Row(const Row&) = delete;
    Row& operator=(const Row&) = delete;

    Row& add(double x) {
        separate();
        if (!std::isfinite(x)) return *this;  // an empty field
        char buffer[32];
        const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, x);
        text_.append(buffer, end);
        return *this;
    }
    Row& add(int x) {
        separate();
        text_ += std::to_string(x);
        return *this;
    }
    Row& add(const Vector3& v) { return add(v.x()).add(v.y()).add(v.z()); }
    Row& add(const std::string& word) {
        separate();
        text_ += base::csv_cell(word);
        return *this;
    }

private:
    void separate() {
        if (!first_) text_ += ',';
        first_ = false;
    }
    std::string& text_;
    bool first_ = true;
};

}  // namespace

std::string steps_csv(const stepper::Simulation& simulation) {
    std::string text =
        "time,kinetic_energy,potential_energy,contact_energy,spring_energy,supplied_power,dissipated_power,px,py,pz,lx,ly,lz,kappa,newton_"
        "iterations,friction_rounds,contacts,"
        "minimum_distance,residual\n";
    const std::size_t count = simulation.outputs.size(), reports = simulation.report.steps.size();
    FETTLE_ASSERT(reports >= count, "more outputs than steps");
    for (std::size_t t = 0; t < count; ++t) {
        const stepper::StepOutputs& o = simulation.outputs[t];
        const stepper::StepReport& r = simulation.report.steps[reports - count + t];
        Row(text)
            .add(o.time)
            .add(o.kinetic_energy)
            .add(o.potential_energy)
            .add(o.contact_energy)
            .add(o.spring_energy)
            .add(o.supplied_power)
            .add(o.dissipated_power)
            .add(o.linear_momentum)
            .add(o.angular_momentum)
            .add(o.kappa)
            .add(r.newton_iterations)
            .add(r.friction_rounds)
            .add(r.contacts)
            .add(r.minimum_distance)
            .add(r.residual);
    }
    return text;
}

std::string contacts_csv(const stepper::Simulation& simulation, const std::vector<std::string>& names) {
    std::string text = "time,a,b,fx,fy,fz,tx,ty,tz,normal,sx,sy,sz,distance,contacts\n";
    for (const stepper::StepOutputs& o : simulation.outputs)
        for (const stepper::ContactForce& f : o.contacts)
            Row(text)
                .add(o.time)
                .add(names[f.a])
                .add(names[f.b])
                .add(f.force)
                .add(f.torque)
                .add(f.normal)
                .add(f.friction)
                .add(f.distance)
                .add(f.contacts);
    return text;
}

std::string drives_csv(const stepper::Simulation& simulation, const std::vector<std::string>& names) {
    std::string text = "time,body,fx,fy,fz,tx,ty,tz\n";
    for (const stepper::StepOutputs& o : simulation.outputs)
        for (const stepper::DriveForce& d : o.drives) Row(text).add(o.time).add(names[d.body]).add(d.force).add(d.torque);
    return text;
}

std::string joints_csv(const stepper::Simulation& simulation, const model::Mechanism& mechanism) {
    std::string text = "time,name,fx,fy,fz,tx,ty,tz,effort,spring,damping,friction,stop\n";
    for (const stepper::StepOutputs& o : simulation.outputs)
        for (const stepper::JointForce& f : o.joints)
            Row(text)
                .add(o.time)
                .add(mechanism.joints[f.joint].name)
                .add(f.force)
                .add(f.torque)
                .add(f.effort)
                .add(f.spring)
                .add(f.damping)
                .add(f.friction)
                .add(f.stop);
    return text;
}

std::string joined_table(const std::string& earlier, const std::string& later, double until) {
    const std::size_t header = later.find('\n') + 1;
    if (earlier.compare(0, header, later, 0, header) != 0) return later;
    std::size_t end = header;
    bool kept = true;
    for (std::size_t at = header; at < earlier.size() && kept;) {
        // A line that does not begin with a number goes on with a quoted name.
        double time = 0;
        const bool row = std::from_chars(earlier.data() + at, earlier.data() + earlier.size(), time).ec == std::errc();
        kept = !row || time <= until;
        const std::size_t line_end = earlier.find('\n', at);
        at = line_end == std::string::npos ? earlier.size() : line_end + 1;
        if (kept) end = at;
    }
    return earlier.substr(0, end) + later.substr(header);
}

}  // namespace fettle::core::records
