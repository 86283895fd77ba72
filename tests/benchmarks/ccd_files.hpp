// SPDX-License-Identifier: MIT
/// What ccd_benchmark does with files: ground-truth queries of continuous collision detection (tests/support/ccd_queries.hpp), their hits,
/// misses, false alarms and times, per file and in all.
#pragma once

namespace fettle::tests::benchmarks {

/// The arguments of main. Prints a table, or with --json one object: `status` ("ok", "missed", "error"), `queries`, `queries_with_truth`,
/// `truth_hits`, `hits`, `false_negatives`, `false_positives`, `mean_microseconds`, `median_microseconds`, `worst_microseconds`, `method`,
/// `deviation`, `minimum_separation`, `tolerance`, `missed` (first 100: `file`, `query`), `files` (list of `file`, `kind` "linear" or
/// "rigid", and the counts and times). Counts of truth are null where a file has none.
/// @return  exit code: 0; 1, a contact was missed; 3, bad input or usage.
int run_ccd_files(int count, char** words);

}  // namespace fettle::tests::benchmarks
