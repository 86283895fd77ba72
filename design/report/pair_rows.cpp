// SPDX-License-Identifier: MIT
#include "design/report/pair_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "design/report/answer_values.hpp"
#include "design/report/moving_parts.hpp"
#include "design/report/packed_numbers.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;
using core::clearance::PairClearance;
using core::clearance::PairRequest;

constexpr std::size_t most_nearest = 12;           // rows of a simulation
constexpr int most_together = 2000;                // steps
constexpr int most_searched = 60;                  // of no more pairs each is searched by itself
constexpr long most_evaluations = 2'000'000;       // of a pair: what is longer is told with wider bounds
constexpr double share = 1e-2, wide_reach = 1.25;  // how well, and how far beyond the least, nearest pairs are looked for

Json millimetres(const Json& metres) {
    if (metres.is_number()) return metres.get<double>() / millimetre;
    if (!metres.is_array()) return {};
    Json list = Json::array();
    for (const Json& x : metres) list.push_back(x.get<double>() / millimetre);
    return list;
}

Json millimetres(const Vector3& p) { return {p.x() / millimetre, p.y() / millimetre, p.z() / millimetre}; }

int index_of(const core::model::Model& model, const std::string& name) {
    for (std::size_t i = 0; i < model.bodies.size(); ++i)
        if (model.bodies[i].name == name) return static_cast<int>(i);
    return -1;
}

std::vector<PairRequest> pairs_that_may_collide(const core::model::Model& model) {
    std::vector<PairRequest> requests;
    const auto count = count_of(model.bodies);
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b)
            if (core::model::may_collide(model, a, b)) requests.push_back({a, b, 0});
    return requests;
}

core::clearance::ClearanceOptions options_over_motion(double tolerance, const std::function<bool()>& should_stop) {
    core::clearance::ClearanceOptions options;
    options.motion = true;
    options.tolerance = tolerance;
    options.sample_nodes = options.measure_overlap = false;
    options.max_evaluations = most_evaluations;
    options.should_stop = should_stop;
    return options;
}

// Calls visit(motion, first) with stretches of at most `most_together` steps, the first of which is `first`: a search holds several
// kilobytes of each step.
template <class Visit>
void for_stretches(const core::stepper::Trajectory& trajectory, const Visit& visit) {
    const auto count = count_of(trajectory.steps);
    if (count <= most_together) return visit(trajectory, 0);
    for (int first = 0; first < count; first += most_together) {
        const int last = std::min(count, first + most_together);
        core::stepper::Trajectory stretch;
        stretch.time_start = core::stepper::time_at(trajectory, first);
        stretch.timestep = trajectory.timestep;
        stretch.body_names = trajectory.body_names;
        if (!trajectory.times.empty()) stretch.times.assign(trajectory.times.begin() + first, trajectory.times.begin() + last + 1);
        stretch.poses.assign(trajectory.poses.begin() + first, trajectory.poses.begin() + last + 1);
        stretch.steps.assign(trajectory.steps.begin() + first, trajectory.steps.begin() + last);
        visit(stretch, first);
    }
}

// The clearance that both tell of one pair together.
PairClearance together(const PairClearance& x, const PairClearance& y) {
    PairClearance nearer = y.upper < x.upper ? y : x;
    nearer.lower = std::min(x.lower, y.lower);
    nearer.intersecting = x.intersecting || y.intersecting;
    nearer.solids = core::certificate::are_apart(x.solids) ? y.solids : x.solids;
    return nearer;
}

std::vector<PairClearance> searched_each(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                         const std::vector<PairRequest>& requests, const core::clearance::ClearanceOptions& options) {
    std::vector<PairClearance> all;
    for_stretches(trajectory, [&](const core::stepper::Trajectory& stretch, int first) {
        std::vector<PairClearance> found = core::clearance::certify(model, stretch, requests, options);
        for (std::size_t k = 0; k < found.size(); ++k) {
            if (found[k].witness.step >= 0) found[k].witness.step += first;
            if (!all.empty()) found[k] = together(all[k], found[k]);
        }
        all = std::move(found);
    });
    return all;
}

