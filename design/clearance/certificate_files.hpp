// SPDX-License-Identifier: MIT
/// Which files a certificate is about, and how it names them: so that they are found whatever folder one works in.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/certificate/certificate.hpp"

namespace fettle::design::clearance {

/// "fit.certificate.json" or "fit.json" -> "fit.trajectory.json".
std::string certificate_trajectory(const std::string& certificate);

/// How a certificate names another file: from its own folder, or by the whole path if that is elsewhere.
std::string name_from_certificate(const std::string& certificate, const std::string& file);

/// Where a file is that a certificate names so.
std::filesystem::path file_of_certificate(const std::string& certificate, const std::string& name);

/// The files as a certificate names them, relative to its folder where they lie below it. Errors: a file that cannot be read.
Result<std::vector<core::certificate::ExportedFile>> named_files(const std::vector<std::string>& files, const std::string& certificate);

}  // namespace fettle::design::clearance
