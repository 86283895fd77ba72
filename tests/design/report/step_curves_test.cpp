// SPDX-License-Identifier: MIT
// Curves of forces and energies: from tables, in the units that are told, and the same from the values that the tables are of.
#include "design/report/step_curves.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/records/step_tables.hpp"
#include "design/report/kept_steps.hpp"
#include "design/report/table_rows.hpp"
#include "tests/design/report/packed.hpp"

namespace fettle::design::report::step_curves_test {

namespace {

using Json = nlohmann::ordered_json;
using tests::report_support::unpacked;

// A base that does not move, a crank, and a slide, "=pushed", whose name a spreadsheet would take for a formula.
core::model::Model posts() {
    core::model::Model model;
    for (const char* name : {"base", "crank", "=pushed"}) {
        core::model::Body body;
        body.name = name;
        body.type = name == std::string("base") ? core::scene::BodyType::static_body : core::scene::BodyType::kinematic_body;
        model.bodies.push_back(body);
    }
    using core::scene::JointKind;
    for (const auto& [name, kind, is_motor] :
         {std::tuple("hinge", JointKind::revolute, false), std::tuple("turn", JointKind::revolute, true),
          std::tuple("push, pull", JointKind::prismatic, true)}) {
        core::model::Joint joint;
        joint.name = name;
        joint.kind = kind;
        joint.is_motor = is_motor;
        model.mechanism.joints.push_back(joint);
    }
    return model;
}

// Three steps in which all of it carries something, and once something that is no number.
core::stepper::Simulation carried() {
    core::stepper::Simulation simulation;
    for (int t = 1; t <= 3; ++t) {
        core::stepper::StepOutputs step;
        const double x = 0.1 * t;
        step.time = x;
        step.kinetic_energy = x / 3;
        step.potential_energy = -x;
        step.contact_energy = 1e-9 / x;
        for (int j = 0; j < 3; ++j) step.joints.push_back({j, Vector3(x, 2 * x, j), Vector3::Zero(), x * (j - 1) / 7});
        for (int b = 0; b < 3; ++b) step.drives.push_back({b, Vector3(x, b, -x), Vector3(0, x / 3, b * x)});
        core::stepper::ContactForce contact;
        contact.a = 1;
        contact.b = 2;
        contact.normal = t == 2 ? std::numeric_limits<double>::infinity() : x / 11;
        if (t != 3) step.contacts.push_back(contact);
        simulation.outputs.push_back(step);
        simulation.report.steps.emplace_back();
    }
    return simulation;
}

}  // namespace

TEST_CASE("step curves: tables with quoted words, rows that are cut off") {
    const TableRows table("a,b\n\"x,\"\"y\",1.5\nz,\ncut");
    REQUIRE(table.size() == 2);
    CHECK(table.word(0, "a") == "x,\"y");
    CHECK(table.number(0, "b") == 1.5);
    CHECK(std::isnan(table.number(1, "b")));
    CHECK(std::isnan(table.number(0, "c")));
    CHECK(table.has("b"));
    CHECK(TableRows("").size() == 0);
}

TEST_CASE("step curves: forces, in the units that are told") {
    StepTables tables;
    tables.joints = "time,name,fx,fy,fz,tx,ty,tz,effort\n0.1,hinge,3,4,0,0,0,0,0\n0.1,turn,0,0,0,0,0,0,0.002\n0.1,push,0,0,1,0,0,0,7\n";
    tables.drives = "time,body,fx,fy,fz,tx,ty,tz\n0.1,base,0,3,4,0,0,0\n0.1,crank,0,0,0,0,0,-0.5\n0.2,crank,0,0,0,0,0,0.25\n";
    tables.contacts = "time,a,b,normal\n0.1,x,y,2\n0.3,x,z,1\n";
    StepCurves gathered(posts(), {"push"});
    CHECK(gathered.empty());
    add_steps(tables, gathered);
    const Json curves = gathered.charts();
    const auto curve = [&](const std::string& title) {
        for (const Json& each : curves)
            if (each["title"] == title) return each;
        return Json();
    };
    const auto values = [](const Json& line) { return unpacked<double>(line["values"], "f64"); };
    REQUIRE(curve("Motor torque")["lines"].size() == 1);
    CHECK(curve("Motor torque")["lines"][0]["name"] == "turn");
    CHECK(values(curve("Motor torque")["lines"][0]) == std::vector<double>{2});
    CHECK(curve("Motor torque")["unit"] == "N mm");
    CHECK(values(curve("Motor force")["lines"][0]) == std::vector<double>{7});
    CHECK(values(curve("Joint force")["lines"][0]) == std::vector<double>{5});
    REQUIRE(curve("Driving torque")["lines"].size() == 1);
    CHECK(curve("Driving torque")["lines"][0]["name"] == "crank about z");
    CHECK(values(curve("Driving torque")["lines"][0]) == std::vector<double>{-500, 250});
    CHECK(values(curve("Force on fixed parts")["lines"][0]) == std::vector<double>{5});
    CHECK(curve("Driving and guiding force").is_null());  // nothing but zeros
    REQUIRE(curve("Contact")["lines"].size() == 2);
    CHECK(unpacked<double>(curve("Contact")["time"], "f64") == std::vector<double>{0.1, 0.3});
    CHECK(values(curve("Contact")["lines"][0]) == std::vector<double>{2, 0});  // what does not touch carries nothing
    CHECK(values(curve("Contact")["lines"][1]) == std::vector<double>{0, 1});
}

TEST_CASE("step curves: the values of a run and its tables give the same") {
    const core::model::Model model = posts();
    const core::stepper::Simulation simulation = carried();
    const LinearMotors linear = linear_motors(model);
    CHECK(linear == LinearMotors{"push, pull"});
    StepCurves from_values(model, linear), from_tables(model, linear);
    for (const core::stepper::StepOutputs& step : simulation.outputs) from_values.add(step, model);
    const std::vector<std::string> names{"base", "crank", "=pushed"};
    add_steps({core::records::steps_csv(simulation), core::records::contacts_csv(simulation, names),
               core::records::drives_csv(simulation, names), core::records::joints_csv(simulation, model.mechanism)},
              from_tables);
    const Json charts = from_values.charts();
    CHECK(charts == from_tables.charts());
    CHECK_FALSE(from_values.empty());
    std::vector<std::string> titles;
    for (const Json& chart : charts) titles.push_back(chart["title"]);
    CHECK(titles == std::vector<std::string>{"Motor torque", "Motor force", "Joint force", "Driving torque", "Driving and guiding force",
                                             "Force on fixed parts", "Contact", "Energy"});
    const auto contact = unpacked<double>(charts[6]["lines"][0]["values"], "f64");
    REQUIRE(contact.size() == 2);
    CHECK(contact[0] == 0.1 / 11);
    CHECK(std::isnan(contact[1]));
    CHECK(StepCurves().charts().empty());
    CHECK(StepCurves().empty());
}

}  // namespace fettle::design::report::step_curves_test
