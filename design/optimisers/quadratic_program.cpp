// SPDX-License-Identifier: MIT
#include "fettle/design/optimisers/quadratic_program.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fettle/core/base/contract.hpp"
#include "fettle/design/optimisers/ipopt_library.hpp"

namespace fettle::design::optimisers {

namespace {

constexpr double no_bound = 1e20;  // beyond 1e19 Ipopt takes a bound as none

double bounded(double value) { return std::clamp(value, -no_bound, no_bound); }

// Unknowns: d, then one slack for each side of a row that is finite, and one for each kink, all >= 0:
//   lower <= A d + below - above <= upper,   cut_lower <= C d + (below of its row, or its kink).
// Ipopt's C interface asks for each of these by a function of its own (below).
class ElasticProgram {
public:
    explicit ElasticProgram(const QuadraticProgram& program) : program_(program) {
        for (int i = 0; i < m(); ++i) {
            if (std::isfinite(program.lower[i])) add_slack(i, 1, program.penalty, program.lower[i]);
            if (std::isfinite(program.upper[i])) add_slack(i, -1, program.penalty, -program.upper[i]);
        }
        for (int j = 0; j < cuts(); ++j) share_slack(j);
    }

    int unknowns() const { return n() + static_cast<int>(slacks_.size()); }
    int rows() const { return m() + cuts(); }
    int jacobian_entries() const { return n() * rows() + static_cast<int>(places_.size()); }
    int hessian_entries() const { return n() * (n() + 1) / 2; }

    VectorX lower() const {
        VectorX out = VectorX::Zero(unknowns());
        out.head(n()) = program_.box_lower;
        return out;
    }
    VectorX upper() const {
        VectorX out = VectorX::Constant(unknowns(), no_bound);
        out.head(n()) = program_.box_upper;
        return out;
    }
    VectorX row_lower() const {
        VectorX out(rows());
        for (int i = 0; i < m(); ++i) out[i] = bounded(program_.lower[i]);
        for (int j = 0; j < cuts(); ++j) out[m() + j] = bounded(program_.cuts.lower[j]);
        return out;
    }
    VectorX row_upper() const {
        VectorX out = VectorX::Constant(rows(), no_bound);
        for (int i = 0; i < m(); ++i) out[i] = bounded(program_.upper[i]);
        return out;
    }
    VectorX start() const {
        VectorX out = VectorX::Zero(unknowns());
        for (size_t k = 0; k < slacks_.size(); ++k) out[n() + static_cast<Eigen::Index>(k)] = slacks_[k].start;
        return out;
    }

    double value(const double* x) const {
        const auto d = step(x);
        double f = program_.gradient.dot(d) + 0.5 * d.dot(program_.hessian * d);
        for (size_t k = 0; k < slacks_.size(); ++k) f += slacks_[k].price * x[static_cast<size_t>(n()) + k];
        return f;
    }

    void gradient(const double* x, double* out) const {
        for (int k = n(); k < unknowns(); ++k) out[k] = slacks_[static_cast<size_t>(k - n())].price;
        Eigen::Map<VectorX>(out, n()) = program_.gradient + program_.hessian * step(x);
    }

    void row_values(const double* x, double* out) const {
        Eigen::Map<VectorX> values(out, rows());
        values.head(m()) = program_.rows * step(x);
        if (cuts() > 0) values.tail(cuts()) = program_.cuts.rows * step(x);
        for (const SlackPlace& place : places_) values[place.row] += place.sign * x[n() + place.slack];
    }

    // The places if there are no values to fill, else the values.
    void jacobian(int* row, int* column, double* values) const {
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
        for (int k = 0; k < static_cast<int>(places_.size()); ++k) {
            const SlackPlace& place = places_[static_cast<size_t>(k)];
            if (values == nullptr) {
                row[dense + k] = place.row;
                column[dense + k] = n() + place.slack;
            } else {
                values[dense + k] = place.sign;
            }
        }
    }

    void hessian(double factor, int* row, int* column, double* values) const {
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
        places_.push_back({row, static_cast<int>(slacks_.size()), sign});
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
        slacks_[static_cast<size_t>(slack)].start = std::max(slacks_[static_cast<size_t>(slack)].start, missing);
        places_.push_back({m() + j, slack, 1});
    }

