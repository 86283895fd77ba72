// SPDX-License-Identifier: MIT
/// The verdict on an audit of gradients (gradient_audit/difference_check.hpp), in words. What to do about each: docs/recipes.md.
#pragma once

#include <string>
#include <vector>

#include "fettle/design/gradient_audit/difference_check.hpp"

namespace fettle::design::answers {

/// Why a check fails, a clause for each cause: it was interrupted; parameters could not be checked; the derivatives taken backwards and
/// forwards differ, or could not be compared; gradients and differences disagree, for a parameter or along the gradient; quantities have a
/// kink; noise hides more than the limit. Empty: the check passes.
/// @param limit  Largest relative error that passes. Contract: > 0
std::vector<std::string> check_faults(const gradient_audit::CheckReport& report, double limit);

/// "check passed (limit 1e-05)", or "check FAILED: " with all causes; that all differences agree is said where they do.
std::string verdict_text(const gradient_audit::CheckReport& report, double limit);

}  // namespace fettle::design::answers
