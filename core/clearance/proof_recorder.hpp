// SPDX-License-Identifier: MIT
/// Keeps the tree of cells that a search splits, for a certificate (certificate.hpp). Costs nothing when it is off.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "fettle/core/certificate/certificate.hpp"

namespace fettle::core::clearance {

class ProofRecorder {
public:
    ProofRecorder(bool on, std::size_t segments) : on_(on), cells_(on ? segments : 0) {}

    /// The cell of a whole segment; -1 for all cells if off.
    int root(int segment) const { return on_ ? segment : -1; }
    /// By '0' (time), 'a' or 'b': the two new cells, in order.
    std::pair<int, int> split(int cell, char kind) {
        if (!on_) return {-1, -1};
        const int first = count_of(cells_);
        cells_[cell].split = kind;
        cells_[cell].first_child = first;
        cells_.resize(cells_.size() + 2);
        return {first, first + 1};
    }
    void set_plane(int cell, const certificate::LeafPlane& plane) {
        if (on_) cells_[cell].plane = plane;
    }
    /// What was set; not if off.
    certificate::LeafPlane plane(int cell) const { return on_ ? cells_[cell].plane : certificate::LeafPlane{}; }
    /// One proof per segment.
    void write(std::vector<certificate::BoxProof>& proof) const {
        const std::size_t segments = segment_count();
        proof.assign(segments, {});
        for (std::size_t i = 0; i < segments; ++i) write_cells(i, proof[i]);
    }

private:
    struct Cell {
        char split = '.';
        int first_child = -1;
        certificate::LeafPlane plane;
    };
    std::size_t segment_count() const {
        std::size_t count = cells_.size();
        for (const Cell& cell : cells_)
            if (cell.split != '.') count -= 2;
        return count;
    }
    void write_cells(std::size_t root, certificate::BoxProof& proof) const {
        std::vector<std::size_t> pending{root};
        while (!pending.empty()) {
            const Cell& cell = cells_[pending.back()];
            pending.pop_back();
            if (cell.split == '.') {
                add_leaf(proof, cell.plane);
                continue;
            }
            proof.splits += cell.split;
            pending.push_back(static_cast<std::size_t>(cell.first_child) + 1);
            pending.push_back(static_cast<std::size_t>(cell.first_child));
        }
    }

    bool on_;
    std::vector<Cell> cells_;  // roots first
};

}  // namespace fettle::core::clearance
