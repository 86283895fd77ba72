// SPDX-License-Identifier: MIT
/// The results of an exploration as a file of lines, so that it can be stopped, killed, and gone on with. docs/interface.md has the format:
/// a header line (fettle_explore 1, program, design, parameters, file), then one JSON object per result, in any order.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "design/description/design.hpp"
#include "design/studies/line_file.hpp"

namespace fettle::design::studies {

/// What a file of an exploration holds.
struct Exploration {
    nlohmann::ordered_json header;
    std::vector<nlohmann::ordered_json> results;
    Errors damaged;        ///< lines that are no results, which are left out: where, and why
    bool cut_off = false;  ///< the last line is a part of one, left out too

    /// Indices of the results that meet every requirement, the least objective first.
    std::vector<std::size_t> best() const;
};

/// Errors: file_not_found, file_unreadable, a file that is no exploration (missing_key).
Result<Exploration> read_exploration(const std::string& path);

/// @param name  of the design: the same for the same design (reading::design_hash)
/// @param file  the design's, relative to that of the results; empty: it has none
nlohmann::ordered_json header_of(const description::Design& design, const std::string& name, const std::string& file);

/// The file, open and locked, to which results are added.
class ExplorationFile {
public:
    /// Goes on with a file that is there. Errors: it is no exploration (parse), one of another design (inconsistent), has a damaged line,
    /// those of LineFile::open.
    static Result<ExplorationFile> open(const std::string& path, const nlohmann::ordered_json& header);
    /// A file that was made by this, and has got no result, is taken away.
    ~ExplorationFile();
    ExplorationFile(ExplorationFile&& other) noexcept;
    ExplorationFile& operator=(ExplorationFile&&) = delete;

    /// Is there a result of the job with that key, other than that it was lost?
    bool has(const std::string& key) const { return keys_.count(key) != 0; }
    void append(nlohmann::ordered_json result);
    Errors unwritten() const { return lines_.unwritten(); }
    /// All that it has, with what was appended.
    const Exploration& found() const { return found_; }
    const std::string& path() const { return path_; }

private:
    ExplorationFile(LineFile lines, std::string path) : lines_(std::move(lines)), path_(std::move(path)) {}
    void take(nlohmann::ordered_json result);

    LineFile lines_;
    std::string path_;
    bool is_new_ = false;  ///< was it made by this?
    Exploration found_;
    std::unordered_set<std::string> keys_;
};

}  // namespace fettle::design::studies
