// SPDX-License-Identifier: MIT
/// What all rows of the scenes benchmark come to: as JSON, and as a table for people.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmarks/reference_table.hpp"
#include "tests/benchmarks/scene_run.hpp"

namespace fettle::tests::benchmarks {

/// Ratios of times, larger is better.
class Ratios {
public:
    /// @param counts_for_worst  false: for the mean alone
    void add(double ratio, const std::string& scene, bool counts_for_worst = true);
    int count() const { return count_; }
    /// "NAME": {"geometric_mean", "worst", "worst_scene", "scenes"}; the worst is null if none counts for it.
    std::string json(const std::string& name) const;

private:
    double log_sum_ = 0, worst_ = 0;
    std::string worst_scene_;
    int count_ = 0;
};

/// "KEY": VALUE, five digits.
std::string member(const std::string& key, double value);

/// How many times as fast as the reference the whole program was; 0 where either is not known.
double reference_ratio(const ReferenceRun* reference, const SceneRow& row);

/// Members of the summary, as JSON text without braces, of rows run with one thread: `against_reference` (the whole program),
/// `against_reference_above_a_second` (where the reference takes more), `certification` (its time over that of stepping: the largest, of
/// scenes that are stepped for more than 0.05 s, and all together).
std::string summary_json(const std::vector<SceneRow>& rows, const std::vector<ReferenceRun>& references);

/// The same in brief, for people, on stderr.
void print_table(const std::vector<SceneRow>& rows, const std::vector<ReferenceRun>& references);

/// How cost grows with size: of the whole program per body and step, and per body and contact, the first row's being 1; of stepping per
/// contact. One JSON line per row.
void print_growth(const std::vector<SceneRow>& rows);

}  // namespace fettle::tests::benchmarks
