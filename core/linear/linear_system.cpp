// SPDX-License-Identifier: MIT
#include "core/linear/linear_system.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/contract.hpp"
#include "core/linear/block_cholesky.hpp"
#include "core/linear/indefinite_factor.hpp"
#include "core/linear/quasi_definite_factor.hpp"
#include "core/linear/supernodal_cholesky.hpp"

namespace fettle::core::linear {
namespace {

constexpr double refined_enough = 1e-15;  // of what rounding is measured by

using Column = Eigen::Ref<const VectorX>;

// What one solution leaves over: b - A x, the largest entry of a force and of a row, and the largest sum of magnitudes that such an entry
// is the difference of. Forces and rows each for themselves, for one may be far smaller than the other.
class Residual {
public:
    Residual(const BlockHessian& hessian, const RowJacobian& rows, const FreeDofs& dofs) : hessian_(hessian), rows_(rows), dofs_(dofs) {
        y_.assign(dofs.index.size(), Vector6::Zero());
        taken_.resize(y_.size());
        sum_.resize(y_.size());
    }

    /// @param b, x  forces, then rows; degrees of freedom, then multipliers
    void measure(const Column& b, const Column& x) {
        const Eigen::Index count = dofs_.count, row_count = rows_.count();
        scatter(dofs_, x.head(count), y_);
        of_rows_ = b.tail(row_count).cwiseAbs();
        VectorX row_sums = VectorX::Zero(row_count);
        for (std::size_t i = 0; i < y_.size(); ++i) {
            taken_[i] = hessian_.diagonal[i] * y_[i];
            sum_[i] = hessian_.diagonal[i].cwiseAbs() * y_[i].cwiseAbs();
        }
        for (const OffDiagonalBlock& block : hessian_.off_diagonal) {
            taken_[block.a] += block.block * y_[block.b];
            taken_[block.b] += block.block.transpose() * y_[block.a];
            sum_[block.a] += block.block.cwiseAbs() * y_[block.b].cwiseAbs();
            sum_[block.b] += block.block.transpose().cwiseAbs() * y_[block.a].cwiseAbs();
        }
        for (Eigen::Index i = 0; i < row_count; ++i)
            for (int e = rows_.first[i]; e < rows_.first[i + 1]; ++e) {
                const auto& [body, gradient] = rows_.entries[e];
                taken_[body] += x[count + i] * gradient;
                sum_[body] += std::abs(x[count + i]) * gradient.cwiseAbs();
                row_sums[i] += gradient.dot(y_[body]);
                of_rows_[i] += gradient.cwiseAbs().dot(y_[body].cwiseAbs());
            }
        left_.resize(count + row_count);
        left_.head(count) = b.head(count) - gather(dofs_, taken_);
        left_.tail(row_count) = b.tail(row_count) - row_sums;
        largest_ = {largest_of(left_.head(count)), largest_of(left_.tail(row_count))};
        magnitude_ = {largest_of(b.head(count).cwiseAbs() + gather(dofs_, sum_)), largest_of(of_rows_)};
    }

    const VectorX& left() const { return left_; }
    const std::array<double, 2>& largest() const { return largest_; }
    /// Is what is left over the rounding of the sums?
    bool is_rounding() const { return !(largest_[0] > refined_enough * magnitude_[0] || largest_[1] > refined_enough * magnitude_[1]); }

private:
    template <class Values>
    static double largest_of(const Values& values) {
        return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0;
    }

    const BlockHessian& hessian_;
    const RowJacobian& rows_;
    const FreeDofs& dofs_;
    std::vector<Vector6> y_, taken_, sum_;
    VectorX left_, of_rows_;
    std::array<double, 2> largest_{}, magnitude_{};
};

MatrixX stacked(const MatrixX& r, const MatrixX& c) {
    if (c.rows() == 0) return r;
    MatrixX both(r.rows() + c.rows(), r.cols());
    both << r, c;
    return both;
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
        return MatrixX::Constant(rhs.rows(), rhs.cols(), std::numeric_limits<double>::quiet_NaN());
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
    const MatrixX b = stacked(r, c);
    if (b.size() == 0) return {r, c};
    const MatrixX x = implementation_->solve(b);
    return {x.topRows(r.rows()), x.bottomRows(c.rows())};
}

LinearSystem::Solution LinearSystem::residual(const BlockHessian& hessian, const RowJacobian& rows, const MatrixX& r, const MatrixX& c,
                                              const Solution& x) const {
    Residual residual(hessian, rows, dofs());
    const MatrixX b = stacked(r, c), both = stacked(x.y, x.multipliers);
    Solution out{MatrixX(r.rows(), r.cols()), MatrixX(rows.count(), r.cols())};
    for (Eigen::Index k = 0; k < r.cols(); ++k) {
        residual.measure(b.col(k), both.col(k));
        out.y.col(k) = residual.left().head(r.rows());
        out.multipliers.col(k) = residual.left().tail(rows.count());
    }
    return out;
}

LinearSystem::Solution LinearSystem::solve_refined(const BlockHessian& hessian, const RowJacobian& rows, const MatrixX& r, const MatrixX& c,
                                                   int most_passes) const {
    const MatrixX b = stacked(r, c);
    if (b.size() == 0) return {r, c};
    MatrixX x = implementation_->solve(b);
    Residual now(hessian, rows, dofs());
    MatrixX left(b.rows(), b.cols());            // of the columns that are worth another pass, side by side
    std::vector<std::array<double, 2>> largest;  // their largest entries
    std::vector<Eigen::Index> open;              // which they are
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
        now.measure(b.col(k), x.col(k));
        if (rows.count() > 0 && now.is_rounding()) continue;
        left.col(count_of(open)) = now.left();
        open.push_back(k);
        largest.push_back(now.largest());
    }
    if (rows.count() == 0) return {x + implementation_->solve(left), c};
    for (int pass = 0; pass < most_passes && !open.empty(); ++pass) {
        MatrixX refined = implementation_->solve(left.leftCols(count_of(open)));
        std::vector<Eigen::Index> still;
        for (std::size_t n = 0; n < open.size(); ++n) {
            const Eigen::Index k = open[n];
            auto change = refined.col(static_cast<Eigen::Index>(n));
            change += x.col(k);
            now.measure(b.col(k), change);
            if (!(now.largest()[0] < 0.5 * largest[n][0] || now.largest()[1] < 0.5 * largest[n][1])) continue;
            x.col(k) = change;
            if (now.is_rounding()) continue;
            left.col(count_of(still)) = now.left();
            largest[still.size()] = now.largest();
            still.push_back(k);
        }
        open = std::move(still);
    }
    return {x.topRows(r.rows()), x.bottomRows(c.rows())};
}

}  // namespace fettle::core::linear
