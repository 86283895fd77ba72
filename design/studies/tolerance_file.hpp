// SPDX-License-Identifier: MIT
/// The tolerances of a design file, studied and allocated: what `fettle tolerance` and Python's `tolerance` do.
#pragma once

#include <string>

#include "design/reading/design_reader.hpp"
#include "design/studies/allocation.hpp"
#include "design/studies/tolerance_study.hpp"

namespace fettle::design::studies {

/// Why a design without tolerances cannot be studied.
Error no_tolerances(const reading::DesignFile& file);

/// The header of a file of its samples. @param design  As made, `file.design` or what has become of it.
SampleFileHeader samples_header(const reading::DesignFile& file, const description::Design& design, std::uint64_t seed);

/// @param file          Read as made (reading::DesignReadOptions::as_made).
/// @param samples_file  Where the samples are kept (sample_file.hpp); empty: nowhere. `options.file` is set by it.
/// Errors: no tolerances, the design's (DesignProblem::create), the samples' file.
Result<ToleranceReport> study_tolerances(const reading::DesignFile& file, const std::string& samples_file, ToleranceOptions options);

/// The same of what allocates them. Errors: no tolerances, the design's.
Result<AllocationReport> allocate(const reading::DesignFile& file, const AllocationOptions& options);

}  // namespace fettle::design::studies
