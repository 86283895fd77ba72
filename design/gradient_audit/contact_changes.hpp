// SPDX-License-Identifier: MIT
/// Which contacts of a design are about to change: found by simulations on both sides of it, by comparing what is in contact at each step.
/// Nothing is extrapolated: a change is known to lie between the largest simulated move that does not show it and the least that does.
/// What it means for gradients (docs/method/design.md#checking-gradients): where closest features change, or edges become nearly parallel,
/// forces are continuous and their derivatives are not, so that gradients jump; where bodies come to touch, part, slide or stick, gradients
/// are continuous, and change fast.
#pragma once

#include <string>
#include <vector>

#include "design/gradient_audit/contact_states.hpp"

namespace fettle::design::gradient_audit {

enum class ContactEvent {
    touch,         ///< features that were out of each other's reach (dhat + dmin) are in it
    part,          ///< and the other way round
    new_features,  ///< what is nearest lies on a neighbouring face, edge or vertex
    parallel,      ///< edges become nearly parallel, so that their contact begins to fade out
    crossing,      ///< and the other way round
    slide,         ///< faster than eps_v
    stick,         ///< slower
};
/// "touch", "part", "new_features" ...
const char* to_string(ContactEvent event);
/// Do derivatives jump there?
bool is_kink(ContactEvent event);

/// One contact at one step that is another after a move.
struct ContactDifference {
    ContactEvent event = ContactEvent::touch;
    int step = 0;          ///< at whose end
    ContactState was, is;  ///< the same but for new_features, `parallel`, `slide` and their like
    bool others = false;   ///< the two touch elsewhere too: before they begin to here, or after they have parted here
};

/// From one simulation's contacts to another's, step by step; no more steps than both have.
std::vector<ContactDifference> contact_differences(const std::vector<std::vector<ContactState>>& from,
                                                   const std::vector<std::vector<ContactState>>& to);

/// The nearest change of one sort between two bodies as one parameter moves to one side.
struct ContactChange {
    std::string parameter;
    double from = 0, to = 0;     ///< moves of the parameter [SI, signed]: none such at the one, one at the other
    double share = 0;            ///< |to| in the parameter's range
    ContactDifference at;        ///< the earliest, at `to`
    std::string body_a, body_b;  ///< their names
    double time = 0;             ///< of the step's end [s]
    int count = 1;               ///< contacts that change so at `to`, all steps together
    std::string scenario = {};   ///< of the design, its name; empty: it has none
};

/// Collects what simulations at several moves of one parameter to one side show.
class ContactWatch {
public:
    /// @param contacts  The contacts of the design itself. Contract: outlives this.
    explicit ContactWatch(const std::vector<std::vector<ContactState>>& contacts) : contacts_(&contacts) {}

    /// @param share  The move's size in the parameter's range. Contract: > 0.
    void add(double share, const core::model::Model& model, const core::stepper::Trajectory& trajectory);

    /// The farthest move; 0: none.
    double reach() const { return moves_.empty() ? 0 : moves_.back().share; }

    /// By bodies and sort of change. @param side  1 or -1; @param range  of the parameter [SI]
    std::vector<ContactChange> changes(const std::string& parameter, double side, double range, const core::model::Model& model,
                                       const core::stepper::Trajectory& trajectory) const;

private:
    struct Move {
        double share = 0;
        std::vector<ContactDifference> differences;
    };
    const std::vector<std::vector<ContactState>>* contacts_;
    std::vector<Move> moves_;
};

/// "at t = 0.35 s 'pin' and 'slot' begin to touch, a vertex of 'pin' on a face of 'slot', near (1, 2, 3) mm".
std::string sentence_of(const ContactChange& change);

}  // namespace fettle::design::gradient_audit
