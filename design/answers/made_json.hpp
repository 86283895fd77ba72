// SPDX-License-Identifier: MIT
/// What `fettle simulate --made` says of the sample that it simulates, as JSON and for people. Keys: docs/interface.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design/studies/made_sample.hpp"

namespace fettle::design::answers {

nlohmann::ordered_json made_json(const studies::MadeMechanism& made, int sample);
std::string made_text(const studies::MadeMechanism& made, int sample);

}  // namespace fettle::design::answers
