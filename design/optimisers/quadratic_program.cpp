// SPDX-License-Identifier: MIT
#include "fettle/design/optimisers/quadratic_program.hpp"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "fettle/core/base/contract.hpp"

namespace fettle::design::optimisers {

namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr double no_bound = 1e20;  // beyond 1e19 Ipopt takes a bound as none

double bounded(double value) { return std::clamp(value, -no_bound, no_bound); }

// Unknowns: d, then one slack for each side of a row that is finite: lower <= A d + below - above <= upper, both >= 0.
class ElasticProgram : public Ipopt::TNLP {
public:
    explicit ElasticProgram(const QuadraticProgram& program) : program_(program) {
        for (int i = 0; i < m(); ++i) {
            if (std::isfinite(program.lower[i])) slacks_.push_back({i, 1});
            if (std::isfinite(program.upper[i])) slacks_.push_back({i, -1});
        }
    }

    bool get_nlp_info(Index& n_out, Index& m_out, Index& jacobian, Index& hessian, IndexStyleEnum& index_style) override {
        n_out = n() + static_cast<Index>(slacks_.size());
        m_out = m();
        jacobian = n() * m() + static_cast<Index>(slacks_.size());
        hessian = n() * (n() + 1) / 2;
        index_style = C_STYLE;
        return true;
    }

    bool get_bounds_info(Index size, Number* x_l, Number* x_u, Index, Number* g_l, Number* g_u) override {
        for (Index i = 0; i < size; ++i) {
            x_l[i] = i < n() ? program_.box_lower[i] : 0;
            x_u[i] = i < n() ? program_.box_upper[i] : no_bound;
        }
        for (Index i = 0; i < m(); ++i) {
            g_l[i] = bounded(program_.lower[i]);
            g_u[i] = bounded(program_.upper[i]);
        }
        return true;
    }

    bool get_starting_point(Index size, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
        std::fill(x, x + size, 0.0);
        for (size_t k = 0; k < slacks_.size(); ++k) {
            const double bound = slacks_[k].sign > 0 ? program_.lower[slacks_[k].row] : program_.upper[slacks_[k].row];
            x[n() + static_cast<Index>(k)] = std::max(0.0, slacks_[k].sign * bound);
        }
        return true;
    }

    bool eval_f(Index, const Number* x, bool, Number& f) override {
        const auto d = step(x);
        f = program_.gradient.dot(d) + 0.5 * d.dot(program_.hessian * d);
        for (size_t k = 0; k < slacks_.size(); ++k) f += program_.penalty * x[n() + static_cast<Index>(k)];
        return true;
    }

    bool eval_grad_f(Index size, const Number* x, bool, Number* gradient) override {
        std::fill(gradient, gradient + size, program_.penalty);
        Eigen::Map<VectorX>(gradient, n()) = program_.gradient + program_.hessian * step(x);
        return true;
    }

    bool eval_g(Index, const Number* x, bool, Index, Number* g) override {
        Eigen::Map<VectorX> values(g, m());
        values = program_.rows * step(x);
        for (size_t k = 0; k < slacks_.size(); ++k) values[slacks_[k].row] += slacks_[k].sign * x[n() + static_cast<Index>(k)];
        return true;
    }

    bool eval_jac_g(Index, const Number*, bool, Index, Index, Index* row, Index* column, Number* values) override {
        const Index dense = n() * m();
        for (Index k = 0; k < dense; ++k) {
            if (values == nullptr) {
                row[k] = k / n();
                column[k] = k % n();
            } else {
                values[k] = program_.rows(k / n(), k % n());
            }
        }
        for (Index k = 0; k < static_cast<Index>(slacks_.size()); ++k) {
            const Slack& slack = slacks_[static_cast<size_t>(k)];
            if (values == nullptr) {
                row[dense + k] = slack.row;
                column[dense + k] = n() + k;
            } else {
                values[dense + k] = slack.sign;
            }
        }
        return true;
    }

