// SPDX-License-Identifier: MIT
/// fettle validate CERTIFICATE: is every claim of it proven? A checker of its own judges (certificate_checker.hpp). Told beside that: what
/// it is about (certificate_domain.hpp), which pairs of bodies it does not cover, whether it is stale (its trajectory, or the meshes of the
/// scene or design that it names, have changed since), and whether its bounds meet a minimum: that which is asked for, else those that it
/// states itself.
#pragma once

#include <string>

#include "design/cli/command.hpp"

namespace fettle::design::cli {

struct CertificateQuestion {
    std::string path;        ///< of the certificate
    std::string trajectory;  ///< the path that it is about; empty: the one beside it
    std::string source;      ///< the scene or design that it is to be about; empty: the one that it names
    std::string minimum;     ///< required clearance of all pairs, "0.3mm"; empty: those that the certificate states, if any
};

/// Answers "accepted", "rejected" or "stale", with every fault; returns the exit code: 1 where it is not accepted or a pair is violated, 2
/// where one is undecided.
int validate_certificate(const CertificateQuestion& question, const CommonOptions& common, Console& console);

}  // namespace fettle::design::cli
