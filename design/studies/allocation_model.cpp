// SPDX-License-Identifier: MIT
#include "design/studies/allocation_model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/limits.hpp"
#include "design/optimisers/nonlinear_program.hpp"
#include "design/tolerances/moments.hpp"
#include "design/tolerances/normal_distribution.hpp"

namespace fettle::design::studies {

namespace {

using tolerances::Distribution;
using tolerances::normal_density;
using tolerances::normal_probability;
using tolerances::RequirementLimits;

bool holds_nominal(const Distribution& deviation) { return deviation.lower <= 0 && deviation.upper >= 0; }

double share_outside(double mean, double sigma, const RequirementLimits& limits) {
    return normal_probability((limits.lower - mean) / sigma) + normal_probability((mean - limits.upper) / sigma);
}

// d allowed / d mean.
double allowed_slope(double mean, double sigma, const RequirementLimits& limits) {
    const double above = (limits.upper - mean) / sigma, below = (mean - limits.lower) / sigma;
    const double up = std::isfinite(above) ? normal_density(above) : 0, down = std::isfinite(below) ? normal_density(below) : 0;
    return (down - up) / ((up > 0 ? above * up : 0) + (down > 0 ? below * down : 0));
}

// Means of the deviations and their slopes, standard deviations as they stand.
struct Spread {
    VectorX mean, mean_slope, sigma;
};

Spread spread_at(const AllocationModel& model, const VectorX& factors) {
    const auto n = factors.size();
    Spread out{VectorX(n), VectorX::Zero(n), VectorX(n)};
    for (Eigen::Index j = 0; j < n; ++j) {
        const Distribution& deviation = model.deviations[static_cast<std::size_t>(j)];
        const tolerances::Moments moments = moments_of(deviation);
        const double middle = (deviation.lower + deviation.upper) / 2;
        out.sigma[j] = moments.standard_deviation;
        out.mean[j] = moments.mean;
        if (!holds_nominal(deviation)) continue;
        out.mean[j] += (factors[j] - 1) * middle;
        out.mean_slope[j] = middle;
    }
    return out;
}

/// Worst case of a linear requirement: its ends, and their slopes in the factors.
struct Ends {
    double least = 0, most = 0;
    VectorX least_slope, most_slope;
};

Ends ends_at(const AllocationModel& model, const RequirementModel& requirement, const VectorX& factors) {
    const auto n = factors.size();
    Ends out{requirement.nominal + requirement.least_correction, requirement.nominal + requirement.most_correction, VectorX::Zero(n),
             VectorX::Zero(n)};
    for (Eigen::Index j = 0; j < n; ++j) {
        const Distribution& deviation = model.deviations[static_cast<std::size_t>(j)];
        const double g = requirement.gradient[j], half = (deviation.upper - deviation.lower) / 2;
        const Distribution now = scaled(deviation, factors[j]);
        out.least += std::min(g * now.lower, g * now.upper);
        out.most += std::max(g * now.lower, g * now.upper);
        const bool holds = holds_nominal(deviation);
        out.least_slope[j] = holds ? std::min(g * deviation.lower, g * deviation.upper) : -std::abs(g) * half;
        out.most_slope[j] = holds ? std::max(g * deviation.lower, g * deviation.upper) : std::abs(g) * half;
    }
    return out;
}

double least_of(const AllocationModel& model, int tolerance) { return model.least.size() > 0 ? model.least[tolerance] : least_factor; }

/// One row of the programme: a miss that is at most 0.
struct Row {
    double miss = -core::base::infinity;
    VectorX slope;
};

std::vector<Row> rows_at(const AllocationModel& model, const VectorX& factors) {
    std::vector<Row> rows;
    for (const RequirementModel& requirement : model.requirements) {
        if (model.worst_case) {
            const Ends ends = ends_at(model, requirement, factors);
            const double up = requirement.limits.upper - requirement.nominal, down = requirement.nominal - requirement.limits.lower;
            const bool is_within = up > 0 && down > 0;
            if (std::isfinite(up))
                rows.push_back({is_within ? (ends.most - requirement.limits.upper) / up : core::base::infinity, ends.most_slope / up});
            if (std::isfinite(down))
                rows.push_back(
                    {is_within ? (requirement.limits.lower - ends.least) / down : core::base::infinity, -ends.least_slope / down});
            continue;
        }
        const ModelMoments moments = moments_at(model, requirement, factors);
        const double allowed = allowed_sigma(moments.mean, requirement.limits, requirement.outside);
        if (!(allowed > 0)) {
            rows.push_back({core::base::infinity, VectorX::Zero(factors.size())});
        } else if (moments.sigma > 0) {
            const double slope = allowed_slope(moments.mean, allowed, requirement.limits);
            rows.push_back({std::log(moments.sigma / allowed), moments.sigma_slope / moments.sigma - slope / allowed * moments.mean_slope});
        } else {
            rows.push_back({-core::base::infinity, VectorX::Zero(factors.size())});
        }
    }
    return rows;
}

/// In u = log f of the tolerances that are free. Rows that nothing free can miss are left out.
class AllocationProgram : public optimisers::NonlinearProgram {
public:
    AllocationProgram(const AllocationModel& model, VectorX factors) : model_(model), factors_(std::move(factors)) {
        for (std::size_t j = 0; j < model.is_fixed.size(); ++j)
            if (!model.is_fixed[j]) free_.push_back(static_cast<int>(j));
        const std::vector<Row> rows = rows_at(model, factors_);
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (std::isfinite(rows[i].miss) && !rows[i].slope.isZero(0)) rows_.push_back(static_cast<int>(i));
    }

