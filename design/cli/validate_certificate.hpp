// SPDX-License-Identifier: MIT
/// fettle validate CERTIFICATE: is every claim of it proven? A checker of its own judges (certificate_checker.hpp).
#pragma once

#include <string>

#include "fettle/design/cli/session.hpp"

namespace fettle::design::cli {

struct CertificateQuestion {
    std::string path;        ///< of the certificate
    std::string trajectory;  ///< the path that it speaks of; empty: the one beside it
};

/// Answers "accepted" or "rejected", with every fault; returns the exit code.
int validate_certificate(const CertificateQuestion& question, Console& console);

}  // namespace fettle::design::cli
