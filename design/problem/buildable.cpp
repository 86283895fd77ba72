// SPDX-License-Identifier: MIT
#include "design/problem/buildable.hpp"

#include <algorithm>
#include <cstdio>

#include "core/base/kronecker.hpp"
#include "core/base/parallel.hpp"

namespace fettle::design::problem {

namespace {

using description::Design;
using description::Parameter;

VectorX with_value(VectorX p, int parameter, double value) {
    p[parameter] = value;
    return p;
}

// Inequalities between parameters that do not hold at p. (Equations are left out: along them no single parameter can move.)
std::vector<bool> broken_inequalities(const DesignProblem& problem, const VectorX& p) {
    std::vector<bool> broken;
    for (const description::Relation& relation : problem.design().relations) {
        const bool inequality = relation.bounds.lower < relation.bounds.upper;
        broken.push_back(inequality && description::violation(relation, relation.at(p).value) > 0);
    }
    return broken;
}

bool any(const std::vector<bool>& flags) { return std::find(flags.begin(), flags.end(), true) != flags.end(); }

std::string amount(double si, const Unit& unit) {
    char text[80];
    std::snprintf(text, sizeof text, "%.6g %s", description::from_si(si, unit), std::string(unit.name).c_str());
    return text;
}

}  // namespace

bool has_costly_shapes(const Design& design) {
    return std::any_of(design.shapes.begin(), design.shapes.end(), [](const auto& shape) { return shape && shape->is_costly(); });
}

Reach reach(const DesignProblem& problem, const VectorX& p, int parameter, double end) {
    const double start = p[parameter];
    const std::vector<bool> broken = broken_inequalities(problem, p);
    const auto at = [&](double fraction) { return fraction == 1 ? end : start + fraction * (end - start); };
    const auto tried = [&](double fraction) {
        const VectorX there = with_value(p, parameter, at(fraction));
        std::vector<bool> then = broken_inequalities(problem, there);
        for (size_t i = 0; i < broken.size(); ++i) then[i] = then[i] && !broken[i];
        return any(then) ? Errors() : problem.obstacles(there);
    };
    double good = 0, bad = 0;
    Errors obstacles;
    for (const double fraction : has_costly_shapes(problem.design()) ? std::vector{1.0} : std::vector{0.25, 0.5, 0.75, 1.0}) {
        obstacles = tried(fraction);
        bad = fraction;
        if (!obstacles.empty()) break;
        good = fraction;
    }
    if (obstacles.empty()) return {end, {}};
    while (bad - good > 1e-3) {
        const double middle = (good + bad) / 2;
        Errors found = tried(middle);
        (found.empty() ? good : bad) = middle;
        if (!found.empty()) obstacles = std::move(found);
    }
    return {at(good), std::move(obstacles)};
}

std::vector<Obstacle> tally(const std::vector<Errors>& designs) {
    std::vector<Obstacle> all;
    for (const Errors& errors : designs) {
        if (errors.empty()) continue;
        const Error& first = errors.front();
        const auto found = std::find_if(all.begin(), all.end(), [&](const Obstacle& o) { return o.where == first.where; });
        if (found == all.end()) {
            all.push_back({first.where, 1, first});
        } else {
            ++found->designs;
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const Obstacle& a, const Obstacle& b) { return a.designs > b.designs; });
    return all;
}

BoundsReport try_bounds(const DesignProblem& problem) {
    const std::vector<Parameter>& parameters = problem.design().parameters;
    const VectorX start = description::values_of(parameters);
    const int n = problem.parameter_count();
    BoundsReport report;
    if (!problem.obstacles(start).empty()) return report;
    std::vector<UnreachableBound> ends(2 * static_cast<size_t>(n));
    core::base::parallel_for(2 * n, 1, [&](int i) {
        const Parameter& parameter = parameters[i / 2];
        const double bound = i % 2 == 0 ? parameter.lower : parameter.upper;
        ends[i] = {i / 2, bound, reach(problem, start, i / 2, bound)};
    });
    for (UnreachableBound& end : ends) {
        if (!end.reach.obstacles.empty()) report.unreachable.push_back(std::move(end));
    }
    std::vector<VectorX> points;
    const core::base::Kronecker spread(n);
    const int samples = has_costly_shapes(problem.design()) ? 2 * n : 8 * n;
    for (int index = 1; index <= std::min(64, samples); ++index) {
        VectorX p(n);
        for (int k = 0; k < n; ++k) p[k] = parameters[k].lower + spread.at(index, k) * (parameters[k].upper - parameters[k].lower);
        if (!any(broken_inequalities(problem, p))) points.push_back(std::move(p));
    }
    std::vector<Errors> found(points.size());
    core::base::parallel_for(count_of(points), 1, [&](int i) { found[i] = problem.obstacles(points[i]); });
    report.samples = count_of(points);
    report.obstacles = tally(found);
    for (const Obstacle& obstacle : report.obstacles) report.refused += obstacle.designs;
    return report;
}

std::string described(const Error& error) {
    const bool named = error.where.empty() || error.code == ErrorCode::bodies_intersect;  // its message names both bodies
    return (named ? "" : error.where + ": ") + error.message;
}

std::vector<std::string> described(const Design& design, const BoundsReport& report) {
    std::vector<std::string> lines;
    for (const UnreachableBound& end : report.unreachable) {
        const Parameter& parameter = design.parameters[end.parameter];
        const bool lower = end.bound == parameter.lower;
        lines.push_back("`" + parameter.name + "` " + (lower ? "below " : "above ") + amount(end.reach.value, parameter.unit) +
                        ", the others as at the start, makes no design, yet its bound is " + amount(end.bound, parameter.unit) + ": " +
                        described(end.reach.obstacles.front()));
    }
    if (report.refused == 0) return lines;
    lines.push_back(std::to_string(report.refused) + " of " + std::to_string(report.samples) +
                    " designs spread over the bounds cannot be made");
    constexpr size_t most = 3;
    for (size_t k = 0; k < std::min(most, report.obstacles.size()); ++k) {
        lines.back() += (k == 0 ? ": " : "; ") + std::to_string(report.obstacles[k].designs) +
                        " for a reason like this: " + described(report.obstacles[k].example);
    }
    return lines;
}

}  // namespace fettle::design::problem
