// SPDX-License-Identifier: MIT
/// What a session tells, as the studio's page and agents take it: one JSON object for each piece of news, lengths in mm, parameters in
/// their own units, arrays of numbers as report/packed_numbers.hpp has them. Keys: docs/studio.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "design/session/posing.hpp"
#include "design/session/session.hpp"

namespace fettle::design::session {

/// How the news are called there: "opened", "fault", "asked", "progress", "refused", "numbers", "gradient", "pairs", "settled", "tune".
/// What is measured has two: the motion, "motion", and the values.
struct ToldNews {
    std::string name;
    nlohmann::ordered_json data;
};

/// Distances over the motion are certified here; of news that become stale meanwhile the rest is left out.
std::vector<ToldNews> told(const News& news);

/// Joints that can be moved by hand: {name, unit, start, low, high, has_limits, moves: names of bodies}, in mm and deg.
nlohmann::ordered_json handles_json(const Posing& posing);
/// {poses f32 of all bodies (moving_parts.hpp), pairs: rows (pair_rows.hpp) of the nearest}
nlohmann::ordered_json posed_json(const Posed& posed, const core::model::Model& model);
/// What a handle's number is in, in SI.
double unit_of(const JointHandle& handle);

/// Values by parameter, SI. Errors: what is no number.
Result<Session::Values> values_from(const nlohmann::ordered_json& values, const Opened& opened);

/// One of the unit that a quantity is shown in, in SI: of a requirement or "objective". 1 where there is no such quantity.
double shown_unit_of(const description::Design& design, const std::string& name);

}  // namespace fettle::design::session
