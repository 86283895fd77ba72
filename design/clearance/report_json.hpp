// SPDX-License-Identifier: MIT
/// The answer of `fettle clearance --json`, and what `simulate` answers of the proof of its path.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "design/clearance/path_proof.hpp"
#include "design/clearance/report.hpp"

namespace fettle::design::clearance {

/// Keys: docs/interface.md. SI.
nlohmann::ordered_json report_json(const ClearanceReport& report, const Subject& subject);

/// {certify_seconds, minimum_distance, certification}, and of a proof that was stopped {certified_steps, certified_distance}.
/// @param seconds  that the proof took
nlohmann::ordered_json proof_json(const PathProof& proof, double seconds);

}  // namespace fettle::design::clearance
