// SPDX-License-Identifier: MIT
/// Whom a simulation, and its proof, leave out: pairs of bodies that pass through each other freely, and why.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/model/model.hpp"

namespace fettle::design::clearance {

struct LeftOut {
    std::vector<std::pair<std::string, std::vector<std::string>>> joined;  ///< "a:b", and the joints between the two
    std::vector<std::string> ignored;                                      ///< "a:b", by the scene
    std::vector<std::vector<std::string>> groups;                          ///< bodies of each group of several
    std::vector<std::string> not_dynamic;  ///< if they are several: static and kinematic bodies, which never push each other

    bool empty() const { return joined.empty() && ignored.empty() && groups.empty() && not_dynamic.empty(); }
};
LeftOut left_out_of_contact(const core::model::Model& model);

/// "left out: crank:frame (joined by main), a:b (ignored by the scene)", one line; empty if nobody is.
std::string left_out_text(const LeftOut& left_out);
/// Keys as the members'; those that are empty are absent.
nlohmann::ordered_json left_out_json(const LeftOut& left_out);

}  // namespace fettle::design::clearance
