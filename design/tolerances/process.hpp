// SPDX-License-Identifier: MIT
/// The effect of a process of manufacturing on a feature: how far it comes out from the drawing, by kind and size. Those that fettle knows:
/// known_processes.hpp; a user's own: design/reading/process_file.hpp.
///
/// A feature of nominal size d (a diameter, a width, a thickness, a length; never a radius) comes out at d + b + e,
///   b = bias + bias_per_size d                 of all features of this kind and size; d within the sizes `from` to `up_to`: beyond,
///                                              the bias of the nearest of them
///   |e| <= t nearly always: t is three standard deviations of a normal e, whose mean is 0;
///       t = tolerance;   of sizes over `per_size_over`, max(tolerance, tolerance_per_size d)
/// A process with a `general_class` has the limits of ISO 2768-1 (iso2768.hpp) for t.
/// An angle has no size. Between legs whose shorter one is d, each as straight as a length is exact, it is off by t / d, t of a length d.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "design/tolerances/deviation_limits.hpp"

namespace fettle::design::tolerances {

enum class FeatureKind {
    hole,    ///< diameter of a hole or bore
    pin,     ///< diameter of a pin or boss
    slot,    ///< width of a slot, a groove
    gap,     ///< distance between two walls that are made at once
    wall,    ///< thickness of a wall or rib
    length,  ///< any other: sides of a part, distances of holes
    height,  ///< along the direction in which the part is built
    angle
};
inline constexpr std::array<FeatureKind, 8> feature_kinds{FeatureKind::hole, FeatureKind::pin,    FeatureKind::slot,   FeatureKind::gap,
                                                          FeatureKind::wall, FeatureKind::length, FeatureKind::height, FeatureKind::angle};

const char* to_string(FeatureKind kind);
std::optional<FeatureKind> feature_kind(std::string_view name);
/// Those of the list, for messages and choices.
std::vector<std::string_view> feature_kind_names();

struct FeatureSpread {
    FeatureKind kind = FeatureKind::length;
    double bias = 0;                                                   ///< [m]
    double bias_per_size = 0;                                          ///< [1]
    double tolerance = 0;                                              ///< [m], at least 0
    double tolerance_per_size = 0;                                     ///< [1], at least 0
    double per_size_over = 0;                                          ///< [m], at least 0: published limits jump there
    std::string general_class = {};                                    ///< of ISO 2768-1: "m"; then the three before are 0
    double from = 0, up_to = std::numeric_limits<double>::infinity();  ///< sizes for which the bias is known [m]
    std::string source = {};                                           ///< whose figures these are, and what is uncertain
    std::optional<double> correlation = {};                            ///< of this kind, in place of the process'
};

/// How far a face of a part may lie off its drawing, by the part's size.
struct SizeBand {
    double up_to = 0;      ///< largest part size [m], inclusive
    double tolerance = 0;  ///< of one part, per side [m]
    std::string source;
};

/// What two parts that move need between them (process_clearance.hpp).
struct ClearanceNeed {
    double minimum = 0;  ///< per side [m]
    std::string source;
    std::vector<SizeBand> bands;  ///< none: half of what a length of the part's size may be off by
    /// Names the known process whose `minimum`, whose `bands` a user's process still has; empty: its own.
    std::string minimum_of = {}, bands_of = {};
};

struct Process {
    std::string name;         ///< "fdm"
    std::string description;  ///< "filament"
    /// The share of the variance of e that features of one kind in one print have in common [1], 0 to 1.
    double correlation = 0;
    std::vector<FeatureSpread> features;  ///< at most one of a kind, none of angle
    std::optional<ClearanceNeed> clearance;
};

/// Null: the process says nothing of this kind.
const FeatureSpread* find_feature(const Process& process, FeatureKind kind);

struct ProcessDeviation {
    DeviationLimits limits;    ///< b - t to b + t [m]; of an angle [rad]
    bool is_sure_size = true;  ///< false: beyond the sizes for which the bias is known
};

/// @param size  Nominal size [m], of an angle its shorter leg. Errors: not over 0 (out_of_range), not finite; a kind that the process says
///              nothing of (unsupported), with those of which it does; a size that the general class does not cover (out_of_range).
Result<ProcessDeviation> process_deviation(const Process& process, FeatureKind kind, double size, const std::string& where);

/// What the features of one print share, as a group of tolerances (studies/independent_inputs.hpp): too much material makes pins and walls
/// larger, and holes, slots and gaps smaller, by one number; lengths, by how the material shrinks, by another; heights by a third.
struct SharedPart {
    std::string group;       ///< empty: nothing is shared
    double correlation = 0;  ///< negative of holes, slots and gaps
};
SharedPart shared_part(const Process& process, FeatureKind kind);

}  // namespace fettle::design::tolerances
