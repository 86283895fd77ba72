// SPDX-License-Identifier: MIT
#include "design/gradient_audit/roughness.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "design/gradient_audit/design_line.hpp"

namespace fettle::design::gradient_audit {

namespace {

using core::base::infinity;

constexpr int fewest_values = 5;  // estimate_noise's

// Table of equally spaced points around t = 0, as far as they could be simulated without a gap.
struct NoiseTable {
    double spacing = 0;
    MatrixX values;  ///< empty: too few points
};

class RoughnessStudy {
public:
    RoughnessStudy(const problem::DesignProblem& problem, const VectorX& p, const problem::DesignEvaluation& at,
                   const RoughnessOptions& options)
        : options_(options), line_(problem, p, direction_of(problem, p, at, options)) {
        report_.direction = direction_of(problem, p, at, options);
        const VectorX step = report_.direction.cwiseProduct(parameter_ranges(problem.design()));
        const VectorX slopes = quantity_gradients(at) * step;
        const VectorX values = quantities_of(at);
        const VectorX tolerances = options.tolerances.size() > 0 ? options.tolerances : quantity_tolerances(problem.design(), at);
        FETTLE_ASSERT(tolerances.size() == values.size(), "a tolerance per quantity");
        points_.push_back({0, true, values, {}, false});
        const std::vector<std::string> names = quantity_names(problem.design());
        for (Eigen::Index q = 0; q < values.size(); ++q) {
            QuantityRoughness quantity;
            quantity.name = names[q];
            quantity.slope = slopes[q];
            quantity.tolerance = tolerances[q];
            report_.quantities.push_back(std::move(quantity));
        }
        expected_ = options.intervals * (options.fine_spacing > 0 ? 2 : 1) + options.distances;
    }

    RoughnessReport run() {
        const NoiseTable table = noise_table(options_.spacing, 0.5);
        report_.spacing = table.spacing;
        NoiseTable fine;
        if (options_.fine_spacing > 0 && table.spacing > options_.fine_spacing) fine = noise_table(options_.fine_spacing, 0);
        report_.fine_spacing = fine.spacing;
        report_.measured = table.spacing > 0 && !report_.interrupted;
        if (!report_.measured) {
            report_.quantities.clear();
            return std::move(report_);
        }
        judge_noise(table, fine);
        for (int spent = 0; spent + 2 <= options_.distances && !report_.interrupted; spent += 2) {
            find_lengths();
            const std::vector<double> next = next_distances();
            if (next.empty()) break;
            simulate(next);
        }
        find_lengths();
        return std::move(report_);
    }

private:
    static VectorX direction_of(const problem::DesignProblem& problem, const VectorX& p, const problem::DesignEvaluation& at,
                                const RoughnessOptions& options) {
        if (options.direction.size() == 0) return downhill_direction(problem.design(), p, at.gradient);
        return options.direction / options.direction.lpNorm<Eigen::Infinity>();
    }

    // Appends to points_.
    void simulate(const std::vector<double>& ts) {
        const auto count = [&] {
            ++report_.simulations;
            expected_ = std::max(expected_, report_.simulations);
            if (options_.on_simulation) options_.on_simulation(report_.simulations, expected_);
        };
        for (LinePoint& point : line_.evaluate(ts, options_.should_stop, count)) {
            report_.interrupted = report_.interrupted || point.interrupted;
            if (!point.usable) report_.failures.push_back(point.reason);
            points_.push_back(std::move(point));
        }
    }

    // Points k * spacing, one of which is t = 0, of `share` of the intervals below it and the rest above, as far as the bounds allow. Where
    // too many of them fail, a tenth of the spacing, twice at most.
    NoiseTable noise_table(double spacing, double share) {
        for (int tries = 0; tries < 3 && !report_.interrupted; ++tries, spacing /= 10) {
            spacing = std::min(spacing, (line_.most() - line_.least()) / (options_.intervals + 1));
            if (!(spacing > 0)) return {};
            const int below = static_cast<int>(std::min(std::floor(-line_.least() / spacing), share * options_.intervals));
            const int above =
                static_cast<int>(std::min(std::floor(line_.most() / spacing), static_cast<double>(options_.intervals - below)));
            const int first = above - options_.intervals;  // more below where there is no room above
            std::vector<double> ts;
            for (int k = first; k <= above; ++k) {
                if (k != 0) ts.push_back(k * spacing);
            }
            const size_t before = points_.size();
            simulate(ts);
            std::vector<const LinePoint*> row;
            for (size_t i = before; i < points_.size(); ++i) row.push_back(&points_[i]);
            row.insert(row.begin() - first, &points_.front());
            const MatrixX values = longest_run(row, points_.front().values.size());
            if (values.rows() >= fewest_values) return {spacing, values};
        }
        return {};
    }

