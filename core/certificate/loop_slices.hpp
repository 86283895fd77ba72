// SPDX-License-Identifier: MIT
/// The loops of a pair (toleranced_loop.hpp) over all of their range and all deviations: enclosed slice by slice of what drives each, from
/// the start on to both ends, so that each slice is known to be on the branch of the one before.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/certificate/pair_formulas.hpp"

namespace fettle::core::certificate {

class LoopSlices {
public:
    /// @param base  a point: where the loops' starts hold
    LoopSlices(const PairFormulas& formulas, const ModelledPair& whole, const VariableBox& box, const VariableBox& base);

    /// Why a loop is not known over all of its range; empty: it is.
    const std::string& fault() const { return fault_; }
    /// Sets the positions of the loops' unknowns over a part of the box. false: one is not enclosed there.
    bool enclose(const VariableBox& part, const ModelledPair& models, std::vector<TaylorModel>& positions) const;

private:
    /// A loop over a part of what drives it, and all deviations.
    struct Slice {
        double low = 0, high = 0;
        LoopEnclosure found;
    };
    std::optional<LoopEnclosure> over(std::size_t loop, double low, double high, const std::vector<double>& guess) const;
    bool slice(std::size_t loop, const VariableBox& base);
    bool extend(std::size_t loop, bool upwards);

    const PairFormulas& formulas_;
    const ModelledPair& whole_;
    VariableBox box_;
    std::vector<std::vector<Slice>> slices_;  // of each loop, upwards
    std::string fault_;
};

}  // namespace fettle::core::certificate