// The nearest of the windows of each pair.
std::vector<PairClearance> nearest_of_pairs(const std::vector<PairClearance>& windows) {
    std::map<std::pair<int, int>, PairClearance> pairs;
    for (const PairClearance& window : windows) {
        const auto [at, is_new] = pairs.try_emplace({window.a, window.b}, window);
        if (!is_new && window.upper < at->second.upper) at->second = window;
    }
    std::vector<PairClearance> list;
    for (const auto& [key, pair] : pairs) list.push_back(pair);
    return list;
}

// Over the ranges of the joints: where the pair is worst. Null: it is no such pair, or nothing moves it.
Json worst_place(const Json& coordinates) {
    std::string text;
    for (const Json& each : coordinates.is_array() ? coordinates : Json::array()) {
        const bool is_angle = member(each, "unit") == "rad";
        char number[48];
        std::snprintf(number, sizeof number, is_angle ? " %.4g deg" : " %.4g mm",
                      each.at("value").get<double>() * (is_angle ? 180 / M_PI : 1 / millimetre));
        text += (text.empty() ? "worst at " : ", ") + each.at("joint").get<std::string>() + number;
    }
    return text.empty() ? Json() : Json(text);
}

Vector3 vector_of(const Json& json) { return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()}; }

// The bounds of an interference as an answer tells them, in mm to the power `dimensions`, with what is told beside them. Null: not
// measured.
Json measured_bounds(const Json& told, int dimensions) {
    if (!told.is_object()) return {};
    const double unit = std::pow(millimetre, dimensions);
    Json bounds{{"lower", told.at("lower").get<double>() / unit}, {"upper", told.at("upper").get<double>() / unit}};
    if (told.contains("time")) bounds["time"] = told["time"];
    if (told.contains("point")) bounds["point"] = millimetres(told["point"]);
    return bounds;
}

// Null: the two do not touch.
Json touching_of(const Json& told) {
    if (!told.is_object()) return {};
    return {{"area", told.at("area").get<double>() / (millimetre * millimetre)},
            {"at_least", member(told, "at_least") == true},
            {"allowed", member(told, "allowed") == true}};
}

// All bodies where a pair is worst over the ranges of the joints, of an answer's `poses`, which has those that moved. Null: it has none.
Json worst_poses(const Json& poses, const core::model::Model& model) {
    if (!poses.is_object()) return {};
    std::vector<float> numbers;
    for (const core::model::Body& body : model.bodies) {
        core::kinematics::Pose pose = body.pose_start;
        if (const auto moved = poses.find(body.name); moved != poses.end()) {
            for (int row = 0; row < 3; ++row) pose.rotation.row(row) = vector_of(moved->at("rotation").at(row));
            pose.position = vector_of(moved->at("position")) + pose.rotation * body.reference_point;
        }
        append_pose(numbers, pose);
    }
    return packed(numbers);
}

// Where nothing is proven there is no bound.
double bound_or(const Json& bound, double otherwise) { return bound.is_number() ? bound.get<double>() : otherwise; }

float rounded_down(double x) {
    const auto y = static_cast<float>(x);
    return static_cast<double>(y) > x ? std::nextafter(y, -std::numeric_limits<float>::infinity()) : y;
}
float rounded_up(double x) { return -rounded_down(-x); }

// A lower bound [mm] of some steps.
struct ProvenRange {
    StepRange steps;
    double lower = 0;
};

// What the rows prove of the two bodies of row `k`.
std::vector<ProvenRange> proven_ranges(const Json& rows, std::size_t k) {
    std::vector<ProvenRange> ranges;
    for (const Json& row : rows)
        if (row["body_a"] == rows[k]["body_a"] && row["body_b"] == rows[k]["body_b"] && row["lower"].is_number())
            ranges.push_back({{row["steps"][0].get<int>(), row["steps"][1].get<int>()}, row["lower"].get<double>()});
    return ranges;
}

