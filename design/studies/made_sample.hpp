// SPDX-License-Identifier: MIT
/// One sample of `fettle tolerance` to simulate, look at and measure by itself: the mechanism of number k has the same parts, and moves the
/// same, bit for bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/reading/model_file.hpp"
#include "design/studies/sample_file.hpp"

namespace fettle::design::studies {

struct MadePick {
    int sample = 0;            ///< 0, 1, ...
    std::uint64_t seed = 1;    ///< where there is no file of samples
    std::string samples_file;  ///< whose seed is taken, and which must have the sample; empty: none
    std::string process;       ///< as of `fettle tolerance --process`; empty: the design's
};

struct MadeMechanism {
    reading::LoadedModel loaded;
    std::uint64_t seed = 1;
    std::vector<description::Tolerance> tolerances;
    std::vector<std::string> units;     ///< of the deviations, per tolerance
    VectorX deviations;                 ///< per tolerance, SI
    std::vector<AskedNumber> numbers;   ///< that the design asks for
    std::optional<SampleOutcome> kept;  ///< what the file of samples has of it
};

/// Errors: a file that is no design, or has no tolerances; no such sample; a file of samples that is another design's; those of
/// reading::load_model, and of a mechanism that cannot be made.
Result<MadeMechanism> load_made(const std::string& path, reading::InputOptions options, const MadePick& pick);

}  // namespace fettle::design::studies
