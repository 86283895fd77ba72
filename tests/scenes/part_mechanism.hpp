// SPDX-License-Identifier: MIT
/// Mechanisms of the library's parts, written as a user writes them and run with the settings of one who gives none: activation distance,
/// stiffness and tolerances are fettle's own choice, and so are the parts' facets unless a test says otherwise.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "core/base/text.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/shapes/part_library.hpp"
#include "tests/support/intersection_oracle.hpp"

namespace fettle::tests::scenes::part_mechanism {

using core::base::formatted;

/// A part of the library with what a scene says of it: lengths in mm, angles in degrees.
struct Part {
    std::string name;
    std::map<std::string, double> dimensions;
    core::part_files::Counts counts;
    double facets = 0;  ///< how far facets may be from what is round [mm]; 0: as the part has it
};

/// The value of a scene's key `shape`.
inline std::string shape_text(const Part& part) {
    std::string out = R"({"part": ")" + part.name + '"';
    if (part.facets > 0) out += formatted(R"(, "facets": %.17g)", part.facets);
    const auto add = [&](const char* key, const auto& values) {
        std::string list;
        for (const auto& [name, value] : values) {
            list += list.empty() ? "" : ", ";
            list += '"' + name + formatted("\": %.17g", static_cast<double>(value));
        }
        out += std::string(", \"") + key + "\": {" + list + '}';
    };
    add("dimensions", part.dimensions);
    add("counts", part.counts);
    return out + '}';
}

/// How far the true surfaces of a part are from its facets [m], outside and inside: those of its widest facets.
/// Errors: a part that cannot be drawn at these dimensions.
inline Result<core::parts::DrawnPart> drawn(const Part& part) {
    const auto file = design::shapes::find_part(part.name, part.counts);
    if (!file) return file.errors();
    std::vector<double> values;
    for (const auto& dimension : file->dimensions()) {
        const auto given = part.dimensions.find(dimension.name);
        const bool is_angle = dimension.kind == core::part_files::PartDimensionKind::angle,
                   is_number = dimension.kind == core::part_files::PartDimensionKind::number;
        values.push_back(given == part.dimensions.end() ? dimension.value
                                                        : given->second * (is_angle    ? std::numbers::pi / 180
                                                                           : is_number ? 1
                                                                                       : 1e-3));
    }
    core::parts::Facets facets = file->facets();
    facets.chord = part.facets * 1e-3;
    return file->drawn(values, facets, {}, {.jacobian = false, .check = false});
}

/// A scene, run to its end.
struct Run {
    core::model::Model model;
    core::stepper::Simulation simulation;

    int steps() const { return count_of(simulation.trajectory.steps); }
    const core::kinematics::Pose& pose(int body, int t) const { return simulation.trajectory.poses[t][body]; }
    double x(int body, int t) const { return pose(body, t).position.x(); }
    /// Least distance of parts at the end of step t [m]: of those that are nearer than dhat, infinity if none is. Contract: t > 0.
    double distance(int t) const { return simulation.report.steps[t - 1].minimum_distance; }
    /// How much farther out than its round surfaces a pair of parts meets [m]: the largest covers (geometry/round_surfaces.hpp).
    double covers() const {
        double sum = 0;
        for (const core::model::Body& body : model.bodies) {
            double largest = 0;
            if (body.round)
                for (const auto& side : body.round->sides) largest = std::max(largest, side.cover);
            sum += largest;
        }
        return sum;
    }
    /// Angle about z that a body has turned by since the start [rad], per node of the path; it may pass full turns.
    std::vector<double> turned(int body) const {
        std::vector<double> out{0};
        for (int t = 0; t < steps(); ++t) {
            const Matrix3 by = pose(body, t + 1).rotation * pose(body, t).rotation.transpose();
            out.push_back(out.back() + std::atan2(by(1, 0), by(0, 0)));
        }
        return out;
    }
};

inline Run run(const std::string& scene_text, const core::stepper::SimulationOptions& options = {}) {
    const auto scene = core::scene_files::parse_scene(scene_text, "part_mechanism.scene.json", design::reading::scene_read_options());
    for (const Error& error : scene.errors()) FAIL(error.where << ": " << error.message);
    auto model = core::setup::build_model(*scene);
    for (const Error& error : model.errors()) FAIL(error.where << ": " << error.message);
    Run out{std::move(*model), {}};
    out.simulation = core::stepper::simulate(out.model, options);
    return out;
}

/// What is wrong with a run: it stopped, or parts meet, by exact predicates, at a node of the path or between two. Empty: nothing.
inline std::string fault_of(const Run& run) {
    if (run.simulation.report.status != core::stepper::SimulationStatus::ok) return run.simulation.report.message;
    const support::IntersectionReport report = support::find_intersections(run.model, run.simulation.trajectory, 1);
    return report.intersections.empty() ? std::string() : to_string(report.intersections.front(), run.model);
}

}  // namespace fettle::tests::scenes::part_mechanism
