// SPDX-License-Identifier: MIT
#include "fettle/core/linear/linear_system.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/linear/block_cholesky.hpp"
#include "fettle/core/linear/indefinite_factor.hpp"
#include "fettle/core/linear/quasi_definite_factor.hpp"
#include "fettle/core/linear/supernodal_cholesky.hpp"

namespace fettle::core::linear {
namespace {

constexpr int most_refinements = 6;
constexpr double refined_enough = 1e-15;  // of what rounding is measured by

// The sums of magnitudes that the residual of column k is the difference of: the largest of a force's, and of a row's.
std::array<double, 2> magnitudes(const BlockHessian& hessian, const RowJacobian& rows, const FreeDofs& dofs, const VectorX& r,
                                 const VectorX& c, const LinearSystem::Solution& x, Eigen::Index k) {
    std::vector<Vector6> y(dofs.index.size(), Vector6::Zero());
    scatter(dofs, x.y.col(k).cwiseAbs(), y);
    std::vector<Vector6> sum(y.size());
    for (std::size_t i = 0; i < y.size(); ++i) sum[i] = hessian.diagonal[i].cwiseAbs() * y[i];
    for (const OffDiagonalBlock& b : hessian.off_diagonal) {
        sum[b.a] += b.block.cwiseAbs() * y[b.b];
        sum[b.b] += b.block.transpose().cwiseAbs() * y[b.a];
    }
    VectorX of_rows = c.cwiseAbs();
    for (int i = 0; i < rows.count(); ++i)
        for (int e = rows.first[i]; e < rows.first[i + 1]; ++e) {
            const Vector6 gradient = rows.entries[e].gradient.cwiseAbs();
            sum[rows.entries[e].body] += std::abs(x.multipliers(i, k)) * gradient;
            of_rows[i] += gradient.dot(y[rows.entries[e].body]);
        }
    const VectorX of_forces = r.cwiseAbs() + gather(dofs, sum);
    return {of_forces.size() > 0 ? of_forces.maxCoeff() : 0, of_rows.size() > 0 ? of_rows.maxCoeff() : 0};
}

// Of column k: the largest entry of a force, and of a row: each for themselves, for one may be far smaller than the other.
std::array<double, 2> largest(const LinearSystem::Solution& residual, Eigen::Index k) {
    return {residual.y.rows() > 0 ? residual.y.col(k).cwiseAbs().maxCoeff() : 0,
            residual.multipliers.rows() > 0 ? residual.multipliers.col(k).cwiseAbs().maxCoeff() : 0};
}

}  // namespace

struct LinearSystem::Implementation {
    enum class Factor { none, blocks, supernodal, quasi_definite, indefinite };

    FreeDofs dofs;
    Factor factor = Factor::none;
    BlockCholesky blocks;
    SupernodalCholesky supernodal;
    QuasiDefiniteFactor quasi_definite;
    IndefiniteFactor indefinite;
    bool is_large = false;

    // @return is H positive definite?
    bool factorise_alone(const BlockHessian& hessian) {
        if (blocks.analyse(hessian, dofs)) {
            is_large = blocks.operations() > supernodal_operations && SupernodalCholesky::is_available();
            if (is_large) supernodal.analyse(hessian, dofs, blocks.order(), blocks.operations());
        }
        if (!(is_large ? supernodal.factorise(hessian, dofs) : blocks.factorise(hessian, dofs))) return false;
        factor = is_large ? Factor::supernodal : Factor::blocks;
        return true;
    }

