// SPDX-License-Identifier: MIT
/// Which pairs `fettle clearance` judges and what it requires of each: --pairs, --ignore, --group, --minimum, --process.
///   --pairs A:B,C:D      bodies or groups by name; `*` stands for any letters (pin*:plate); A:B=0.4mm has a minimum of its own
///   --ignore A:B,...     the same without minimum; order of the two does not matter
///   --group name=a,b,c   bodies that are one rigid set: not judged against each other, one row of the report against others
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::design::cli {

struct PairOptions {
    std::string pairs, ignore;
    std::vector<std::string> groups;
    std::optional<double> minimum;  ///< [m], per side
    std::string process;            ///< a preset (process_presets.hpp); `minimum` goes before it
};

/// A body, or a group.
struct Unit {
    std::string name;
    std::vector<int> bodies;
    bool is_group = false;
};

struct PairSpec {
    Unit a, b;
    double minimum = 0;                           ///< [m]
    std::string required_by;                      ///< "--minimum", "--process fdm" or "--pairs"
    bool named = false;                           ///< by name, not by default or by `*`: judged even if dynamics makes them touch
    std::vector<std::pair<int, int>> body_pairs;  ///< to measure; first of a, second of b
};

struct PairSelection {
    std::vector<PairSpec> pairs;
    std::vector<std::string> ignored;   ///< "A:B"
    std::vector<std::string> left_out;  ///< neither judged by default nor named, though one of them moves
};

/// Errors: names that are not there (with the nearest that is), a pair of a thing with itself, no minimum for a pair.
Result<PairSelection> select_pairs(const core::model::Model& model, const PairOptions& options);

}  // namespace fettle::design::cli