    int n() const { return static_cast<int>(program_.gradient.size()); }
    int m() const { return static_cast<int>(program_.rows.rows()); }
    int cuts() const { return static_cast<int>(program_.cuts.of.size()); }
    Eigen::Map<const VectorX> step(const double* x) const { return {x, n()}; }

    const QuadraticProgram& program_;
    std::vector<Slack> slacks_;
    std::vector<SlackPlace> places_;
};

bool is_finite(const QuadraticProgram& p) {
    return p.gradient.allFinite() && p.hessian.allFinite() && p.rows.allFinite() && std::isfinite(p.penalty) && p.cuts.rows.allFinite() &&
           p.cuts.lower.allFinite();
}

const ElasticProgram& program_of(UserDataPtr data) { return *static_cast<const ElasticProgram*>(data); }

// NOLINTBEGIN(readability-function-size): Ipopt's parameters
Bool ask_value(Index, Number* x, Bool, Number* value, UserDataPtr data) {
    *value = program_of(data).value(x);
    return TRUE;
}

Bool ask_gradient(Index, Number* x, Bool, Number* gradient, UserDataPtr data) {
    program_of(data).gradient(x, gradient);
    return TRUE;
}

Bool ask_rows(Index, Number* x, Bool, Index, Number* values, UserDataPtr data) {
    program_of(data).row_values(x, values);
    return TRUE;
}

Bool ask_jacobian(Index, Number*, Bool, Index, Index, Index* row, Index* column, Number* values, UserDataPtr data) {
    program_of(data).jacobian(row, column, values);
    return TRUE;
}

Bool ask_hessian(Index, Number*, Bool, Number factor, Index, Number*, Bool, Index, Index* row, Index* column, Number* values,
                 UserDataPtr data) {
    program_of(data).hessian(factor, row, column, values);
    return TRUE;
}
// NOLINTEND(readability-function-size)

using IpoptHandle = std::unique_ptr<IpoptProblemInfo, void (*)(IpoptProblem)>;

void set_options(const IpoptLibrary& ipopt, IpoptProblem problem, bool predictor_corrector) {
    const auto set = [&](std::string key, std::string value) { ipopt.add_string_option(problem, key.data(), value.data()); };
    const auto set_number = [&](std::string key, double value) { ipopt.add_number_option(problem, key.data(), value); };
    const auto set_integer = [&](std::string key, int value) { ipopt.add_integer_option(problem, key.data(), value); };
    set("option_file_name", "");  // none is read
    set_integer("print_level", 0);
    set("sb", "yes");
    set("jac_c_constant", "yes");
    set("jac_d_constant", "yes");
    set("hessian_constant", "yes");
    set("mehrotra_algorithm", predictor_corrector ? "yes" : "no");
    if (!predictor_corrector) set("mu_strategy", "adaptive");
    set("nlp_scaling_method", "none");
    set_number("bound_relax_factor", 0);
    set_number("tol", 1e-9);
    set_number("acceptable_tol", 1e-7);
    set_integer("max_iter", 300);
}

// Step and multipliers.
std::optional<QuadraticSolution> solve_once(const QuadraticProgram& program, bool predictor_corrector) {
    static std::mutex one_solve_at_a_time;
    const std::lock_guard<std::mutex> lock(one_solve_at_a_time);
    const IpoptLibrary& ipopt = ipopt_library();
    ElasticProgram elastic(program);
    VectorX lower = elastic.lower(), upper = elastic.upper(), row_lower = elastic.row_lower(), row_upper = elastic.row_upper();
    const IpoptHandle problem(ipopt.create_problem(elastic.unknowns(), lower.data(), upper.data(), elastic.rows(), row_lower.data(),
                                                   row_upper.data(), elastic.jacobian_entries(), elastic.hessian_entries(), 0, ask_value,
                                                   ask_rows, ask_gradient, ask_jacobian, ask_hessian),
                              ipopt.free_problem);
    if (!problem) return std::nullopt;
    set_options(ipopt, problem.get(), predictor_corrector);
    VectorX x = elastic.start(), lambda = VectorX::Zero(elastic.rows());
    const ApplicationReturnStatus status =
        ipopt.solve(problem.get(), x.data(), nullptr, nullptr, lambda.data(), nullptr, nullptr, &elastic);
    if (status != Solve_Succeeded && status != Solved_To_Acceptable_Level) return std::nullopt;
    QuadraticSolution found = elastic.solution(x, lambda);
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
