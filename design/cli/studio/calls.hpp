// SPDX-License-Identifier: MIT
/// What a window can ask for, as JSON: set, undo, redo, reset, pull, tune, stop, save, export, pose. Keys: docs/studio.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "design/session/session.hpp"

namespace fettle::design::cli::studio {

/// An answer with its HTTP status: {"done": true, ...}, or {"error": sentence}.
struct CallAnswer {
    int status = 200;
    nlohmann::ordered_json json;
};

/// Files are written in the folder of the session's own file alone.
/// @param evaluation  of the newest values that have one: what is exported; null: there is none yet
CallAnswer answer_call(session::Session& session, const nlohmann::ordered_json& call,
                       const std::shared_ptr<const problem::DesignEvaluation>& evaluation);

}  // namespace fettle::design::cli::studio
