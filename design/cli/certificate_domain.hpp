// SPDX-License-Identifier: MIT
/// What a certificate is about beside its bodies: which positions of which joints, which tolerances, how long a motion. A proof is worth
/// what it is a proof of: limits that are narrower than those that one has in mind prove less.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

#include "core/base/rounded_lengths.hpp"
#include "core/certificate/certificate.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::design::cli {

/// "over all positions of the joints, within tolerances".
const char* domain_name(const core::certificate::Certificate& certificate);

/// {over, joints [{joint, low, high, unit, whole_turn}], tolerances [{of, lower, upper}], duration, steps}, SI; what does not apply is left
/// out. Any certificate that can be read has it, whether or not it is sound.
nlohmann::ordered_json domain_json(const core::certificate::Certificate& certificate, const core::stepper::Trajectory& trajectory);

/// "tolerances: pin_radius -0.05 to +0.05 mm\njoints: elbow -50 to 30 deg\n"; of a motion how long it is.
std::string domain_text(const core::certificate::Certificate& certificate, const core::stepper::Trajectory& trajectory,
                        const core::base::RoundedLengths& lengths);

}  // namespace fettle::design::cli
