// SPDX-License-Identifier: MIT
/// The pairs that `fettle clearance` judges, and its requirements of each: --pairs, --ignore, --group, --minimum, --process.
///   as assembled, or where nothing moves: every pair, whatever types they have, but those of one group of the scene, those that the scene
///   ignores, and those that a joint joins
///   over a motion: every pair of these that may collide; where nothing is dynamic, every pair of which one moves; the others are looked at
///   for a clash only
///   pairs that a joint joins are looked at as assembled alone (joined_pairs.hpp)
///   of a design: those that its objective or its constraints are about too, whatever joins them (design_pairs)
///   --pairs A:B,C:D      bodies or groups by name; `*` stands for any letters (pin*:plate); A:B=0.4mm has a minimum of its own, and of
///                        one without any, where --minimum and --process give none, only the distance is wanted
///   --ignore A:B,...     the same without minimum; order of the two does not matter
///   --allow-touch A:B    they may touch: no minimum applies to them, and a depth above rounding is still a clash; A:B=0.02mm: up to
///                        that depth. A pair that is named so is judged
///   --group name=a,b,c   bodies that are one rigid set: not judged against each other, one row of the report against others
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"
#include "design/description/design.hpp"

namespace fettle::design::clearance {

struct PairOptions {
    std::string pairs, ignore;
    std::vector<std::string> groups, touches;
    std::optional<double> minimum;  ///< [m], per side
    std::string process;            ///< a name or a file (reading/process_file.hpp); `minimum` goes before it, which the report says
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
    std::string required_by;                      ///< "--minimum", "--process fdm" or "--pairs"; empty: only its distance is wanted
    bool may_touch = false;                       ///< that the two touch is accepted
    double touch_depth = 0;                       ///< how deep they may be in each other for that [m]; 0: the default
    bool named = false;                           ///< by name, not by default or by `*`: judged even if dynamics makes them touch
    std::vector<std::pair<int, int>> body_pairs;  ///< to measure; first of a, second of b
};

/// Two bodies by their indices, the lesser first; sorted, each once.
using BodyPairs = std::vector<std::pair<int, int>>;

struct PairSelection {
    std::vector<PairSpec> pairs;
    std::vector<std::string> ignored;               ///< "A:B", on request
    std::vector<PairSpec> left_out;                 ///< neither judged by default nor named: only their clashes are reported
    std::vector<std::string> notes;                 ///< on what is required
    BodyPairs ignored_by_scene, one_group, joined;  ///< not judged for these reasons, though nobody named other pairs
};

/// The bodies whose clearance a design's objective or constraints are about, by themselves or within an expression.
BodyPairs design_pairs(const description::Design& design);

/// What a design requires of two bodies [m].
struct PairMinimum {
    int a = 0, b = 0;  ///< the lesser first
    double minimum = 0;
};
enum class MinimumOver { assembly, motion, ranges };

/// The largest minimum that the design's constraints give each pair of bodies in that scenario, at the parameters' values: of whole bodies
/// (not of faces alone) over the whole motion, over the joints' ranges, or as assembled. Those that follow from parameters count, too.
std::vector<PairMinimum> design_minima(const description::Design& design, int scenario, MinimumOver over);

/// Without any minimum only distances are wanted, and no pair has one.
/// @param moves   over a motion, or over ranges of joints; false: as assembled
/// @param wanted  judged where no pairs are named, and matched by patterns, whatever joins them
/// Errors: names that are not there (with the nearest that is), a pair of a thing with itself, a pair that may touch and is not there, or
/// has a minimum of its own.
Result<PairSelection> select_pairs(const core::model::Model& model, const PairOptions& options, bool moves, const BodyPairs& wanted = {});

/// Are these two judged over a motion when no pairs are named? Those that may collide; where nothing is dynamic, those of which one moves;
/// where nothing moves, all; but never two of one group, nor two that a joint joins.
bool judged_by_default(const core::model::Model& model, int a, int b);

/// "A:B" of each.
std::vector<std::string> pair_names(const std::vector<PairSpec>& pairs);

/// "A:B".
std::string name_of(const core::model::Model& model, const std::pair<int, int>& bodies);
std::vector<std::string> pair_names(const core::model::Model& model, const BodyPairs& pairs);

/// The pairs of bodies that none of the selection's pairs is about; and those of them of which the selection does not say why.
BodyPairs uncovered_pairs(const core::model::Model& model, const PairSelection& selection);
BodyPairs unexplained_pairs(const core::model::Model& model, const BodyPairs& uncovered, const PairSelection& selection);

}  // namespace fettle::design::clearance
