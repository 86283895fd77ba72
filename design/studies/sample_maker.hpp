// SPDX-License-Identifier: MIT
/// The samples of a design's tolerances one by one, for those who share them out among processes and machines: each is the same, bit for
/// bit, as study_tolerances makes it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/sample_file.hpp"

namespace fettle::design::studies {

class SampleMaker {
public:
    /// @param file  Read as made. Errors: no tolerances, the design's.
    static Result<SampleMaker> create(reading::DesignFile file, std::uint64_t seed);

    const SampleFileHeader& header() const { return header_; }
    /// What sample k comes to, as a line of a file of samples; empty: interrupted.
    std::string line_of(int sample, const std::function<bool()>& should_stop) const;

private:
    SampleMaker() = default;

    std::shared_ptr<const reading::DesignFile> file_;
    std::shared_ptr<const problem::DesignProblem> problem_;
    SampleFileHeader header_;
};

}  // namespace fettle::design::studies
