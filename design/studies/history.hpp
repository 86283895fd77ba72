// SPDX-License-Identifier: MIT
/// The history of an optimisation: DIR/history.jsonl, a header line, then one JSON object per evaluation, appended and flushed to the disk
/// as it happens. Doubles are written so that they read back bit for bit. A resumed run is the same run again, its evaluations answered
/// from here; since the optimisers are deterministic it goes on where the killed one stopped and ends with the same design.
///   header      fettle_history 1, design (hash of all that an evaluation depends on), program, parameters, constraints (names)
///   evaluation  evaluation (1, 2, ...), model (a smoother one's name; not there: the file's own), usable, reason, parameters (by name,
///               SI), objective, constraints (as the search sees them; `measured` beside them, where some go on beyond it), gradient and
///               jacobian (rows; not of values alone), residuals and residual_jacobian (rows; where the objective has squared deviations),
///               constraint_branches and objective_branches (of, values, jacobian by rows; where there are any: optimisers/problem.hpp),
///               violation, terms (by name), certified (lower bounds by constraint, of those that are proven), forward_seconds,
///               backward_seconds
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "design/optimisers/problem.hpp"
#include "design/studies/line_file.hpp"

namespace fettle::design::studies {

struct HistoryHeader {
    std::string design_hash;  ///< of everything that an evaluation's numbers depend on, the program's version included
    std::vector<std::string> parameters, constraints;
};

struct HistoryEntry {
    std::string model;  ///< a smoother model's name; empty: the design's own
    VectorX point;
    optimisers::Evaluation evaluation;
    std::vector<std::pair<std::string, double>> terms;      ///< of the objective, for people
    std::vector<std::pair<std::string, double>> certified;  ///< proven lower bounds, for people
    double forward_seconds = 0, backward_seconds = 0;
};

/// What is damaged in the text of a history, whose last line is whole, by itself: with the line's number (parse). None in an empty one.
Errors history_faults(const std::string& text, const std::string& path);

class History {
public:
    /// Errors: a history of another design (inconsistent), a damaged line other than the last (parse), those of LineFile::open.
    static Result<History> open(const std::string& directory, const HistoryHeader& header, LineFileMode mode);

    /// What an earlier run left, in its order.
    const std::vector<HistoryEntry>& replayed() const { return replayed_; }

    /// Writes one line and waits until it is on the disk. What cannot be written (a full disk) is kept, and tried again with the next.
    void append(const HistoryEntry& entry);

    /// Why what was appended is not all on the disk (file_unwritable); nothing where it is.
    Errors unwritten() const { return file_.unwritten(); }

    /// Name of the file that `fresh` renamed away; empty if there was none.
    const std::string& kept_as() const { return file_.kept_as(); }

private:
    History(LineFile file, const HistoryHeader& header) : file_(std::move(file)), header_(header) {}
    Errors read_existing(const std::string& path);

    LineFile file_;
    int entries_ = 0;
    HistoryHeader header_;
    std::vector<HistoryEntry> replayed_;
};

enum class Recorded { with_derivatives, values };

/// Wraps an evaluation: a point that the history has of this model (by the bits of its coordinates, with derivatives or without as
/// `wanted`) is answered from it, others are computed by `evaluate` and appended. The history must outlive the function.
std::function<optimisers::Evaluation(const VectorX&)> recorded(History& history, std::function<HistoryEntry(const VectorX&)> evaluate,
                                                               const std::string& model = {}, Recorded wanted = Recorded::with_derivatives);

}  // namespace fettle::design::studies
