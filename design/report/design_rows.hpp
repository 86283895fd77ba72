// SPDX-License-Identifier: MIT
/// The tables of an optimised design: its requirements, its parameters, and the starts that it is the best of.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design/description/design.hpp"

namespace fettle::design::report {

/// What numbers of this dimension are shown in, as an SI value: lengths in mm, all others in the unit that they are counted in.
double shown_unit(Dimension dimension, double unit);

/// List of {name, unit, lower, upper: what it is judged by, proven: are these two proven, required_lower, required_upper: null where there
/// is none, met, fault: null or text, cost: of the objective per unit, null if not told, counts: is it worth telling, pair: index into the
/// pairs, or null, play_taken_up: the value with the play of the fits taken up, null where not known, in_doubt: is it met as written and
/// not so}; relations follow.
/// @param result  as `fettle optimise` answers (docs/interface.md).
nlohmann::ordered_json requirement_rows(const description::Design& design, const nlohmann::ordered_json& result);

/// List of {name, unit, start, end, lower, upper, held: null or a word of docs/interface.md, step: null, or how far it could move}.
nlohmann::ordered_json parameter_rows(const description::Design& design, const nlohmann::ordered_json& result);

/// List of {seed, status, taken: is it the one that the answer is of, objective: null where there is none, violation, evaluations,
/// distance: of a repair, else null, away: the largest difference of a parameter from the one taken, in its range, null where not known,
/// limits: texts, message}, the best first; empty where there was one start.
nlohmann::ordered_json start_rows(const description::Design& design, const nlohmann::ordered_json& result);

/// The check of resolution: {runs: list of {run: "finer_facets", "finer_steps", failure: null or text, change_of_best: about how much the
/// best objective changes by, null where not known}, rows: list of {name, of: "objective", "term", "constraint", unit, found, finer: list,
/// by run, null in one that failed, change: the largest, as a share, null where not known, met, met_finer: null but for constraints, flips:
/// does it count as met in one and not in the other}}; null where there was no check.
nlohmann::ordered_json resolution_data(const description::Design& design, const nlohmann::ordered_json& result);

}  // namespace fettle::design::report
