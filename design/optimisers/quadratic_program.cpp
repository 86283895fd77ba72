// SPDX-License-Identifier: MIT
#include "design/optimisers/quadratic_program.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/contract.hpp"
#include "design/optimisers/nonlinear_program.hpp"

namespace fettle::design::optimisers {

namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();

// Unknowns: d, then one slack for each side of a row that is finite, and one for each kink, all >= 0:
//   lower <= A d + below - above <= upper,   cut_lower <= C d + (below of its row, or its kink).
class ElasticProgram : public NonlinearProgram {
public:
    explicit ElasticProgram(const QuadraticProgram& program) : program_(program) {
        for (int i = 0; i < m(); ++i) {
            if (std::isfinite(program.lower[i])) add_slack(i, 1, program.penalty, program.lower[i]);
            if (std::isfinite(program.upper[i])) add_slack(i, -1, program.penalty, -program.upper[i]);
        }
        for (int j = 0; j < cuts(); ++j) share_slack(j);
    }

    int jacobian_entries() const override { return n() * rows() + count_of(places_); }
    int hessian_entries() const override { return n() * (n() + 1) / 2; }

    Bounds bounds() const override {
        Bounds out{VectorX::Zero(unknowns()), VectorX::Constant(unknowns(), no_bound), VectorX(rows()),
                   VectorX::Constant(rows(), no_bound)};
        out.lower.head(n()) = program_.box_lower;
        out.upper.head(n()) = program_.box_upper;
        out.row_lower.head(m()) = program_.lower;
        out.row_lower.tail(cuts()) = program_.cuts.lower;
        out.row_upper.head(m()) = program_.upper;
        return out;
    }
    VectorX start() const {
        VectorX out = VectorX::Zero(unknowns());
        for (size_t k = 0; k < slacks_.size(); ++k) out[n() + static_cast<Eigen::Index>(k)] = slacks_[k].start;
        return out;
    }

    bool value(const double* x, double& f) override {
        const auto d = step(x);
        f = program_.gradient.dot(d) + 0.5 * d.dot(program_.hessian * d);
        for (size_t k = 0; k < slacks_.size(); ++k) f += slacks_[k].price * x[static_cast<size_t>(n()) + k];
        return true;
    }

    bool gradient(const double* x, double* out) override {
        for (int k = n(); k < unknowns(); ++k) out[k] = slacks_[k - n()].price;
        Eigen::Map<VectorX>(out, n()) = program_.gradient + program_.hessian * step(x);
        return true;
    }

    bool row_values(const double* x, double* out) override {
        Eigen::Map<VectorX> values(out, rows());
        values.head(m()) = program_.rows * step(x);
        if (cuts() > 0) values.tail(cuts()) = program_.cuts.rows * step(x);
        for (const SlackPlace& place : places_) values[place.row] += place.sign * x[n() + place.slack];
        return true;
    }

    bool jacobian(const double*, int* row, int* column, double* values) override {
        const int dense = n() * rows();
        for (int k = 0; k < dense; ++k) {
            const int i = k / n(), j = k % n();
            if (values == nullptr) {
                row[k] = i;
                column[k] = j;
            } else {
                values[k] = i < m() ? program_.rows(i, j) : program_.cuts.rows(i - m(), j);
            }
        }
        for (int k = 0; k < count_of(places_); ++k) {
            const SlackPlace& place = places_[k];
            if (values == nullptr) {
                row[dense + k] = place.row;
                column[dense + k] = n() + place.slack;
            } else {
                values[dense + k] = place.sign;
            }
        }
        return true;
    }

    bool hessian(double factor, int* row, int* column, double* values) override {
        int k = 0;
        for (int i = 0; i < n(); ++i) {
            for (int j = 0; j <= i; ++j, ++k) {
                if (values == nullptr) {
                    row[k] = i;
                    column[k] = j;
                } else {
                    values[k] = factor * program_.hessian(i, j);
                }
            }
        }
        return true;
    }

    QuadraticSolution solution(const VectorX& x, const VectorX& lambda) const {
        QuadraticSolution out;
        out.step = x.head(n()).cwiseMax(program_.box_lower).cwiseMin(program_.box_upper);
        out.multipliers = -lambda.head(m());
        out.cut_multipliers = -lambda.tail(cuts());
        return out;
    }

private:
    struct Slack {
        double price, start;
    };
    struct SlackPlace {
        int row, slack;
        double sign;  // +1: lifts a row to its lower side
    };

    // @param missing  By how much the row misses its side at d = 0.
    void add_slack(int row, double sign, double price, double missing) {
        places_.push_back({row, count_of(slacks_), sign});
        slacks_.push_back({price, std::max(0.0, missing)});
    }

    // With its row's lower side, or the cuts of its kink before it.
    void share_slack(int j) {
        const std::vector<int>& of = program_.cuts.of;
        const auto here = static_cast<size_t>(j);
        const int first = static_cast<int>(std::find(of.begin(), of.end(), of[here]) - of.begin());
        const int row = of[here] >= 0 ? of[here] : m() + first;
        const auto shared = std::find_if(places_.begin(), places_.end(), [&](const SlackPlace& p) { return p.row == row && p.sign > 0; });
        const double missing = program_.cuts.lower[j];
        if (shared == places_.end()) return add_slack(m() + j, 1, 1, missing);
        const int slack = shared->slack;
        slacks_[slack].start = std::max(slacks_[slack].start, missing);
        places_.push_back({m() + j, slack, 1});
    }