    MatrixX solve(const MatrixX& rhs) const {
        switch (factor) {
            case Factor::blocks:
                return blocks.solve(rhs, dofs);
            case Factor::supernodal:
                return supernodal.solve(rhs);
            case Factor::quasi_definite:
                return quasi_definite.solve(rhs);
            case Factor::indefinite:
                return indefinite.solve(rhs);
            case Factor::none:
                break;
        }
        FETTLE_ASSERT(false, "solve without a factorisation");
        return {};
    }
};

LinearSystem::LinearSystem(FreeDofs dofs) : implementation_(std::make_unique<Implementation>()) { implementation_->dofs = std::move(dofs); }
LinearSystem::~LinearSystem() = default;
LinearSystem::LinearSystem(LinearSystem&&) noexcept = default;
LinearSystem& LinearSystem::operator=(LinearSystem&&) noexcept = default;

const FreeDofs& LinearSystem::dofs() const { return implementation_->dofs; }

bool LinearSystem::factorise(const BlockHessian& hessian, const RowJacobian& rows) {
    Implementation& self = *implementation_;
    self.factor = Implementation::Factor::none;
    if (rows.count() == 0) return self.factorise_alone(hessian);
    const bool is_definite = self.quasi_definite.factorise(hessian, rows, self.dofs);
    if (self.quasi_definite.is_usable()) self.factor = Implementation::Factor::quasi_definite;
    return is_definite;
}

bool LinearSystem::factorise_any(const BlockHessian& hessian, const RowJacobian& rows) {
    if (factorise(hessian, rows)) return true;
    Implementation& self = *implementation_;
    self.factor = Implementation::Factor::none;
    if (!self.indefinite.factorise(hessian, rows, self.dofs)) return false;
    self.factor = Implementation::Factor::indefinite;
    return true;
}

bool LinearSystem::is_usable() const { return implementation_->factor != Implementation::Factor::none; }

LinearSystem::Solution LinearSystem::solve(const MatrixX& r, const MatrixX& c) const {
    if (c.rows() == 0) return {r.size() > 0 ? implementation_->solve(r) : r, MatrixX(0, r.cols())};
    MatrixX both(r.rows() + c.rows(), r.cols());
    both << r, c;
    const MatrixX x = implementation_->solve(both);
    return {x.topRows(r.rows()), x.bottomRows(c.rows())};
}

LinearSystem::Solution LinearSystem::residual(const BlockHessian& hessian, const RowJacobian& rows, const MatrixX& r, const MatrixX& c,
                                              const Solution& x) const {
    const FreeDofs& dofs = this->dofs();
    Solution out{MatrixX(r.rows(), r.cols()), MatrixX(rows.count(), r.cols())};
    std::vector<Vector6> y(dofs.index.size(), Vector6::Zero());
    for (Eigen::Index k = 0; k < r.cols(); ++k) {
        scatter(dofs, x.y.col(k), y);
        std::vector<Vector6> taken = multiply(hessian, y);
        if (rows.count() > 0) {
            add_transposed(rows, x.multipliers.col(k), taken);
            out.multipliers.col(k) = c.col(k) - multiply(rows, y);
        }
        out.y.col(k) = r.col(k) - gather(dofs, taken);
    }
    return out;
}

LinearSystem::Solution LinearSystem::solve_refined(const BlockHessian& hessian, const RowJacobian& rows, const MatrixX& r,
                                                   const MatrixX& c) const {
    Solution x = solve(r, c);
    if (r.size() == 0 && rows.count() == 0) return x;
    Solution left = residual(hessian, rows, r, c, x);
    if (rows.count() == 0) {
        x.y += solve(left.y).y;
        return x;
    }
    std::vector<Eigen::Index> open;  // columns that are worth another pass
    for (Eigen::Index k = 0; k < r.cols(); ++k) open.push_back(k);
    for (int pass = 0; pass < most_refinements; ++pass) {
        std::erase_if(open, [&](Eigen::Index k) {
            const std::array<double, 2> most = largest(left, k), magnitude = magnitudes(hessian, rows, dofs(), r.col(k), c.col(k), x, k);
            return !(most[0] > refined_enough * magnitude[0] || most[1] > refined_enough * magnitude[1]);
        });
        if (open.empty()) break;
        const Solution change = solve(left.y(Eigen::all, open), left.multipliers(Eigen::all, open));
        const Solution refined{x.y(Eigen::all, open) + change.y, x.multipliers(Eigen::all, open) + change.multipliers};
        const Solution still = residual(hessian, rows, r(Eigen::all, open), c(Eigen::all, open), refined);
        std::vector<Eigen::Index> better;
        for (std::size_t n = 0; n < open.size(); ++n) {
            const auto of = static_cast<Eigen::Index>(n);
            const std::array<double, 2> before = largest(left, open[n]), after = largest(still, of);
            if (!(after[0] < 0.5 * before[0] || after[1] < 0.5 * before[1])) continue;
            x.y.col(open[n]) = refined.y.col(of);
            x.multipliers.col(open[n]) = refined.multipliers.col(of);
            left.y.col(open[n]) = still.y.col(of);
            left.multipliers.col(open[n]) = still.multipliers.col(of);
            better.push_back(open[n]);
        }
        open = std::move(better);
    }
    return x;
}

}  // namespace fettle::core::linear
