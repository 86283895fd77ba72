// SPDX-License-Identifier: MIT
/// Which files a certificate speaks of, and how it names them: so that they are found whatever folder one works in.
#pragma once

#include <filesystem>
#include <string>

namespace fettle::design::cli {

/// "fit.certificate.json" or "fit.json" -> "fit.trajectory.json".
std::string certificate_trajectory(const std::string& certificate);

/// How a certificate names another file: from its own folder, or by the whole path if that is elsewhere.
std::string name_from_certificate(const std::string& certificate, const std::string& file);

/// Where a file is that a certificate names so.
std::filesystem::path file_of_certificate(const std::string& certificate, const std::string& name);

}  // namespace fettle::design::cli
