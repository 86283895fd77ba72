// SPDX-License-Identifier: MIT
/// fettle draw FILE --out PICTURE: a PNG or SVG without a browser, the two points that are nearest marked.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/rounded_lengths.hpp"
#include "core/base/units.hpp"
#include "core/clearance/clearance.hpp"
#include "core/files/atomic_file.hpp"
#include "design/answers/answer_json.hpp"
#include "design/answers/output_folder.hpp"
#include "design/clearance/pairs.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/shown_motion.hpp"
#include "design/exports/picture.hpp"
#include "design/exports/png_writer.hpp"
#include "design/exports/svg_writer.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::base::RoundedLengths;
using core::base::Towards;
using core::clearance::PairClearance;
using core::kinematics::Pose;
using core::stepper::Trajectory;

struct DrawArguments {
    ShownOptions shown;
    std::string out, view = "iso", size = "1200x900", title;
    std::optional<double> time;
    bool worst = false, plain = false;
};

Result<std::pair<int, int>> picture_size(const std::string& text) {
    int width = 0, height = 0;
    char end = 0;
    const bool read = std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &end) == 2;
    if (!read || std::min(width, height) < 16 || std::max(width, height) > 16384)
        return Error{ErrorCode::out_of_range, "--size", "\"" + text + "\" is not a size of a picture: 1200x900, each from 16 to 16384"};
    return std::pair{width, height};
}

/// Poses at a time of the path; before it the first, after it the last.
std::vector<Pose> poses_at(const Trajectory& trajectory, double time) {
    const int steps = count_of(trajectory.steps), bodies = static_cast<int>(trajectory.poses.front().size());
    if (steps == 0 || time <= core::stepper::time_at(trajectory, 0)) return trajectory.poses.front();
    for (int t = 0; t < steps; ++t) {
        if (time > core::stepper::time_at(trajectory, t + 1)) continue;
        const int segments = core::stepper::segment_count(trajectory, t);
        for (int k = 0; k < segments; ++k) {
            const double begin = core::stepper::time_at(trajectory, t, k, 0), end = core::stepper::time_at(trajectory, t, k, 1);
            if (time > end && k + 1 < segments) continue;
            const double s = end > begin ? std::clamp((time - begin) / (end - begin), 0.0, 1.0) : 1;
            std::vector<Pose> poses;
            for (int b = 0; b < bodies; ++b) poses.push_back(core::stepper::pose_at(trajectory, t, k, s, b));
            return poses;
        }
    }
    return trajectory.poses.back();
}

std::vector<core::clearance::PairRequest> judged_pairs(const core::model::Model& model, const std::vector<int>& shown) {
    std::vector<core::clearance::PairRequest> requests;
    for (std::size_t i = 0; i < shown.size(); ++i)
        for (std::size_t j = i + 1; j < shown.size(); ++j)
            if (clearance::judged_by_default(model, shown[i], shown[j])) requests.push_back({shown[i], shown[j]});
    return requests;
}

/// The pair with the least upper bound that has two points; a clash before all others.
const PairClearance* worst_of(const std::vector<PairClearance>& pairs) {
    const PairClearance* worst = nullptr;
    for (const PairClearance& pair : pairs) {
        if (pair.is_far || !std::isfinite(pair.upper) || pair.witness.primitive_a < 0) continue;
        const bool before = worst == nullptr || (pair.is_clash() && !worst->is_clash()) ||
                            (pair.is_clash() == worst->is_clash() && pair.upper < worst->upper);
        if (before) worst = &pair;
    }
    return worst;
}