    static MatrixX longest_run(const std::vector<const LinePoint*>& row, Eigen::Index quantities) {
        size_t begin = 0, end = 0;
        for (size_t i = 0; i < row.size();) {
            size_t j = i;
            while (j < row.size() && row[j]->usable) ++j;
            if (j - i > end - begin) begin = i, end = j;
            i = j + 1;
        }
        MatrixX values(end - begin, quantities);
        for (size_t i = begin; i < end; ++i) values.row(i - begin) = row[i]->values.transpose();
        return values;
    }

    void judge_noise(const NoiseTable& table, const NoiseTable& fine) {
        const std::vector<optimisers::NoiseLevel> noise = optimisers::estimate_noise_by_column(table.values, table.spacing);
        for (size_t q = 0; q < report_.quantities.size(); ++q) {
            QuantityRoughness& quantity = report_.quantities[q];
            for (const LinePoint& point : points_) {
                if (point.usable) quantity.size = std::max(quantity.size, std::abs(point.values[q]));
            }
            quantity.noise = noise[q];
            quantity.rounding = std::numeric_limits<double>::epsilon() * quantity.size;
            if (fine.spacing > 0) {
                quantity.fine = optimisers::estimate_noise(VectorX(fine.values.col(q)), fine.spacing);
                quantity.rounding = std::max(quantity.rounding, quantity.fine.noise);
            }
            quantity.rough =
                quantity.noise.status != optimisers::NoiseStatus::spacing_too_large && quantity.noise.noise > quantity.tolerance;
        }
    }

    bool agrees(const QuantityRoughness& quantity, Eigen::Index q, const LinePoint& point) const {
        const double predicted = point.t * quantity.slope;
        const double deviation = std::abs(point.values[q] - points_.front().values[q] - predicted);
        return deviation <= std::max({options_.share * std::abs(predicted), quantity.tolerance, 4 * quantity.rounding});
    }

    void find_lengths() {
        std::vector<const LinePoint*> sorted;
        for (const LinePoint& point : points_) {
            if (point.usable && point.t != 0) sorted.push_back(&point);
        }
        std::stable_sort(sorted.begin(), sorted.end(),
                         [](const LinePoint* a, const LinePoint* b) { return std::abs(a->t) < std::abs(b->t); });
        for (size_t q = 0; q < report_.quantities.size(); ++q) {
            QuantityRoughness& quantity = report_.quantities[q];
            quantity.holds = 0;
            quantity.breaks = infinity;
            for (const LinePoint* point : sorted) {
                if (agrees(quantity, q, *point)) continue;
                quantity.breaks = std::abs(point->t);
                break;
            }
            // Not the point before it: on the other side of t = 0 the same distance may still agree.
            for (const LinePoint* point : sorted) {
                if (std::abs(point->t) < quantity.breaks) quantity.holds = std::abs(point->t);
            }
        }
    }

    // Nearer where a gradient does not hold for the nearest point, farther where one holds for all; else into the widest gap left.
    std::vector<double> next_distances() const {
        double nearest = infinity, farthest = 0;
        for (const LinePoint& point : points_) {
            if (point.t == 0) continue;
            nearest = std::min(nearest, std::abs(point.t));
            farthest = std::max(farthest, std::abs(point.t));
        }
        const double reach = std::max(line_.most(), -line_.least());
        bool nearer = false, farther = false;
        double from = 1, to = 1;
        for (const QuantityRoughness& quantity : report_.quantities) {
            nearer = nearer || quantity.holds == 0;
            farther = farther || (std::isinf(quantity.breaks) && 2 * farthest <= reach);
            if (quantity.holds > 0 && std::isfinite(quantity.breaks) && quantity.breaks / quantity.holds > to / from) {
                from = quantity.holds;
                to = quantity.breaks;
            }
        }
        const auto beyond = [&](double factor) { return std::min(factor * farthest, reach); };
        if (nearer && farther) return {on_line(nearest / 8), on_line(beyond(8))};
        if (nearer) return {on_line(nearest / 8), on_line(nearest / 64)};
        if (farther) return {on_line(beyond(4)), on_line(beyond(32))};
        if (to < 3 * from) return {};
        const double third = std::cbrt(to / from);
        return {on_line(from * third), on_line(from * third * third)};
    }

    // Ahead if there is room, else behind.
    double on_line(double distance) const { return distance <= line_.most() ? distance : -std::min(distance, -line_.least()); }