    int unknowns() const { return n() + count_of(slacks_); }
    int rows() const { return m() + cuts(); }
    int n() const { return count_of(program_.gradient); }
    int m() const { return static_cast<int>(program_.rows.rows()); }
    int cuts() const { return count_of(program_.cuts.of); }
    Eigen::Map<const VectorX> step(const double* x) const { return {x, n()}; }

    const QuadraticProgram& program_;
    std::vector<Slack> slacks_;
    std::vector<SlackPlace> places_;
};

bool is_finite(const QuadraticProgram& p) {
    return p.gradient.allFinite() && p.hessian.allFinite() && p.rows.allFinite() && std::isfinite(p.penalty) && p.cuts.rows.allFinite() &&
           p.cuts.lower.allFinite();
}

IpoptOptions options_for(bool predictor_corrector) {
    IpoptOptions options;
    options.words = {{"jac_c_constant", "yes"},
                     {"jac_d_constant", "yes"},
                     {"hessian_constant", "yes"},
                     {"mehrotra_algorithm", predictor_corrector ? "yes" : "no"},
                     {"nlp_scaling_method", "none"}};
    if (!predictor_corrector) options.words.emplace_back("mu_strategy", "adaptive");
    options.numbers = {{"bound_relax_factor", 0}, {"tol", 1e-9}, {"acceptable_tol", 1e-7}};
    options.integers = {{"max_iter", 300}};
    return options;
}

// Step and multipliers.
std::optional<QuadraticSolution> solve_once(const QuadraticProgram& program, bool predictor_corrector) {
    ElasticProgram elastic(program);
    const IpoptResult result = run_ipopt(elastic, elastic.start(), options_for(predictor_corrector));
    if (!result.solved()) return std::nullopt;
    QuadraticSolution found = elastic.solution(result.x, result.multipliers);
    if (!found.step.allFinite() || !found.multipliers.allFinite()) return std::nullopt;
    return found;
}

}  // namespace

double row_violation(const VectorX& values, const VectorX& lower, const VectorX& upper) {
    double sum = 0;
    for (Eigen::Index i = 0; i < values.size(); ++i) sum += std::max({0.0, lower[i] - values[i], values[i] - upper[i]});
    return sum;
}

namespace {

struct Prices {
    double violation = 0, kinks = 0;
};

Prices prices_at(const QuadraticProgram& program, const VectorX& d) {
    const Cuts& cuts = program.cuts;
    const VectorX values = program.rows * d;
    Prices prices{row_violation(values, program.lower, program.upper), 0};
    for (size_t j = 0; j < cuts.of.size(); ++j) {
        if (std::find(cuts.of.begin(), cuts.of.begin() + static_cast<std::ptrdiff_t>(j), cuts.of[j]) !=
            cuts.of.begin() + static_cast<std::ptrdiff_t>(j))
            continue;  // counted with the first of them
        double most = 0;
        for (size_t i = j; i < cuts.of.size(); ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            if (cuts.of[i] == cuts.of[j]) most = std::max(most, cuts.lower[row] - cuts.rows.row(row).dot(d));
        }
        if (cuts.of[j] < 0) prices.kinks += most;
        if (cuts.of[j] >= 0) prices.violation += std::max(0.0, most - std::max(0.0, program.lower[cuts.of[j]] - values[cuts.of[j]]));
    }
    return prices;
}

}  // namespace

QuadraticSolution solve(const QuadraticProgram& program) {
    const Cuts& cuts = program.cuts;
    FETTLE_ASSERT(program.hessian.rows() == program.gradient.size() && program.rows.cols() == program.gradient.size(), "sizes agree");
    FETTLE_ASSERT(cuts.of.empty() || (cuts.rows.cols() == program.gradient.size() && cuts.rows.rows() == cuts.lower.size()), "sizes agree");
    FETTLE_ASSERT(static_cast<Eigen::Index>(cuts.of.size()) == cuts.lower.size(), "one owner per cut");
    FETTLE_ASSERT(std::all_of(cuts.of.begin(), cuts.of.end(),
                              [&](int i) { return i < program.lower.size() && (i < 0 || std::isfinite(program.lower[i])); }),
                  "a cut is of a kink, or of a row with a lower side");
    if (!is_finite(program) || (program.box_lower.array() == program.box_upper.array()).all()) return {};
    // Mehrotra's steps are few; where they fail, as with a high price on what is hard to meet, those with a line search do not.
    std::optional<QuadraticSolution> solved = solve_once(program, true);
    if (!solved) solved = solve_once(program, false);
    if (!solved) return {};
    QuadraticSolution solution = std::move(*solved);
    solution.cut_of = cuts.of;
    const VectorX& d = solution.step;
    solution.box_multipliers = program.gradient + program.hessian * d - program.rows.transpose() * solution.multipliers;
    if (solution.cut_multipliers.size() > 0) solution.box_multipliers -= program.cuts.rows.transpose() * solution.cut_multipliers;
    const Prices start = prices_at(program, VectorX::Zero(d.size())), end = prices_at(program, d);
    solution.violation = end.violation;
    solution.kinks = end.kinks;
    const double before = program.penalty * start.violation + start.kinks;
    const double after = program.gradient.dot(d) + 0.5 * d.dot(program.hessian * d) + program.penalty * end.violation + end.kinks;
    solution.solved = true;
    solution.decrease = std::max(0.0, before - after);
    return solution;
}

}  // namespace fettle::design::optimisers
