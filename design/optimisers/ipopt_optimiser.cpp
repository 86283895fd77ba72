// SPDX-License-Identifier: MIT
#include "design/optimisers/ipopt_optimiser.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/limits.hpp"
#include "design/optimisers/nonlinear_program.hpp"

namespace fettle::design::optimisers {

namespace {

// The evaluator's scaled problem; rows are those of its constraints and relations that have a bound.
class WholeProgram : public NonlinearProgram {
public:
    explicit WholeProgram(Evaluator& evaluator) : evaluator_(evaluator) {
        const VectorX &lower = evaluator.scaled_constraint_lower(), &upper = evaluator.scaled_constraint_upper();
        for (int i = 0; i < evaluator.constraints(); ++i)
            if (std::isfinite(lower[i]) || std::isfinite(upper[i])) rows_.push_back(i);
    }

    Bounds bounds() const override {
        Bounds out{VectorX::Zero(n()), VectorX::Ones(n()), VectorX(m()), VectorX(m())};
        for (int k = 0; k < n(); ++k) {
            if (!evaluator_.is_periodic(k)) continue;
            out.lower[k] = -core::base::infinity;
            out.upper[k] = core::base::infinity;
        }
        for (int i = 0; i < m(); ++i) {
            out.row_lower[i] = evaluator_.scaled_constraint_lower()[row(i)];
            out.row_upper[i] = evaluator_.scaled_constraint_upper()[row(i)];
        }
        return out;
    }
    int jacobian_entries() const override { return m() * n(); }
    int hessian_entries() const override { return 0; }

    bool value(const double* x, double& f) override {
        const Evaluation* e = at(x);
        if (e != nullptr) f = e->objective;
        return e != nullptr;
    }

    bool gradient(const double* x, double* out) override {
        const Evaluation* e = at(x);
        if (e != nullptr) Eigen::Map<VectorX>(out, n()) = e->gradient;
        return e != nullptr;
    }

    bool row_values(const double* x, double* out) override {
        const Evaluation* e = at(x);
        for (int i = 0; e != nullptr && i < m(); ++i) out[i] = e->constraints[row(i)];
        return e != nullptr;
    }

    bool jacobian(const double* x, int* rows, int* columns, double* values) override {
        const Evaluation* e = values != nullptr ? at(x) : nullptr;
        if (values != nullptr && e == nullptr) return false;
        for (int k = 0; k < jacobian_entries(); ++k) {
            const int i = k / n(), j = k % n();
            if (values != nullptr) {
                values[k] = e->jacobian(row(i), j);
            } else {
                rows[k] = i;
                columns[k] = j;
            }
        }
        return true;
    }

    bool hessian(double, int*, int*, double*) override { return false; }
    bool goes_on() override { return !over_; }
    bool over() const { return over_; }
    bool begun() const { return begun_; }  ///< a point had a value

private:
    int n() const { return evaluator_.variables(); }
    int m() const { return count_of(rows_); }
    int row(int i) const { return rows_[i]; }

    // Null: there is no value there, or the run is over.
    const Evaluation* at(const double* x) {
        if (over_) return nullptr;
        const VectorX point = Eigen::Map<const VectorX>(x, n());
        if (point_.size() == n() && point == point_) return evaluation_;  // Ipopt asks for each number by itself
        point_ = point;
        evaluation_ = nullptr;
        if (!point.allFinite() || !evaluator_.refusal(point).empty()) return nullptr;
        try {
            const Evaluation& e = evaluator_.at(point);
            if (e.usable) evaluation_ = &e;  // in the evaluator's records, which stay
            begun_ = begun_ || e.usable;
        } catch (const StopOptimisation&) {  // must not pass through C code
            over_ = true;
        }
        return evaluation_;
    }

    Evaluator& evaluator_;
    std::vector<int> rows_;
    bool over_ = false, begun_ = false;
    VectorX point_;
    const Evaluation* evaluation_ = nullptr;
};

IpoptOptions options_for(const OptimiserOptions& options, double push) {
    const double tolerance = 1e-2 * options.tolerance;
    IpoptOptions out;
    out.words = {{"hessian_approximation", "limited-memory"}, {"nlp_scaling_method", "none"}, {"mu_strategy", "adaptive"}};
    out.numbers = {{"tol", tolerance}, {"constr_viol_tol", 1e-8}, {"bound_relax_factor", 0}, {"bound_push", push}, {"bound_frac", push}};
    out.integers = {{"max_iter", 20 * options.max_evaluations}};  // the evaluator counts
    return out;
}

}  // namespace

NativeOutcome IpoptOptimiser::minimise(Evaluator& evaluator, const OptimiserOptions& options) const {
    if (evaluator.variables() == 0) return {0, "no variables"};
    NativeOutcome outcome;
    // Ipopt begins this far within the bounds, at a point that may fail where the start does not.
    for (const double push : {1e-2, 1e-4, 1e-6}) {
        WholeProgram program(evaluator);
        const IpoptResult result = run_ipopt(program, evaluator.best_scaled_point(), options_for(options, push));
        outcome.iterations += result.iterations;
        outcome.message = program.over() ? "stopped" : ipopt_words(result.status);
        if (program.over() || program.begun()) break;
    }
    return outcome;
}

}  // namespace fettle::design::optimisers
