// SPDX-License-Identifier: MIT
#include "design/features/assembly_scene.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/nearest_word.hpp"
#include "core/files/unique_names.hpp"
#include "core/model/body_geometry.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "design/answers/answer_json.hpp"

namespace fettle::design::features {

namespace {

namespace fs = std::filesystem;
using core::features::JointKind;
using core::features::ProposedJoint;
using core::features::Stop;
using Json = nlohmann::ordered_json;

// Seen from the scene's folder.
std::string relative_path(const std::string& file, const std::string& scene) {
    std::error_code code;
    const fs::path whole = fs::absolute(file, code), relative = fs::relative(whole, fs::absolute(scene, code).parent_path(), code);
    return (code || relative.empty() ? whole : relative).generic_string();
}

Json body_json(const clearance::MeshParts& parts, std::size_t k, const AssemblyQuestion& question, bool moves) {
    const clearance::MeshSource& source = parts.sources[k];
    Json body{{"name", parts.model.bodies[k].name}, {"mesh", relative_path(source.file, question.to)}};
    if (!source.item.empty()) body["mesh_item"] = source.item;
    if (source.solid > 0) body["mesh_solid"] = source.solid;
    if (core::mesh_files::is_step(source.file)) {
        if (!question.step.facets.empty()) body["mesh_facets"] = question.step.facets;
        if (!question.step.surface_tolerance.empty()) body["surface_tolerance"] = question.step.surface_tolerance;
    }
    if (moves) {
        body["density"] = question.density;
    } else {
        body["type"] = "static";
    }
    return body;
}

// To a millionth of a micrometre: what is written is where the feature was fitted.
Json numbers_of(const Vector3& x, double unit) {
    Json out = Json::array();
    for (const double value : x) out.push_back(std::round(value / unit * 1e9) / 1e9 + 0.0);
    return out;
}

Json joint_json(const AssemblyJoint& joint, const core::model::Model& model) {
    const ProposedJoint& p = joint.proposed;
    Json out{{"# why", joint.reason},
             {"name", joint.name},
             {"type", to_string(p.kind)},
             {"a", model.bodies[p.a].name},
             {"b", model.bodies[p.b].name}};
    out["point"] = numbers_of(p.point, model.length_unit);
    if (p.kind != JointKind::ball && p.kind != JointKind::fixed) out["axis"] = numbers_of(p.axis, 1);
    if (!joint.limits.empty()) out["limits"] = joint.limits;
    return out;
}

std::string scene_text(const clearance::MeshParts& parts, const AssemblyQuestion& question, const AssemblyScene& scene) {
    const std::string mesh_note = "Where the files have them. What moves wants a `density` in place of its `type`, and joints.";
    Json out{{"fettle_scene", 1}, {"units", answers::unit_name(parts.model.length_unit)}};
    if (!question.joints) out["# bodies"] = mesh_note;
    out["bodies"] = Json::array();
    for (std::size_t k = 0; k < parts.sources.size(); ++k) {
        const bool moves = std::any_of(scene.joints.begin(), scene.joints.end(),
                                       [&](const AssemblyJoint& joint) { return joint.proposed.b == static_cast<int>(k); });
        out["bodies"].push_back(body_json(parts, k, question, moves));
    }
    if (!scene.joints.empty()) {
        out["# joints"] = "Proposed by fettle import, from what fits in what: change or delete what is meant otherwise.";
        out["joints"] = Json::array();
        for (const AssemblyJoint& joint : scene.joints) out["joints"].push_back(joint_json(joint, parts.model));
    }
    return core::files::dumped(out, 2) + "\n";
}

std::string millimetres(double x) { return core::base::formatted("%.3g mm", 1e3 * x); }

std::string reason_of(const FeaturesReport& report, const ProposedJoint& joint) {
    std::vector<std::pair<std::string, std::vector<std::string>>> fits;  // pin, holes
    for (const int k : joint.fits) {
        const core::features::Fit& fit = report.fits[static_cast<std::size_t>(k)].fit;
        const std::string pin = report.name_of(fit.pin);
        if (fits.empty() || fits.back().first != pin) fits.emplace_back(pin, std::vector<std::string>{});
        fits.back().second.push_back(report.name_of(fit.hole));
    }
    std::string out;
    for (const auto& [pin, holes] : fits) out += (out.empty() ? "" : "; ") + pin + " in " + core::base::joined(holes);
    if (joint.is_pressed) out += "; larger than the hole: a press fit";
    const auto stop_text = [&](const Stop& stop) {
        return report.name_of(stop.of_b) + " against " + report.name_of(stop.against) + " at " + millimetres(std::max(stop.gap, 0.0));
    };
    std::vector<std::string> stops;
    for (const auto& stop : joint.stops)
        if (stop) stops.push_back(stop_text(*stop));
    if (!stops.empty())
        out += std::string(stops.size() == 2 ? "; held both ways along the axis: " : "; held one way along the axis: ") +
               core::base::joined(stops);
    stops.clear();
    for (const Stop& stop : joint.guides) stops.push_back(stop_text(stop));
    if (!stops.empty()) out += "between flat faces: " + core::base::joined(stops);
    return out;
}

// The bodies that stand because they are the first of theirs, and those that nothing holds.
void name_the_others(const core::model::Model& model, int ground, AssemblyScene& scene) {
    for (int k = 0; k < count_of(model.bodies); ++k) {
        const auto is = [&](int ProposedJoint::*end) {
            return std::any_of(scene.joints.begin(), scene.joints.end(), [&](const AssemblyJoint& j) { return j.proposed.*end == k; });
        };
        if (is(&ProposedJoint::b)) continue;
        (k == ground || is(&ProposedJoint::a) ? scene.grounds : scene.unjoined).push_back(model.bodies[k].name);
    }
}

Result<int> ground_of(const core::model::Model& model, const std::vector<core::geometry::Mesh>& placed, const std::string& name) {
    if (name.empty()) return core::features::proposed_ground(placed);
    std::vector<std::string_view> names;
    for (int k = 0; k < count_of(model.bodies); ++k) {
        if (model.bodies[k].name == name) return k;
        names.push_back(model.bodies[k].name);
    }
    return Error{ErrorCode::unknown_key, "--ground", "no body is called `" + name + "`; " + core::files::did_you_mean(name, names)};
}

// From where to where each is free, as limits.
void find_limits(const AssemblyQuestion& question, AssemblyScene& scene) {
    const auto unknown = [&](const std::string& why) {
        for (AssemblyJoint& joint : scene.joints) joint.no_range = why;
    };
    core::scene::ReadOptions read;
    read.mesh_dirs = question.mesh_dirs;
    const auto parsed = core::scene_files::parse_scene(scene.text, question.to, read);
    if (!parsed) return unknown(parsed.errors().front().message);
    core::setup::BuildOptions build;
    build.check_start = false;
    const Result<core::model::Model> model = core::setup::build_model(*parsed, build);
    if (!model) return unknown(model.errors().front().message);
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
        AssemblyJoint& joint = scene.joints[k];
        if (joint.proposed.kind == JointKind::fixed || joint.proposed.kind == JointKind::ball) continue;
        question.on_progress("looking along the joints", static_cast<int>(k), count_of(scene.joints));
        clearance::RangesQuestion ask;
        ask.joints = {joint.name};
        ask.options.should_stop = question.should_stop;
        const Result<clearance::RangesReport> report = clearance::ask_ranges(*model, ask);
        if (!report) {
            joint.no_range = report.errors().front().message;
            continue;
        }
        const core::clearance::FreeRange& range = report->found.front();
        joint.range = clearance::range_sentence(*report, range);
        using Kind = core::clearance::RangeEnd::Kind;
        const bool has_end = range.below.kind == Kind::blocked || range.above.kind == Kind::blocked;
        const auto limits = clearance::proposed_limits(*report, range);
        if (limits && has_end) joint.limits = {limits->first, limits->second};
    }
}

}  // namespace