    VectorX start() const {
        VectorX u(n());
        for (int k = 0; k < n(); ++k) u[k] = std::log(factors_[free_[static_cast<std::size_t>(k)]]);
        return u;
    }
    VectorX factors(const VectorX& u) const {
        VectorX f = factors_;
        for (int k = 0; k < n(); ++k) f[free_[static_cast<std::size_t>(k)]] = std::exp(u[k]);
        return f;
    }

    Bounds bounds() const override {
        VectorX lower(n());
        for (int k = 0; k < n(); ++k) lower[k] = std::log(least_of(model_, free_[static_cast<std::size_t>(k)]));
        return {lower, VectorX::Constant(n(), std::log(largest_factor)), VectorX::Constant(m(), -core::base::infinity), VectorX::Zero(m())};
    }
    int jacobian_entries() const override { return n() * m(); }
    int hessian_entries() const override { return 0; }

    bool value(const double* x, double& f) override {
        f = cost_of(model_, at(x));
        return std::isfinite(f);
    }
    bool gradient(const double* x, double* out) override {
        const VectorX f = at(x);
        for (int k = 0; k < n(); ++k) {
            const auto j = static_cast<std::size_t>(free_[static_cast<std::size_t>(k)]);
            out[k] = model_.costs[j](f[free_[static_cast<std::size_t>(k)]]).slope * f[free_[static_cast<std::size_t>(k)]];
        }
        return std::all_of(out, out + n(), [](double each) { return std::isfinite(each); });
    }
    bool row_values(const double* x, double* out) override {
        const std::vector<Row> rows = rows_at(model_, at(x));
        for (int i = 0; i < m(); ++i) {
            out[i] = rows[static_cast<std::size_t>(rows_[static_cast<std::size_t>(i)])].miss;
            if (!std::isfinite(out[i])) return false;
        }
        return true;
    }
    bool jacobian(const double* x, int* row, int* column, double* values) override {
        if (values == nullptr) {
            for (int k = 0; k < jacobian_entries(); ++k) {
                row[k] = k / n();
                column[k] = k % n();
            }
            return true;
        }
        const VectorX f = at(x);
        const std::vector<Row> rows = rows_at(model_, f);
        for (int k = 0; k < jacobian_entries(); ++k) {
            const Row& own = rows[static_cast<std::size_t>(rows_[static_cast<std::size_t>(k / n())])];
            const int j = free_[static_cast<std::size_t>(k % n())];
            values[k] = own.slope[j] * f[j];
            if (!std::isfinite(values[k])) return false;
        }
        return true;
    }
    bool hessian(double, int*, int*, double*) override { return false; }

    int n() const { return count_of(free_); }

private:
    int m() const { return count_of(rows_); }
    VectorX at(const double* x) const { return factors(Eigen::Map<const VectorX>(x, n())); }

