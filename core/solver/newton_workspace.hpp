// SPDX-License-Identifier: MIT
/// Scratch memory of the solver (newton.hpp), and the clock of its phases.
#pragma once

#include <optional>

#include "core/base/phase_clock.hpp"
#include "core/ccd/candidates.hpp"
#include "core/contact/contact_set.hpp"
#include "core/linear/linear_system.hpp"
#include "core/solver/row_system.hpp"

namespace fettle::core::solver {

/// What a solve spends its time on.
enum class SolvePhase {
    broad_phase,   ///< candidates
    contacts,      ///< which candidates are in contact, and their distances
    derivatives,   ///< gradient and Hessian
    linear_solve,  ///< factorisation and solve
    ccd,           ///< longest safe steps
    potential,     ///< values for the line search
    count
};
const char* to_string(SolvePhase phase);

/// Contacts, and where all bodies are when these are the contacts.
struct KnownContacts {
    std::vector<kinematics::Pose> poses;  ///< empty: none known
    contact::ContactSet contacts;
};

/// Things worth keeping from one solve to the next; the result of a solve depends on them by no more than its tolerance.
struct NewtonWorkspace {
    linear::LinearSystem system;          ///< its symbolic factor
    ccd::Candidates candidates;           ///< near where the last solve ended
    contact::ContactPlans contact_plans;  ///< how their contacts were counted last
    KnownContacts contacts;               ///< where the last step ended
    std::optional<RowSystem> rows;        ///< of a model with joints or motors; the last multipliers
    bool slides = false;                  ///< most of what friction acts on, at the end of the last solve
    base::PhaseClock<SolvePhase> clock;
    explicit NewtonWorkspace(const model::Model& model) : system(free_dofs(model)) {
        if (!model.mechanism.rows.empty()) rows.emplace();
    }

    const linear::FreeDofs& dofs() const { return system.dofs(); }

    /// All that the next solve's bits could depend on.
    void forget() {
        candidates = {};
        slides = false;
        if (rows) rows->forget_multipliers();
    }

    /// Factorises the Hessian, or the saddle-point system that the rows make of it. @return false: it is not positive definite (on the
    /// rows)
    bool factorise(const kinematics::BlockHessian& hessian) {
        return rows ? system.factorise(hessian, rows->jacobian()) : system.factorise(hessian);
    }
};

}  // namespace fettle::core::solver
