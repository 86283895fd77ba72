// SPDX-License-Identifier: MIT
/// Which trajectory a certificate's file speaks of: the one beside it.
#pragma once

#include <string>

namespace fettle::design::cli {

/// "fit.certificate.json" or "fit.json" -> "fit.trajectory.json".
std::string certificate_trajectory(const std::string& certificate);

}  // namespace fettle::design::cli