// The margin's curve of row `k`. Searched to a coarser tolerance than the rows, a curve alone could fall below what is required and proven.
Json margin_curve(const Json& rows, std::size_t k, const std::vector<core::clearance::MarginInterval>& margin) {
    const std::vector<ProvenRange> ranges = proven_ranges(rows, k);
    double least = bound_or(rows[k]["lower"], std::numeric_limits<double>::infinity());
    std::vector<float> low, high;
    for (const core::clearance::MarginInterval& each : margin) {
        const double upper = each.upper / millimetre;
        double lower = each.lower / millimetre;
        for (const auto& [steps, proven] : ranges)  // one above the upper bound is of another motion
            if (steps.first <= each.step && each.step < steps.last && proven <= upper) lower = std::max(lower, proven);
        least = std::min(least, lower);
        low.push_back(rounded_down(lower));
        high.push_back(rounded_up(upper));
    }
    return {{"pair", k}, {"least", least}, {"lower", packed(low)}, {"upper", packed(high)}};
}

}  // namespace

Json pair_row(const PairClearance& pair, const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    const core::clearance::Witness& w = pair.witness;
    const bool pushes = pair.status == core::clearance::PairStatus::contact;
    Json depth, volume;
    if (pair.overlap) {
        const core::clearance::Overlap& o = *pair.overlap;
        constexpr double cubic = millimetre * millimetre * millimetre;
        depth = {{"lower", o.depth_lower / millimetre},
                 {"upper", o.depth_upper / millimetre},
                 {"time", o.time},
                 {"point", o.depth_lower > 0 ? millimetres(o.center) : Json()}};
        volume = {{"lower", o.volume_lower / cubic}, {"upper", o.volume_upper / cubic}};
    }
    return {{"a", model.bodies[pair.a].name},
            {"b", model.bodies[pair.b].name},
            {"body_a", pair.a},
            {"body_b", pair.b},
            {"motion", true},
            {"steps", {0, trajectory.steps.size()}},
            {"minimum", Json()},
            {"lower", pair.lower / millimetre},
            {"upper", std::isfinite(pair.upper) ? Json(pair.upper / millimetre) : Json()},
            {"status", core::clearance::to_string(pair.status)},
            {"finding", pair.is_clash()                                               ? Json("clash")
                        : pushes                                                      ? Json("contact")
                        : pair.lower > 0 && core::certificate::are_apart(pair.solids) ? Json("apart")
                                                                                      : Json("undecided")},
            {"time", core::stepper::time_at(trajectory, w.step, w.segment, w.s)},
            {"point_a", millimetres(w.point_a)},
            {"point_b", millimetres(w.point_b)},
            {"depth", depth},
            {"volume", volume},
            {"touching", Json()},
            {"note", Json()}};
}

Json told_pairs(const Json& pairs, const core::model::Model& model, const std::vector<StepRange>& steps) {
    Json rows = Json::array();
    for (std::size_t k = 0; k < pairs.size() && k < most_pairs; ++k) {
        const Json& pair = pairs[k];
        const auto a = pair.at("a").get<std::string>(), b = pair.at("b").get<std::string>();
        const Json witness = member(pair, "witness"), measured = member(pair, "measured");
        const StepRange range = k < steps.size() ? steps[k] : StepRange{};
        const bool clashes = member(pair, "clash") == true;  // of an optimisation, whose pairs have no other finding
        const Json time = witness.is_object() ? member(witness, "time") : member(pair, "time");
        Json note = member(pair, "reason");
        if (note.is_null()) note = member(pair, "overlap");
        if (note.is_null()) note = worst_place(member(pair, "coordinates"));
        if (measured.is_boolean() && !measured.get<bool>()) note = "at least twice as far apart as required: not measured";
        rows.push_back({{"a", a},
                        {"b", b},
                        {"body_a", index_of(model, pair.value("body_a", a))},
                        {"body_b", index_of(model, pair.value("body_b", b))},
                        {"motion", range.last > range.first},
                        {"steps", {range.first, range.last}},
                        {"minimum", millimetres(member(pair, "minimum"))},
                        {"lower", millimetres(member(pair, "lower"))},
                        {"upper", millimetres(member(pair, "upper"))},
                        {"status", member(pair, "status")},
                        {"finding", clashes ? Json("clash") : member(pair, "finding")},
                        {"time", time},
                        {"point_a", millimetres(member(pair, "point_a"))},
                        {"point_b", millimetres(member(pair, "point_b"))},
                        {"depth", measured_bounds(member(pair, "depth"), 1)},
                        {"volume", measured_bounds(member(pair, "volume"), 3)},
                        {"touching", touching_of(member(pair, "touching"))},
                        {"poses", worst_poses(member(pair, "poses"), model)},
                        {"note", note}});
    }
    return rows;
}