    const RoughnessOptions& options_;
    DesignLine line_;
    std::vector<LinePoint> points_;  ///< the first is t = 0
    RoughnessReport report_;
    int expected_ = 0;
};

std::string with_unit(double metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g mm", metres * 1e3);
    return text;
}

}  // namespace

RoughnessReport measure_roughness(const problem::DesignProblem& problem, const VectorX& p, const problem::DesignEvaluation& at,
                                  const RoughnessOptions& options) {
    FETTLE_ASSERT(at.usable && at.gradient.size() == p.size(), "a design with its gradients");
    FETTLE_ASSERT(options.intervals + 1 >= fewest_values && options.spacing > 0, "enough points for a noise level");
    const bool told = options.direction.size() > 0;
    if (told ? options.direction.isZero(0) : downhill_direction(problem.design(), p, at.gradient).isZero(0)) {
        RoughnessReport report;
        report.failures.push_back("no parameter has room within its bounds");
        return report;
    }
    return RoughnessStudy(problem, p, at, options).run();
}

VectorX downhill_direction(const description::Design& design, const VectorX& p, const VectorX& gradient) {
    const auto room = [&](Eigen::Index k, double sign) {
        const description::Parameter& parameter = design.parameters[k];
        return sign > 0 ? parameter.upper - p[k] : p[k] - parameter.lower;
    };
    VectorX direction = -gradient.cwiseProduct(parameter_ranges(design));
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        if (!std::isfinite(direction[k]) || !(room(k, direction[k]) > 0)) direction[k] = 0;
    }
    if (direction.isZero(0)) {
        for (Eigen::Index k = 0; k < p.size(); ++k) {
            const double up = room(k, 1), down = room(k, -1);
            if (std::max(up, down) > 0) direction[k] = up >= down ? 1 : -1;
        }
    }
    const double largest = p.size() > 0 ? direction.lpNorm<Eigen::Infinity>() : 0;
    return largest > 0 ? VectorX(direction / largest) : direction;
}

VectorX quantity_tolerances(const description::Design& design, const problem::DesignEvaluation& at) {
    const double tolerance = design.optimiser.tolerance;
    VectorX tolerances(static_cast<Eigen::Index>(design.constraints.size()) + 1);
    tolerances[0] = tolerance * std::max(std::abs(at.objective), 1.0);
    for (size_t i = 0; i < design.constraints.size(); ++i) {
        const description::Bounds& bounds = design.constraints[i].bounds;
        tolerances[static_cast<Eigen::Index>(i) + 1] = std::max(bounds.margin, tolerance * bounds.unit);
    }
    return tolerances;
}

namespace {

// kappa is chosen to go with the time step (core/model/choose_kappa.hpp), and with kappa what damps critically.
std::string contact_damping_remedy(const core::scene::Scene& scene) {
    char told[160];
    if (scene.contact_damping_time > 0)
        std::snprintf(
            told, sizeof told,
            "another contact.damping_time (it is %.3g s): longer takes more of the impacts' energy, too long makes contacts stick",
            scene.contact_damping_time);
    else
        std::snprintf(told, sizeof told,
                      "damping in contact: contact.damping_time, from the timestep (%.3g s) upwards; too long makes contacts stick",
                      scene.timestep);
    return told;
}

}  // namespace

std::vector<std::string> motion_remedies(const core::scene::Scene& scene) {
    std::vector<std::string> remedies;
    if (scene.dhat)
        remedies.push_back("a wider contact.dhat (it is " + with_unit(*scene.dhat) +
                           "), up to the play of the fits: contact then sets in gently, and parts rattle less");
    remedies.push_back("\"integrator\": \"quasi_static\", where inertia does not matter: parts then do not rattle at all");
    if (scene.integrator != core::scene::Integrator::quasi_static) remedies.push_back(contact_damping_remedy(scene));
    remedies.push_back("damping of the bodies that rattle");
    if (scene.integrator != core::scene::Integrator::implicit_euler)
        remedies.push_back("\"integrator\": \"implicit_euler\", which keeps least of the impacts' energy");
    char step[96];
    std::snprintf(step, sizeof step, "a smaller timestep (it is %.3g s), so that impacts fall less between steps", scene.timestep);
    remedies.push_back(step);
    return remedies;
}

std::vector<std::string> roughness_remedies(const description::Design& design, const RoughnessReport& report) {
    bool moving = false, fine = false;
    for (const QuantityRoughness& quantity : report.quantities) {
        if (!quantity.rough) continue;
        // Still there when the design hardly moves: not the motion's, but that of how accurately it is computed.
        (quantity.fine.noise > quantity.tolerance ? fine : moving) = true;
    }
    std::vector<std::string> remedies = moving ? motion_remedies(design.scene) : std::vector<std::string>();
    if (fine)
        remedies.push_back("a smaller clearance tolerance (it is " + with_unit(design.clearance_tolerance) +
                           "), or a larger tolerance of the optimiser: the quantity is not computed that accurately");
    return remedies;
}

}  // namespace fettle::design::gradient_audit