/// The deepest of the pairs that interfere, of which there is at least one: measured, up to so many.
PairClearance deepest_of(const core::model::Model& model, const Trajectory& trajectory, const std::vector<PairClearance>& pairs,
                         core::clearance::ClearanceOptions options) {
    constexpr std::size_t most_measured = 32;
    std::vector<core::clearance::PairRequest> clashes;
    for (const PairClearance& pair : pairs)
        if (pair.is_clash() && clashes.size() < most_measured) clashes.push_back({pair.a, pair.b});
    options.measure_overlap = true;
    const std::vector<PairClearance> measured = core::clearance::certify(model, trajectory, clashes, options);
    const auto depth = [](const PairClearance& pair) { return pair.overlap ? pair.overlap->depth_upper : 0.0; };
    return *std::max_element(measured.begin(), measured.end(), [&](const auto& x, const auto& y) { return depth(x) < depth(y); });
}

std::optional<PairClearance> find_worst(const core::model::Model& model, const std::vector<int>& shown, const Trajectory& trajectory,
                                        bool motion) {
    core::clearance::ClearanceOptions options;
    options.motion = motion;
    options.measure_overlap = options.sample_nodes = false;
    options.tolerance = 1e-4 * model.diagonal;
    options.should_stop = interrupted;
    const auto pairs = core::clearance::certify(model, trajectory, judged_pairs(model, shown), options);
    const PairClearance* worst = worst_of(pairs);
    if (worst == nullptr) return std::nullopt;
    return worst->is_clash() ? deepest_of(model, trajectory, pairs, options) : *worst;
}

/// When a pair is shown: where it is nearest, of an interference where it is deepest.
double instant_of(const PairClearance& pair) { return pair.is_clash() && pair.overlap ? pair.overlap->time : pair.witness.time; }

/// The poses to draw, and what is nearest in them, or over the whole motion (--worst).
struct Instant {
    double time = 0;
    std::vector<Pose> poses;
    std::optional<PairClearance> worst;
};

// Faults of --time.
Errors time_faults(const DrawArguments& options, const Trajectory& path) {
    const double first = core::stepper::time_at(path, 0), last = core::stepper::time_at(path, count_of(path.steps));
    if (!options.time || (*options.time >= first && *options.time <= last)) return {};
    const std::string known = path.steps.empty() ? "there is no motion, only where the parts stand: draw the folder of a run"
                                                 : formatted("the motion is from %.6g s to %.6g s", first, last);
    return {{ErrorCode::out_of_range, "--time", known + formatted("; found %.6g s", *options.time)}};
}

Instant instant_of(const DrawArguments& options, const ShownMotion& shown) {
    const clearance::Subject& subject = shown.subject;
    const Trajectory& path = subject.domain.path();
    const bool motion = !path.steps.empty();
    Instant out;
    if (options.worst && motion) {
        out.worst = find_worst(subject.model, shown.bodies, path, true);
        out.time = out.worst ? instant_of(*out.worst) : core::stepper::time_at(path, 0);
        out.poses = poses_at(path, out.time);
        return out;
    }
    out.time = options.time.value_or(core::stepper::time_at(path, 0));
    out.poses = poses_at(path, out.time);
    if (options.plain) return out;
    Trajectory still = path;  // judged as it stands there
    still.steps.clear();
    still.times.clear();
    still.time_start = out.time;
    still.poses = {out.poses};
    out.worst = find_worst(subject.model, shown.bodies, still, false);
    return out;
}

exports::PictureMarker marker_of(const PairClearance& pair, const core::model::Model& model) {
    const auto name = [&](int body) { return model.bodies[body].name; };
    const std::string unit = answers::unit_name(model.length_unit), pair_name = name(pair.a) + ":" + name(pair.b) + " ";
    if (!pair.is_clash()) return {pair.witness.point_a, pair.witness.point_b, pair_name + core::base::format_length(pair.upper, unit, 3)};
    if (!pair.overlap || !(pair.overlap->depth_lower > 0))
        return {pair.witness.point_a, pair.witness.point_b, pair_name + "interference", true};
    const RoundedLengths lengths(unit, 2);
    const std::string low = lengths.fixed(pair.overlap->depth_lower, Towards::down),
                      high = lengths.fixed(pair.overlap->depth_upper, Towards::up);
    const std::string depth =
        (pair.overlap->depth_upper <= 1.01 * pair.overlap->depth_lower ? high : "at least " + low) + " " + unit + " deep";
    return {pair.overlap->center, pair.overlap->center, pair_name + "interference, " + depth, true, pair.overlap->depth_upper};
}

