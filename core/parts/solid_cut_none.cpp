// SPDX-License-Identifier: MIT
// Where there is no CGAL.
#include "core/parts/solid_cut.hpp"

namespace fettle::core::parts {

bool can_cut_solids() { return false; }

Result<SolidCut> cut_solids(const FacedMesh&, const FacedMesh&, double, Combination) {
    return Error{
        ErrorCode::unsupported,
        {},
        "solids that cut each other need CGAL (libcgal-dev), which this build of fettle was configured without: stack layers or cut "
        "profiles instead, or build with -DFETTLE_CGAL=ON"};
}

}  // namespace fettle::core::parts
