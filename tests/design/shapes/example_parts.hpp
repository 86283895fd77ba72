// SPDX-License-Identifier: MIT
/// The part files of the examples, by name: "crank" is examples/slider_crank/crank.part.json.
#pragma once

#include <string>
#include <vector>

#include "core/parts/solid_booleans.hpp"

namespace fettle::tests::design_support {

inline const std::vector<std::string>& example_parts() {
    static const std::vector<std::string> names{"block", "crank",   "rod",       "piston",   "base",
                                                "arm",   "coupler", "eccentric", "follower", "guide"};
    return names;
}

inline std::string example_part(const std::string& name) {
    const bool of_engine = name == "block" || name == "crank" || name == "rod" || name == "piston";
    const bool of_linkage = name == "base" || name == "arm" || name == "coupler";
    const std::string folder = of_engine ? "slider_crank" : of_linkage ? "four_bar" : "follower";
    return FETTLE_SOURCE_DIR "/examples/" + folder + "/" + name + ".part.json";
}

/// Block and piston are made by Boolean operations.
inline bool can_be_drawn(const std::string& name) { return core::parts::has_solid_booleans() || (name != "block" && name != "piston"); }

}  // namespace fettle::tests::design_support
