// SPDX-License-Identifier: MIT
/// The samples of made mechanisms as a file, so that they can be made in several goes, and by several machines: a header line, then one
/// JSON object per sample, in any order. Doubles are written so that they read back bit for bit.
///   header   fettle_samples 1, design (hash of what the file says), program, seed, tolerances (of, and their distributions, which a
///   process
///            may give), responses (names)
///   sample   sample (0, 1, ...), reason (why it failed; there: no others), values (SI, per response), met (booleans, per response)
/// The deviations of a sample follow from seed and number.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "design/studies/line_file.hpp"
#include "design/studies/made_responses.hpp"

namespace fettle::design::studies {

struct SampleFileHeader {
    std::string design_hash;  ///< reading::design_hash
    std::uint64_t seed = 1;
    std::vector<description::Tolerance> tolerances;
    std::vector<std::string> responses;
};

/// What a sample came to.
struct SampleOutcome {
    VectorX values;         ///< per response, SI; empty: it could not be made or simulated
    std::vector<bool> met;  ///< per response
    std::string reason;     ///< why it could not
    bool failed() const { return values.size() == 0; }
};

/// The first line of a file of these samples: the same for the same samples, wherever they are made.
std::string header_line(const SampleFileHeader& header);
/// The line of sample k, which says it bit for bit.
std::string sample_line(int sample, const SampleOutcome& outcome);

/// What a file of samples holds.
struct KeptSamples {
    std::uint64_t seed = 1;
    std::map<int, SampleOutcome> outcomes;  ///< by their numbers
};
/// For those who add none. @param header  that it must have, but for the seed.
/// Errors: as of SampleFile::open; a file that is not there or is empty.
Result<KeptSamples> read_samples(const std::string& path, const SampleFileHeader& header);

class SampleFile {
public:
    /// Errors: a file of other samples (inconsistent), a damaged line other than the last (parse), those of LineFile::open.
    static Result<SampleFile> open(const std::string& path, const SampleFileHeader& header);

    /// What is there of sample k; null: nothing.
    const SampleOutcome* find(int sample) const;
    void append(int sample, const SampleOutcome& outcome);
    /// A sample_line that another process made. Errors: it is none of these samples (parse).
    Errors append_line(const std::string& line);
    Errors unwritten() const { return file_.unwritten(); }

private:
    SampleFile(LineFile file, const SampleFileHeader& header) : file_(std::move(file)), header_(header) {}
    Errors read_found(const std::string& path);

    LineFile file_;
    SampleFileHeader header_;
    std::map<int, SampleOutcome> known_;
};

}  // namespace fettle::design::studies
