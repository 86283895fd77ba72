// SPDX-License-Identifier: MIT
/// The worth of a certificate: is every claim of it proven (certificate_checker.hpp), is it stale (its path, the scene or design that it
/// was made from, or files of its bodies have changed since), what does it not cover, and do its bounds meet a minimum?
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/records/trajectory_io.hpp"
#include "design/reading/model_file.hpp"

namespace fettle::design::clearance {

struct Claim {
    int a = 0, b = 0;             ///< bodies of the path
    double lower = 0, upper = 0;  ///< [m], of joints met at all times where the certificate has joints
    core::certificate::Solids solids = core::certificate::Solids::unproven;
    std::optional<double> minimum = {};  ///< [m] that the certificate says is required
    std::string doubt = {};  ///< why it need not hold of the bodies that are asked about: then it is undecided; empty: nothing does
};

/// Clear, violated or undecided, of a pair whose claims are proven.
core::clearance::PairStatus verdict(const Claim& claim, double minimum);
/// What a claim is judged by: the minimum that is asked for, else the certificate's own. Nothing: it is not judged.
std::optional<double> minimum_of(const Claim& claim, const std::optional<double>& asked);
/// violated if one is; else undecided if one is; else clear. Nothing: none is judged.
std::optional<core::clearance::PairStatus> worst_of(const std::vector<Claim>& claims, const std::optional<double>& asked);

enum class ExportStatus { same, changed, missing };
/// A file that the certificate says was made of its bodies.
struct CheckedExport {
    std::string file;
    ExportStatus status = ExportStatus::same;
    double rounding = 0;  ///< of its vertices [m]
};

enum class CertificateStatus { accepted, rejected, stale };
const char* to_string(CertificateStatus status);

struct CheckedCertificate {
    CertificateStatus status = CertificateStatus::rejected;
    std::vector<core::certificate::CertificateFault> faults;    ///< none: accepted
    std::optional<core::certificate::Certificate> certificate;  ///< nothing: it cannot be read
    long leaves = 0;                                            ///< of its trees
    std::vector<Claim> claims;
    std::vector<std::array<int, 2>> uncovered;  ///< pairs of bodies
    std::string source;                         ///< with which it was compared; empty: with none
    std::vector<CheckedExport> exports;
    std::vector<std::string> notes;
};

/// A certificate over ranges of joints or tolerances proves something of those that it states itself: of no scene, unless one is at hand
/// that has them. Its claims are in doubt then.
/// @param path    of the certificate
/// @param stored  the path that it is about
/// @param source  the scene or design that it is to be about; empty: the one that it names
CheckedCertificate check_certificate_file(const std::string& path, const core::records::StoredTrajectory& stored,
                                          const reading::InputOptions& input, const std::string& source = {});

}  // namespace fettle::design::clearance
