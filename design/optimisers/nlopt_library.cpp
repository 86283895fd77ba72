// SPDX-License-Identifier: MIT
#include "design/optimisers/nlopt_library.hpp"

#include "core/base/shared_library.hpp"

namespace fettle::design::optimisers {

namespace {

NloptLibrary load_nlopt() {
    NloptLibrary out{};
#ifdef FETTLE_NLOPT_NAME
    const core::base::SharedLibrary library(FETTLE_NLOPT_NAME, FETTLE_NLOPT_PATH);
#define FETTLE_NLOPT(function) library.find("nlopt_" #function, out.function)
#else
#define FETTLE_NLOPT(function) out.function = &nlopt_##function
#endif
    FETTLE_NLOPT(create);
    FETTLE_NLOPT(destroy);
    FETTLE_NLOPT(force_stop);
    FETTLE_NLOPT(set_min_objective);
    FETTLE_NLOPT(add_inequality_mconstraint);
    FETTLE_NLOPT(add_equality_mconstraint);
    FETTLE_NLOPT(set_lower_bounds);
    FETTLE_NLOPT(set_upper_bounds);
    FETTLE_NLOPT(set_ftol_rel);
    FETTLE_NLOPT(set_xtol_rel);
    FETTLE_NLOPT(set_xtol_abs1);
    FETTLE_NLOPT(set_initial_step1);
    FETTLE_NLOPT(set_maxeval);
    FETTLE_NLOPT(optimize);
#undef FETTLE_NLOPT
    return out;
}

}  // namespace

const NloptLibrary& nlopt_library() {
    static const NloptLibrary library = load_nlopt();
    return library;
}

}  // namespace fettle::design::optimisers
