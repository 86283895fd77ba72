// SPDX-License-Identifier: MIT
/// The verdict on an audit of gradients (gradient_audit/difference_check.hpp), in words. What to do about each: docs/recipes.md.
#pragma once

#include <string>
#include <vector>

#include "design/gradient_audit/difference_check.hpp"

namespace fettle::design::answers {

enum class CheckVerdict {
    passed,
    failed,     ///< derivatives were measured that do not agree
    undecided,  ///< nothing speaks against the gradients, but not all of it could be measured
};

/// Contract: limit > 0, the largest relative error that passes.
CheckVerdict check_verdict(const gradient_audit::CheckReport& report, double limit);

/// Why a check does not pass, a clause for each cause. It is undecided by these: it was interrupted; parameters could not be checked;
/// derivatives taken backwards and forwards could not be compared; noise hides more than the limit. It fails by these: the latter differ;
/// gradients and differences disagree, for a parameter or along the gradient; at a kink, a gradient lies outside the slopes of both sides.
/// Empty: the check passes. A kink at which it lies between them is no fault: what is searched there is still downhill of one side.
std::vector<std::string> check_faults(const gradient_audit::CheckReport& report, double limit);

/// "check passed (limit 1e-05)", "check FAILED: " or "check undecided: " with all causes, what the differences that could be measured
/// say, and where there are kinks.
std::string verdict_text(const gradient_audit::CheckReport& report, double limit);

}  // namespace fettle::design::answers