Result<AssemblyScene> assembly_scene(const clearance::MeshParts& parts, const AssemblyQuestion& question) {
    AssemblyScene scene;
    if (!question.joints) {
        scene.text = scene_text(parts, question, scene);
        return scene;
    }
    const core::model::Model& model = parts.model;
    std::vector<core::geometry::Mesh> placed;
    for (const core::model::Body& body : model.bodies) placed.push_back(core::model::mesh_at_start(body));
    const Result<int> ground = ground_of(model, placed, question.ground);
    if (!ground) return ground.errors();
    FeaturesQuestion ask;
    ask.should_stop = question.should_stop;
    ask.on_body = [&](int done, int of) { question.on_progress("looking for features", done, of); };
    const Result<FeaturesReport> report = ask_features(model, ask);
    if (!report) return report.errors();
    if (report->interrupted) {
        scene.interrupted = true;
        return scene;
    }
    std::vector<core::features::Fit> fits;
    for (const FoundFit& found : report->fits) fits.push_back(found.fit);
    core::files::UniqueNames names(" ");
    for (const ProposedJoint& proposed : core::features::propose_joints(placed, report->parts, fits, *ground)) {
        const std::string name = names.unique(model.bodies[proposed.a].name + "-" + model.bodies[proposed.b].name);
        scene.joints.push_back({proposed, name, reason_of(*report, proposed)});
    }
    name_the_others(model, *ground, scene);
    scene.text = scene_text(parts, question, scene);
    if (question.limits) {
        find_limits(question, scene);
        scene.text = scene_text(parts, question, scene);
    }
    scene.interrupted = question.should_stop();
    return scene;
}