    const AllocationModel& model_;
    VectorX factors_;
    std::vector<int> free_, rows_;
};

VectorX all_free_at(const AllocationModel& model, double factor) {
    VectorX f = VectorX::Ones(count_of(model.deviations));
    for (Eigen::Index j = 0; j < f.size(); ++j)
        if (!model.is_fixed[static_cast<std::size_t>(j)]) f[j] = std::max(factor, least_of(model, static_cast<int>(j)));
    return f;
}

// One common factor with which all is held, nearly as large as it may be; nothing: there is none.
std::optional<VectorX> held_by_all(const AllocationModel& model) {
    const auto is_held = [&](double u) { return (misses(model, all_free_at(model, std::exp(u))).array() <= 0).all(); };
    double low = std::log(least_factor), high = std::log(largest_factor);
    if (!is_held(low)) return std::nullopt;
    if (is_held(high)) return all_free_at(model, largest_factor);
    for (int k = 0; k < 50; ++k) {
        const double middle = (low + high) / 2;
        (is_held(middle) ? low : high) = middle;
    }
    return all_free_at(model, std::exp(low - 0.01));
}

}  // namespace

Distribution scaled(Distribution deviation, double factor) {
    const double middle = holds_nominal(deviation) ? 0 : (deviation.lower + deviation.upper) / 2;
    deviation.lower = middle + factor * (deviation.lower - middle);
    deviation.upper = middle + factor * (deviation.upper - middle);
    return deviation;
}

ModelMoments moments_at(const AllocationModel& model, const RequirementModel& requirement, const VectorX& factors) {
    const Spread spread = spread_at(model, factors);
    const VectorX sigma = spread.sigma.cwiseProduct(factors);
    const MatrixX c = sigma.asDiagonal() * model.correlation * sigma.asDiagonal();
    const VectorX &g = requirement.gradient, &m = spread.mean;
    ModelMoments out;
    out.mean = requirement.nominal + requirement.mean_correction + g.dot(m);
    VectorX a = g, variance_slope;
    const bool is_linear = requirement.curvature.size() == 0;
    if (!is_linear) a += requirement.curvature * m;
    const VectorX ca = c * a;
    double variance = a.dot(ca);
    out.mean_slope = a.cwiseProduct(spread.mean_slope);
    variance_slope = 2 * a.cwiseProduct(ca).cwiseQuotient(factors);
    if (!is_linear) {
        const MatrixX hc = requirement.curvature * c, hchc = hc * hc;
        out.mean += 0.5 * m.dot(requirement.curvature * m) + 0.5 * hc.trace();
        variance += 0.5 * hchc.trace();
        out.mean_slope += hc.diagonal().cwiseQuotient(factors);
        variance_slope += 2 * (requirement.curvature * ca).cwiseProduct(spread.mean_slope) + 2 * hchc.diagonal().cwiseQuotient(factors);
    }
    out.sigma = std::sqrt(std::max(variance, 0.0));
    out.sigma_slope = out.sigma > 0 ? VectorX(variance_slope / (2 * out.sigma)) : VectorX::Zero(factors.size());
    out.sigma *= requirement.sigma_correction;
    out.sigma_slope *= requirement.sigma_correction;
    return out;
}

double allowed_sigma(double mean, const RequirementLimits& limits, double outside) {
    const double room = std::min(limits.upper - mean, mean - limits.lower);
    if (!(room > 0)) return 0;
    // One limit alone allows the most, two as near as the nearer one the least.
    double high = room / -tolerances::normal_quantile(outside), low = room / -tolerances::normal_quantile(outside / 2);
    if (share_outside(mean, high, limits) <= outside) return high;
    for (int k = 0; k < 200 && high - low > 1e-15 * high; ++k) {
        const double middle = (low + high) / 2;
        (share_outside(mean, middle, limits) <= outside ? low : high) = middle;
    }
    return low;
}

VectorX misses(const AllocationModel& model, const VectorX& factors) {
    const std::vector<Row> rows = rows_at(model, factors);
    VectorX out(rows.size());
    for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = rows[static_cast<std::size_t>(i)].miss;
    return out;
}

double cost_of(const AllocationModel& model, const VectorX& factors) {
    double sum = 0;
    for (Eigen::Index j = 0; j < factors.size(); ++j) sum += model.costs[static_cast<std::size_t>(j)](factors[j]).value;
    return sum;
}

AllocationSolution solve(const AllocationModel& model) {
    const std::optional<VectorX> start = held_by_all(model);
    const VectorX tightest = all_free_at(model, least_factor);
    if (!start) return {false, tightest, cost_of(model, tightest), "no allocation holds them"};
    AllocationProgram program(model, *start);
    if (program.n() == 0) return {true, *start, cost_of(model, *start), "every tolerance is fixed"};
    optimisers::IpoptOptions options;
    options.words = {{"hessian_approximation", "limited-memory"}};
    options.numbers = {{"tol", 1e-10}, {"constr_viol_tol", 1e-10}, {"bound_relax_factor", 0}};
    options.integers = {{"max_iter", 1000}};
    const optimisers::IpoptResult result = optimisers::run_ipopt(program, program.start(), options);
    const VectorX found = program.factors(result.x);
    const bool is_better =
        result.x.size() == program.n() && (misses(model, found).array() <= 1e-6).all() && cost_of(model, found) < cost_of(model, *start);
    const VectorX& taken = is_better ? found : *start;
    return {true, taken, cost_of(model, taken), optimisers::ipopt_words(result.status)};
}

}  // namespace fettle::design::studies
