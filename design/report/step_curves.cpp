// SPDX-License-Identifier: MIT
#include "design/report/step_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "design/report/packed_numbers.hpp"
#include "design/report/table_rows.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_lines = 8, most_instants = 2000;
constexpr double newton_millimetre = 1e-3, millijoule = 1e-3;

// One curve being gathered: lines by name over common times.
class Curve {
public:
    void add(const std::string& name, double time, double value) {
        const std::size_t at = times_.try_emplace(time, times_.size()).first->second;
        std::vector<std::pair<std::size_t, double>>& line = lines_[name];
        line.emplace_back(at, value);
        largest_[name] = std::max(largest_[name], std::isfinite(value) ? std::abs(value) : 0);
    }

    /// Lines of no more than `share` of the largest are left out. Where a line has no value it is 0: a pair that does not touch.
    std::optional<Json> json(const std::string& title, const std::string& quantity, const std::string& unit, double share = 0) const {
        std::vector<std::pair<double, std::string>> order;
        double top = 0;
        for (const auto& [name, size] : largest_) top = std::max(top, size);
        for (const auto& [name, size] : largest_)
            if (size > share * top) order.emplace_back(-size, name);
        if (order.empty()) return std::nullopt;
        std::sort(order.begin(), order.end());
        const bool all = order.size() <= most_lines;
        if (!all) order.resize(most_lines);
        std::sort(order.begin(), order.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
        const std::size_t every = (times_.size() + most_instants - 1) / most_instants;
        Json lines = Json::array();
        for (const auto& [size, name] : order) lines.push_back({{"name", name}, {"values", packed(values(name, every))}});
        std::vector<double> times;
        for (const auto& [time, at] : times_) times.push_back(time);
        Json note = all ? Json() : Json("the " + std::to_string(most_lines) + " largest of " + std::to_string(largest_.size()));
        return Json{{"title", title}, {"quantity", quantity}, {"unit", unit}, {"note", note}, {"time", packed(thinned(times, every))},
                    {"lines", lines}};
    }

private:
    static std::vector<double> thinned(const std::vector<double>& all, std::size_t every) {
        std::vector<double> kept;
        for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, every)) kept.push_back(all[i]);
        return kept;
    }

    std::vector<double> values(const std::string& name, std::size_t every) const {
        std::vector<double> by_arrival(times_.size(), 0);
        for (const auto& [at, value] : lines_.at(name)) by_arrival[at] = value;
        std::vector<double> by_time;
        for (const auto& [time, at] : times_) by_time.push_back(by_arrival[at]);
        return thinned(by_time, every);
    }

    std::map<double, std::size_t> times_;
    std::map<std::string, std::vector<std::pair<std::size_t, double>>> lines_;
    std::map<std::string, double> largest_;
};

double length_of(const TableRows& table, std::size_t row, const std::array<const char*, 3>& columns) {
    return std::hypot(table.number(row, columns[0]), table.number(row, columns[1]), table.number(row, columns[2]));
}

void append(Json& list, std::optional<Json> curve) {
    if (curve) list.push_back(*std::move(curve));
}

// What prescribed coordinates of bodies that move take.
void add_drives(Json& list, const TableRows& drives, const std::set<std::string>& fixed) {
    Curve torques, forces, held;
    for (std::size_t i = 0; i < drives.size(); ++i) {
        const std::string& body = drives.word(i, "body");
        const double time = drives.number(i, "time");
        if (fixed.count(body) > 0) {
            held.add(body, time, length_of(drives, i, {"fx", "fy", "fz"}));
            continue;
        }
        for (const char axis : {'x', 'y', 'z'}) {
            torques.add(body + " about " + axis, time, drives.number(i, std::string("t") + axis) / newton_millimetre);
            forces.add(body + " along " + axis, time, drives.number(i, std::string("f") + axis));
        }
    }
    append(list, torques.json("Driving torque", "torque", "N mm", 1e-2));
    append(list, forces.json("Driving and guiding force", "force", "N", 1e-2));
    append(list, held.json("Force on fixed parts", "force", "N"));
}

void add_joints(Json& list, const TableRows& joints, const LinearMotors& linear) {
    Curve torques, forces, carried;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const std::string& name = joints.word(i, "name");
        const double time = joints.number(i, "time"), effort = joints.number(i, "effort");
        if (linear.count(name) > 0) {
            forces.add(name, time, effort);
        } else {
            torques.add(name, time, effort / newton_millimetre);
        }
        carried.add(name, time, length_of(joints, i, {"fx", "fy", "fz"}));
    }
    append(list, torques.json("Motor torque", "torque", "N mm"));
    append(list, forces.json("Motor force", "force", "N"));
    append(list, carried.json("Joint force", "force", "N"));
}

}  // namespace

Json step_curves(const StepTables& tables, const std::set<std::string>& fixed, const LinearMotors& linear) {
    Json list = Json::array();
    add_joints(list, TableRows(tables.joints), linear);
    add_drives(list, TableRows(tables.drives), fixed);
    Curve normal;
    const TableRows contacts(tables.contacts);
    for (std::size_t i = 0; i < contacts.size(); ++i)
        normal.add(contacts.word(i, "a") + " \u2013 " + contacts.word(i, "b"), contacts.number(i, "time"), contacts.number(i, "normal"));
    append(list, normal.json("Contact", "normal force", "N"));
    Curve energy;
    const TableRows steps(tables.steps);
    for (std::size_t i = 0; i < steps.size(); ++i)
        for (const char* kind : {"kinetic", "potential", "contact"})
            energy.add(kind, steps.number(i, "time"), steps.number(i, kind + std::string("_energy")) / millijoule);
    append(list, energy.json("Energy", "energy", "mJ"));
    return list;
}

}  // namespace fettle::design::report
