// SPDX-License-Identifier: MIT
/// Pairs of bodies that a joint joins: contact does not act between them, and no clearance of theirs is judged unless someone names them.
/// But parts that overlap as they are drawn cannot be made: each such pair is looked at as the bodies are assembled, whatever the question
/// is over, and what no joint between the two explains (model/joint_fit.hpp) is a finding.
#pragma once

#include <string>
#include <vector>

#include "design/clearance/pairs.hpp"
#include "design/clearance/subject.hpp"

namespace fettle::design::clearance {

enum class JoinedFinding {
    clash,      ///< they share material that no joint between them explains
    undecided,  ///< they share material, and it is not known whether a joint explains it: `clearance.reason`; or nothing is proven of them
    explained,  ///< their common part is that of a pin in its bore, or of a ball in its socket
    touching,   ///< faces lie on each other
    apart
};
const char* to_string(JoinedFinding finding);

struct JoinedPair {
    int a = 0, b = 0;
    std::vector<std::string> joints;  ///< their names; none where a trajectory does not tell
    core::clearance::PairClearance clearance;
    JoinedFinding finding = JoinedFinding::undecided;
};

/// In the order of the pairs.
/// @param options  tolerance, and what stops the search
std::vector<JoinedPair> look_at_joined(const Subject& subject, const BodyPairs& pairs, core::clearance::ClearanceOptions options);

/// "j", "the joints j and k", as what joins the two; "a joint" where its name is not known.
std::string joint_text(const JoinedPair& pair);

}  // namespace fettle::design::clearance