    bool eval_h(Index, const Number*, bool, Number factor, Index, const Number*, bool, Index, Index* row, Index* column,
                Number* values) override {
        Index k = 0;
        for (Index i = 0; i < n(); ++i) {
            for (Index j = 0; j <= i; ++j, ++k) {
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

    void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number*, const Number*, Index, const Number*,
                           const Number* lambda, Number, const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
        solution_.step = step(x).cwiseMax(program_.box_lower).cwiseMin(program_.box_upper);
        solution_.multipliers = -Eigen::Map<const VectorX>(lambda, m());
    }

    QuadraticSolution solution_;

private:
    struct Slack {
        int row;
        double sign;  // +1: lifts a row to its lower side
    };
    int n() const { return static_cast<int>(program_.gradient.size()); }
    int m() const { return static_cast<int>(program_.rows.rows()); }
    Eigen::Map<const VectorX> step(const Number* x) const { return {x, n()}; }

    const QuadraticProgram& program_;
    std::vector<Slack> slacks_;
};

bool is_finite(const QuadraticProgram& p) {
    return p.gradient.allFinite() && p.hessian.allFinite() && p.rows.allFinite() && std::isfinite(p.penalty);
}

void set_options(Ipopt::OptionsList& list, bool predictor_corrector) {
    list.SetIntegerValue("print_level", 0);
    list.SetStringValue("sb", "yes");
    list.SetStringValue("jac_c_constant", "yes");
    list.SetStringValue("jac_d_constant", "yes");
    list.SetStringValue("hessian_constant", "yes");
    list.SetStringValue("mehrotra_algorithm", predictor_corrector ? "yes" : "no");
    if (!predictor_corrector) list.SetStringValue("mu_strategy", "adaptive");
    list.SetStringValue("nlp_scaling_method", "none");
    list.SetNumericValue("bound_relax_factor", 0);
    list.SetNumericValue("tol", 1e-9);
    list.SetNumericValue("acceptable_tol", 1e-7);
    list.SetIntegerValue("max_iter", 300);
}

// Step and multipliers.
std::optional<QuadraticSolution> solve_once(const QuadraticProgram& program, bool predictor_corrector) {
    static std::mutex one_solve_at_a_time;
    const std::lock_guard<std::mutex> lock(one_solve_at_a_time);
    Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
    set_options(*application->Options(), predictor_corrector);
    if (application->Initialize("") != Ipopt::Solve_Succeeded) return std::nullopt;
    Ipopt::SmartPtr<ElasticProgram> problem = new ElasticProgram(program);
    const Ipopt::ApplicationReturnStatus status = application->OptimizeTNLP(GetRawPtr(problem));
    if (status != Ipopt::Solve_Succeeded && status != Ipopt::Solved_To_Acceptable_Level) return std::nullopt;
    if (!problem->solution_.step.allFinite() || !problem->solution_.multipliers.allFinite()) return std::nullopt;
    return problem->solution_;
}

}  // namespace

double row_violation(const VectorX& values, const VectorX& lower, const VectorX& upper) {
    double sum = 0;
    for (Eigen::Index i = 0; i < values.size(); ++i) sum += std::max({0.0, lower[i] - values[i], values[i] - upper[i]});
    return sum;
}

QuadraticSolution solve(const QuadraticProgram& program) {
    FETTLE_ASSERT(program.hessian.rows() == program.gradient.size() && program.rows.cols() == program.gradient.size(), "sizes agree");
    if (!is_finite(program) || (program.box_lower.array() == program.box_upper.array()).all()) return {};
    // Mehrotra's steps are few; where they fail, as with a high price on what is hard to meet, those with a line search do not.
    std::optional<QuadraticSolution> solved = solve_once(program, true);
    if (!solved) solved = solve_once(program, false);
    if (!solved) return {};
    QuadraticSolution solution = std::move(*solved);
    const VectorX& d = solution.step;
    solution.box_multipliers = program.gradient + program.hessian * d - program.rows.transpose() * solution.multipliers;
    solution.violation = row_violation(program.rows * d, program.lower, program.upper);
    const double before = program.penalty * row_violation(VectorX::Zero(program.rows.rows()), program.lower, program.upper);
    const double after = program.gradient.dot(d) + 0.5 * d.dot(program.hessian * d) + program.penalty * solution.violation;
    solution.solved = true;
    solution.decrease = std::max(0.0, before - after);
    return solution;
}

}  // namespace fettle::design::optimisers