int run_draw(const DrawArguments& options, const CommonOptions& common, Console& console) {
    const bool png = options.out.ends_with(".png"), svg = options.out.ends_with(".svg");
    if (!png && !svg) return console.input_errors({{ErrorCode::unsupported, "--out", "a picture is .png or .svg, found " + options.out}});
    const auto size = picture_size(options.size);
    if (!size) return console.input_errors(size.errors());
    if (const Errors errors = answers::try_output_file(options.out); !errors.empty()) return console.input_errors(errors);
    const Result<ShownMotion> shown = load_shown(options.shown, common, console);
    if (!shown) return console.input_errors(shown.errors());
    const auto view = exports::projection_view(options.view, shown->assembly.up, "--view");
    if (!view) return console.input_errors(view.errors());
    if (const Errors errors = time_faults(options, shown->subject.domain.path()); !errors.empty()) return console.input_errors(errors);
    const Instant instant = instant_of(options, *shown);
    exports::PictureOptions picture_options;
    picture_options.view = *view;
    picture_options.width = size->first;
    picture_options.height = size->second;
    const bool motion = !shown->subject.domain.path().steps.empty();
    picture_options.title = !options.title.empty() ? options.title : shown->stem + (motion ? formatted(", t = %.6g s", instant.time) : "");
    if (instant.worst && !options.plain) picture_options.marker = marker_of(*instant.worst, shown->subject.model);
    const exports::Picture picture = exports::draw_picture(shown->assembly, only(shown->bodies, instant.poses), picture_options);
    const Errors errors = core::files::write_file_atomically(options.out, png ? exports::png_bytes(picture) : exports::svg_text(picture));
    if (!errors.empty()) return console.input_errors(errors);
    Json json{{"status", "ok"},       {"out", options.out},     {"time", instant.time},
              {"width", size->first}, {"height", size->second}, {"worst", nullptr}};
    std::string text = options.out + ": " + picture_options.title + "\n";
    if (instant.worst) {
        json["worst"] = answers::pair_json(*instant.worst, answers::body_names(shown->subject.model));
        text += "nearest: " + marker_of(*instant.worst, shown->subject.model).text + "\n";
    }
    console.result(json, text);
    return exit_done;
}

}  // namespace

Command add_draw(CommandLine& program, const CommonOptions& common) {
    CommandLine app = program.command("draw", "Draws a picture (png, svg) with the nearest points of two bodies marked");
    auto options = std::make_shared<DrawArguments>();
    add_shown_options(app, options->shown);
    app.option("--out", options->out, "Picture to write: .png or .svg").required();
    app.option("--view", options->view,
               "iso (default), front, back, left, right, top, bottom, or azimuth,elevation in degrees: where the viewer stands, from the "
               "front to the right and up");
    Option time = app.option("--time", options->time, "For a motion: the instant in seconds (default: its start)");
    app.flag("--worst", options->worst, "For a motion: the instant at which two bodies are nearest").excludes(time);
    app.option("--size", options->size, "Pixels (default 1200x900)");
    app.option("--title", options->title, "Written on top (default: the file's name, and the time)");
    app.flag("--plain", options->plain, "Mark nothing");
    app.closing_words(
        "Example:  fettle draw examples/slider_crank/slider_crank.scene.json --out slider_crank.png\n"
        "          fettle draw out --worst --view top --out nearest.svg");
    return {app, [options, &common](Console& console) { return run_draw(*options, common, console); }};
}

}  // namespace fettle::design::cli
