// SPDX-License-Identifier: MIT
#include "design/report/kept_steps.hpp"

#include "design/report/answer_values.hpp"
#include "design/report/table_rows.hpp"

namespace fettle::design::report {

namespace {

// "f" -> the columns fx, fy, fz.
Vector3 vector_in(const TableRows& table, std::size_t row, const std::string& of) {
    return {table.number(row, of + "x"), table.number(row, of + "y"), table.number(row, of + "z")};
}

}  // namespace

StepTables read_step_tables(const std::filesystem::path& folder) {
    return {text_or_empty(folder / "steps.csv"), text_or_empty(folder / "contacts.csv"), text_or_empty(folder / "drives.csv"),
            text_or_empty(folder / "joints.csv")};
}

void add_steps(const StepTables& tables, StepCurves& curves) {
    const TableRows joints(tables.joints), drives(tables.drives), contacts(tables.contacts), steps(tables.steps);
    for (std::size_t i = 0; i < joints.size(); ++i)
        curves.add_joint(joints.number(i, "time"), joints.word(i, "name"), vector_in(joints, i, "f"), joints.number(i, "effort"));
    for (std::size_t i = 0; i < drives.size(); ++i)
        curves.add_drive(drives.number(i, "time"), drives.word(i, "body"), vector_in(drives, i, "f"), vector_in(drives, i, "t"));
    for (std::size_t i = 0; i < contacts.size(); ++i)
        curves.add_contact(contacts.number(i, "time"), contacts.word(i, "a"), contacts.word(i, "b"), contacts.number(i, "normal"));
    for (std::size_t i = 0; i < steps.size(); ++i)
        curves.add_energies(steps.number(i, "time"), steps.number(i, "kinetic_energy"), steps.number(i, "potential_energy"),
                            steps.number(i, "contact_energy"));
}

}  // namespace fettle::design::report