void leave_out_distances(Json& rows) {
    for (Json& row : rows)
        if (row["finding"] == "clash" || row["finding"] == "touching") row["lower"] = row["upper"] = Json();
}

Json nearest_pairs(const core::model::Model& model, const core::stepper::Trajectory& trajectory, double least,
                   const std::function<bool()>& should_stop) {
    const std::vector<PairRequest> requests = pairs_that_may_collide(model);
    Json rows = Json::array();
    if (requests.empty() || trajectory.steps.empty() || !(least > 0)) return rows;
    const core::clearance::ClearanceOptions options = options_over_motion(share * least, should_stop);
    const bool few = requests.size() <= static_cast<std::size_t>(most_searched);
    std::vector<PairClearance> pairs =
        few ? searched_each(model, trajectory, requests, options)
            : nearest_of_pairs(core::clearance::certify_near(model, trajectory, wide_reach * least, options).windows);
    std::stable_sort(pairs.begin(), pairs.end(), [](const PairClearance& x, const PairClearance& y) { return x.upper < y.upper; });
    for (std::size_t k = 0; k < pairs.size() && k < most_nearest; ++k) rows.push_back(pair_row(pairs[k], model, trajectory));
    return rows;
}

Json margin_curves(const Json& rows, const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                   const std::function<bool()>& should_stop) {
    if (trajectory.steps.empty()) return {};
    std::vector<double> times;
    for (int t = 0; t < count_of(trajectory.steps); ++t)
        for (int k = 0; k < core::stepper::segment_count(trajectory, t); ++k) times.push_back(core::stepper::time_at(trajectory, t, k, 0));
    const std::size_t stretches = times.size();
    times.push_back(core::stepper::time_at(trajectory, count_of(trajectory.steps)));
    Json curves = Json::array();
    std::vector<std::pair<int, int>> done;
    for (std::size_t k = 0; k < rows.size() && curves.size() < most_margins; ++k) {
        const Json& row = rows[k];
        const int a = row["body_a"].get<int>(), b = row["body_b"].get<int>();
        if (!row["motion"].get<bool>() || row["upper"].is_null() || a < 0 || b < 0) continue;
        if (std::find(done.begin(), done.end(), std::pair(a, b)) != done.end()) continue;
        done.emplace_back(a, b);
        const double lower = bound_or(row["lower"], 0) * millimetre, upper = bound_or(row["upper"], 0) * millimetre;
        core::clearance::ClearanceOptions options = options_over_motion(std::max({share * lower, upper - lower, 1e-8}), should_stop);
        options.margin_curve = true;
        std::vector<core::clearance::MarginInterval> margin;
        for_stretches(trajectory, [&](const core::stepper::Trajectory& stretch, int first) {
            const std::vector<PairClearance> found = core::clearance::certify(model, stretch, {{a, b, 0}}, options);
            for (core::clearance::MarginInterval each : found.front().margin) {
                each.step += first;
                margin.push_back(each);
            }
        });
        if (margin.size() == stretches) curves.push_back(margin_curve(rows, k, margin));
    }
    if (curves.empty()) return {};
    return {{"time", packed(times)}, {"pairs", curves}};
}

}  // namespace fettle::design::report
