// SPDX-License-Identifier: MIT
#include "design/answers/growing_tables.hpp"

#include <cstddef>
#include <utility>

#include "core/records/step_tables.hpp"
#include "design/answers/answer_json.hpp"

namespace fettle::design::answers {

using core::stepper::Simulation;

namespace {

constexpr std::size_t rows_at_once = std::size_t{1} << 16;

}  // namespace

GrowingTables::GrowingTables(const std::filesystem::path& folder, const core::model::Model& model) {
    const auto add = [&](const char* name, std::function<std::string(const Simulation&)> text) {
        std::string header = text(Simulation());
        tables_.push_back({name, std::move(text), core::files::NewFile(folder / name), std::move(header)});
    };
    const std::vector<std::string> names = body_names(model);
    add("steps.csv", core::records::steps_csv);
    add("contacts.csv", [names](const Simulation& simulation) { return core::records::contacts_csv(simulation, names); });
    add("drives.csv", [names](const Simulation& simulation) { return core::records::drives_csv(simulation, names); });
    if (model.mechanism.joints.empty()) return;
    add("joints.csv", [&model](const Simulation& simulation) { return core::records::joints_csv(simulation, model.mechanism); });
}

void GrowingTables::go_on_with(const std::filesystem::path& trajectory, double until) {
    if (trajectory.filename() != "trajectory.json") return;  // tables take their names together with it: they are about no other one
    for (Table& table : tables_) {
        const Result<std::string> before = core::files::read_file(trajectory.parent_path() / table.name);
        if (before) table.waiting = core::records::joined_table(*before, table.waiting, until);
    }
}

void GrowingTables::write(const Simulation& so_far) {
    Simulation last;  // what is kept of the steps before has been written
    last.report.steps.push_back(so_far.report.steps.back());
    last.outputs.push_back(so_far.outputs.back());
    for (Table& table : tables_) {
        const std::string text = table.text(last);
        table.waiting.append(text, text.find('\n') + 1);
        if (table.waiting.size() < rows_at_once) continue;
        table.file.write(table.waiting);
        table.waiting.clear();
    }
}

Errors GrowingTables::add_to(core::files::FilesTogether& files) {
    Errors errors;
    for (Table& table : tables_) {
        table.file.write(table.waiting);
        if (errors.empty()) errors = files.add(std::move(table.file));
    }
    tables_.clear();
    return errors;
}

}  // namespace fettle::design::answers
