// SPDX-License-Identifier: MIT
#include "fettle/design/optimisers/ipopt_optimiser.hpp"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <cmath>
#include <mutex>
#include "fettle/design/optimisers/optimality.hpp"

namespace fettle::design::optimisers {

namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr double ipopt_infinity = 1e20;  // beyond 1e19 Ipopt takes a bound as none

double bounded(double value) { return std::min(std::max(value, -ipopt_infinity), ipopt_infinity); }

class ScaledProblem : public Ipopt::TNLP {
public:
    ScaledProblem(Evaluator& evaluator, const OptimiserOptions& options) : evaluator_(evaluator), options_(options) {}

    bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag, IndexStyleEnum& index_style) override {
        n = evaluator_.variables();
        m = evaluator_.constraints();
        nnz_jac_g = n * m;
        nnz_h_lag = 0;
        index_style = C_STYLE;
        return true;
    }

    bool get_bounds_info(Index n, Number* x_l, Number* x_u, Index m, Number* g_l, Number* g_u) override {
        for (Index i = 0; i < n; ++i) {
            x_l[i] = 0;
            x_u[i] = 1;
        }
        for (Index i = 0; i < m; ++i) {
            g_l[i] = bounded(evaluator_.scaled_constraint_lower()[i]);
            g_u[i] = bounded(evaluator_.scaled_constraint_upper()[i]);
        }
        return true;
    }

    bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
        Eigen::Map<VectorX>(x, n) = evaluator_.scaled_start();
        return true;
    }

    bool eval_f(Index n, const Number* x, bool, Number& f) override {
        const Evaluation* e = evaluate(n, x);
        if (e) f = e->objective;
        return e != nullptr;
    }

    bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
        const Evaluation* e = evaluate(n, x);
        if (e) Eigen::Map<VectorX>(gradient, n) = e->gradient;
        return e != nullptr;
    }

    bool eval_g(Index n, const Number* x, bool, Index m, Number* g) override {
        const Evaluation* e = evaluate(n, x);
        if (e) Eigen::Map<VectorX>(g, m) = e->constraints;
        return e != nullptr;
    }

    bool eval_jac_g(Index n, const Number* x, bool, Index m, Index, Index* row, Index* column, Number* values) override {
        if (values == nullptr) {
            for (Index k = 0; k < n * m; ++k) {
                row[k] = k / n;
                column[k] = k % n;
            }
            return true;
        }
        const Evaluation* e = evaluate(n, x);
        if (e) Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(values, m, n) = e->jacobian;
        return e != nullptr;
    }

    // Done, too, when several iterations in a row brought the best feasible design forward by less than the tolerance: soon if that design
    // looks optimal, later if it does not (the filter's iterates are infeasible for a while).
    bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number, Number, Number, Number, Number, Number, Index,
                               const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
        iterations_ = iteration;
        const Evaluation best = evaluator_.best_scaled_evaluation();
        if (best.violation > 0) return true;
        const double change = last_best_ - best.objective;
        quiet_iterations_ = change > options_.tolerance * std::max(1.0, std::abs(best.objective)) ? 0 : quiet_iterations_ + 1;
        last_best_ = std::min(last_best_, best.objective);
        if (quiet_iterations_ < quiet_iterations_wanted) return true;
        settled_ = optimality_residual(evaluator_, evaluator_.best_scaled_point(), best, nearly_active) <= nearly_optimal;
        given_up_ = quiet_iterations_ >= most_quiet_iterations;
        return !settled_ && !given_up_;
    }

    void finalize_solution(Ipopt::SolverReturn, Index, const Number*, const Number*, const Number*, Index, const Number*, const Number*,
                           Number, const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {}

    int iterations() const { return iterations_; }

private:
    // 4 in a row: a limited-memory step is now and then short while its curvature is still being learnt.
    static constexpr int quiet_iterations_wanted = 4;
    static constexpr int most_quiet_iterations = 15;

    // StopOptimisation passes through Ipopt, which answers it with NonIpopt_Exception_Thrown.
    const Evaluation* evaluate(Index n, const Number* x) {
        const Evaluation& e = evaluator_.at(Eigen::Map<const VectorX>(x, n));
        return e.usable ? &e : nullptr;
    }

    Evaluator& evaluator_;
    const OptimiserOptions& options_;
    double last_best_ = std::numeric_limits<double>::infinity();
    int quiet_iterations_ = 0;
    int iterations_ = 0;
    bool settled_ = false, given_up_ = false;
};

const char* words(Ipopt::ApplicationReturnStatus status) {
    switch (status) {
        case Ipopt::Solve_Succeeded:
            return "optimal to tolerance";
        case Ipopt::Solved_To_Acceptable_Level:
            return "optimal to acceptable tolerance";
        case Ipopt::Infeasible_Problem_Detected:
            return "converged to a point of local infeasibility";
        case Ipopt::Search_Direction_Becomes_Too_Small:
            return "search direction became too small";
        case Ipopt::Feasible_Point_Found:
            return "feasible point found";
        case Ipopt::Maximum_Iterations_Exceeded:
            return "iteration limit";
        case Ipopt::Restoration_Failed:
            return "feasibility restoration failed";
        case Ipopt::Error_In_Step_Computation:
            return "error in step computation";
        case Ipopt::Not_Enough_Degrees_Of_Freedom:
            return "fewer variables than equality constraints";
        case Ipopt::Invalid_Number_Detected:
            return "no step could be evaluated";
        case Ipopt::User_Requested_Stop:
            return "no further improvement above the tolerance";
        case Ipopt::NonIpopt_Exception_Thrown:
            return "stopped";
        default:
            return "failed";
    }
}

void set_options(Ipopt::OptionsList& list, const OptimiserOptions& options) {
    list.SetStringValue("hessian_approximation", "limited-memory");
    list.SetIntegerValue("limited_memory_max_history", 12);
    list.SetStringValue("nlp_scaling_method", "none");  // the evaluator has scaled already
    list.SetStringValue("mu_strategy", "adaptive");
    list.SetIntegerValue("print_level", 0);
    list.SetStringValue("sb", "yes");
    list.SetNumericValue("bound_relax_factor", 0);
    list.SetNumericValue("tol", options.tolerance);
    list.SetNumericValue("constr_viol_tol", std::min(1e-6, options.tolerance));
    list.SetNumericValue("acceptable_tol", 10 * options.tolerance);
    list.SetIntegerValue("acceptable_iter", 5);
    list.SetNumericValue("acceptable_constr_viol_tol", 1e-6);
    list.SetNumericValue("acceptable_obj_change_tol", options.tolerance);
    list.SetIntegerValue("max_iter", std::max(1, options.max_evaluations));
}

}  // namespace

NativeOutcome IpoptOptimiser::minimise(Evaluator& evaluator, const OptimiserOptions& options) const {
    if (evaluator.variables() == 0) return {0, "no variables"};
    static std::mutex one_solve_at_a_time;
    const std::lock_guard<std::mutex> lock(one_solve_at_a_time);
    Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
    set_options(*application->Options(), options);
    if (application->Initialize("") != Ipopt::Solve_Succeeded) return {0, "cannot be initialised"};
    Ipopt::SmartPtr<ScaledProblem> problem = new ScaledProblem(evaluator, options);
    const Ipopt::ApplicationReturnStatus status = application->OptimizeTNLP(GetRawPtr(problem));
    return {problem->iterations(), words(status)};
}

}  // namespace fettle::design::optimisers
