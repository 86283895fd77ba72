// SPDX-License-Identifier: MIT
/// A user's own process (tolerances/process.hpp) as a file, NAME.process.json, described by process.schema.json beside this file:
///     {"fettle_process": 1, "units": "mm", "based_on": "fdm", "correlation": 0.5,
///      "features": {"hole": {"bias": -0.18, "tolerance": 0.15}, "pin": {"bias": 0.05, "spread": 0.04}}}
/// The name of the process is the file's. All that it does not say is as in the process that it is based on. `fettle process` makes it of
/// measurements.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "design/tolerances/process.hpp"
#include "design/tolerances/process_fit.hpp"

namespace fettle::design::reading {

/// ".process.json".
extern const std::string process_ending;

/// Errors: the file's, each with its place.
Result<tolerances::Process> read_process(const std::string& path);
/// The same of a text in hand; `path` is the file's name in messages, and the process'.
Result<tolerances::Process> parse_process(const std::string& text, const std::string& path);

/// By a known process' name, or by that of a file: FILE.process.json, or NAME for NAME.process.json; relative ones in `folder` (empty: the
/// working directory). A known name goes before a file's.
/// @param where  The place that names it. Errors: there is none, with the nearest; the file's own.
Result<tolerances::Process> find_process(const std::string& name, const std::string& folder, const std::string& where);

/// What a process that files in `folder` call so is to be called by files in `other`: a path to it, if it is a file.
std::string process_name_from(const std::string& name, const std::string& folder, const std::string& other);

/// A fit as such a file, in millimetres, with what was measured (`measured` of each feature, which nothing reads).
std::string process_text(const tolerances::ProcessFit& fit, const tolerances::Process& fitted, const std::string& based_on);

}  // namespace fettle::design::reading