Json assembly_json(const AssemblyScene& scene, const core::model::Model& model) {
    Json out{{"grounds", scene.grounds}, {"joints", Json::array()}, {"unjoined", scene.unjoined}};
    for (const AssemblyJoint& joint : scene.joints) {
        const ProposedJoint& p = joint.proposed;
        Json each{{"name", joint.name}, {"type", to_string(p.kind)}, {"a", model.bodies[p.a].name}, {"b", model.bodies[p.b].name}};
        each["point"] = {p.point.x(), p.point.y(), p.point.z()};
        each["axis"] = p.kind != JointKind::ball && p.kind != JointKind::fixed ? Json{p.axis.x(), p.axis.y(), p.axis.z()} : Json();
        each["reason"] = joint.reason;
        each["limits"] = joint.limits.empty() ? Json() : Json(joint.limits);
        each["range"] = joint.range ? Json(*joint.range) : Json();
        if (joint.no_range) each["range_unknown"] = *joint.no_range;
        out["joints"].push_back(std::move(each));
    }
    return out;
}

std::string assembly_text(const AssemblyScene& scene, const core::model::Model& model) {
    std::string out;
    const auto shown = [](const std::vector<std::string>& names) { return core::base::shown_on_one_line(core::base::joined(names)); };
    if (!scene.grounds.empty()) out += "  stands: " + shown(scene.grounds) + "\n";
    for (const AssemblyJoint& joint : scene.joints) {
        const ProposedJoint& p = joint.proposed;
        out += "  " + core::base::shown_on_one_line(joint.name) + ": " + to_string(p.kind);
        const auto triple = [](const Vector3& x, double unit) {
            const auto told = [&](double value) { return std::round(value / unit * 1e9) / 1e9 + 0.0; };
            return core::base::formatted("(%.5g, %.5g, %.5g)", told(x.x()), told(x.y()), told(x.z()));
        };
        if (p.kind != JointKind::fixed && p.kind != JointKind::ball) out += ", axis " + triple(p.axis, 1);
        if (p.kind != JointKind::fixed)
            out += (p.kind == JointKind::ball ? " at " : " through ") + triple(p.point, model.length_unit) + " " +
                   answers::unit_name(model.length_unit);
        out += "\n    " + core::base::shown_on_one_line(joint.reason) + "\n";
        if (joint.range) out += "    " + core::base::shown_on_one_line(*joint.range) + "\n";
    }
    std::map<std::string, std::vector<std::string>> unknown;  // joints by the reason
    for (const AssemblyJoint& joint : scene.joints)
        if (joint.no_range) unknown[*joint.no_range].push_back(joint.name);
    for (const auto& [why, names] : unknown)
        out += "  from where to where " + shown(names) + (names.size() == 1 ? " is" : " are") + " free is not known: " + why + "\n";
    if (scene.joints.empty() && !scene.grounds.empty()) out += "  no joints: nothing fits in anything\n";
    if (!scene.unjoined.empty()) out += "  not joined, so they stand: " + shown(scene.unjoined) + "\n";
    return out;
}

}  // namespace fettle::design::features
