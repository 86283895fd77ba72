// SPDX-License-Identifier: MIT
/// NLopt's C functions, loaded where they are first called (core/base/shared_library.hpp).
#pragma once

#include <nlopt.h>

namespace fettle::design::optimisers {

/// Each as nlopt.h declares it, without its "nlopt_".
struct NloptLibrary {
    decltype(&nlopt_create) create;
    decltype(&nlopt_destroy) destroy;
    decltype(&nlopt_force_stop) force_stop;
    decltype(&nlopt_set_min_objective) set_min_objective;
    decltype(&nlopt_add_inequality_mconstraint) add_inequality_mconstraint;
    decltype(&nlopt_add_equality_mconstraint) add_equality_mconstraint;
    decltype(&nlopt_set_lower_bounds) set_lower_bounds;
    decltype(&nlopt_set_upper_bounds) set_upper_bounds;
    decltype(&nlopt_set_ftol_rel) set_ftol_rel;
    decltype(&nlopt_set_xtol_rel) set_xtol_rel;
    decltype(&nlopt_set_xtol_abs1) set_xtol_abs1;
    decltype(&nlopt_set_initial_step1) set_initial_step1;
    decltype(&nlopt_set_maxeval) set_maxeval;
    decltype(&nlopt_optimize) optimize;
};

/// Throws core::base::MissingLibrary.
const NloptLibrary& nlopt_library();

}  // namespace fettle::design::optimisers
