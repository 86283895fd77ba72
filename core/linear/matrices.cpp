// SPDX-License-Identifier: MIT
#include "core/linear/matrices.hpp"

#include <algorithm>

namespace fettle::core::linear {
namespace {

std::array<int, 2> pair_of(const OffDiagonalBlock& b) { return {b.a, b.b}; }

bool is_before(const OffDiagonalBlock& b, const std::array<int, 2>& pair) { return pair_of(b) < pair; }

// Zero blocks of pairs that have none, sorted, each once.
void insert_blocks(const std::vector<std::array<int, 2>>& missing, BlockHessian& hessian) {
    std::vector<OffDiagonalBlock> out;
    out.reserve(hessian.off_diagonal.size() + missing.size());
    auto next = hessian.off_diagonal.begin();
    for (const auto& [a, b] : missing) {
        const auto end = std::lower_bound(next, hessian.off_diagonal.end(), std::array{a, b}, is_before);
        out.insert(out.end(), next, end);
        out.push_back({a, b, Matrix6::Zero()});
        next = end;
    }
    out.insert(out.end(), next, hessian.off_diagonal.end());
    hessian.off_diagonal = std::move(out);
}

}  // namespace

std::vector<Vector6> multiply(const BlockHessian& hessian, const std::vector<Vector6>& v) {
    std::vector<Vector6> out(v.size());
    for (std::size_t i = 0; i < v.size(); ++i) out[i] = hessian.diagonal[i] * v[i];
    for (const OffDiagonalBlock& b : hessian.off_diagonal) {
        out[b.a] += b.block * v[b.b];
        out[b.b] += b.block.transpose() * v[b.a];
    }
    return out;
}

VectorX multiply(const RowJacobian& rows, const std::vector<Vector6>& v) {
    VectorX out = VectorX::Zero(rows.count());
    for (int i = 0; i < rows.count(); ++i)
        for (int k = rows.first[i]; k < rows.first[i + 1]; ++k) out[i] += rows.entries[k].gradient.dot(v[rows.entries[k].body]);
    return out;
}

void add_transposed(const RowJacobian& rows, const Eigen::Ref<const VectorX>& multipliers, std::vector<Vector6>& out) {
    for (int i = 0; i < rows.count(); ++i)
        for (int k = rows.first[i]; k < rows.first[i + 1]; ++k) out[rows.entries[k].body] += multipliers[i] * rows.entries[k].gradient;
}

std::vector<int> place_blocks(const std::vector<std::array<int, 2>>& pairs, BlockHessian& hessian) {
    std::vector<std::array<int, 2>> missing;
    std::vector<int> places(pairs.size());
    const auto find_all = [&] {
        missing.clear();
        const auto begin = hessian.off_diagonal.begin(), end = hessian.off_diagonal.end();
        auto at = begin;  // pairs come sorted but for a few
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            if (at != end && pair_of(*at) < pairs[k]) ++at;
            if (at == end || pair_of(*at) != pairs[k]) at = std::lower_bound(begin, end, pairs[k], is_before);
            if (at == end || pair_of(*at) != pairs[k]) missing.push_back(pairs[k]);
            places[k] = static_cast<int>(at - begin);
        }
    };
    find_all();
    if (missing.empty()) return places;
    std::sort(missing.begin(), missing.end());
    missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    insert_blocks(missing, hessian);
    find_all();
    return places;
}

void add_blocks(const std::vector<OffDiagonalBlock>& blocks, BlockHessian& hessian) {
    std::vector<std::array<int, 2>> pairs;
    pairs.reserve(blocks.size());
    for (const OffDiagonalBlock& b : blocks) pairs.push_back(pair_of(b));
    const std::vector<int> places = place_blocks(pairs, hessian);
    for (std::size_t k = 0; k < blocks.size(); ++k) hessian.off_diagonal[places[k]].block += blocks[k].block;
}

}  // namespace fettle::core::linear
