// SPDX-License-Identifier: MIT
#include "core/parts/surface.hpp"

namespace fettle::core::parts {

const char* name_of(SurfaceKind kind) {
    switch (kind) {
        case SurfaceKind::plane:
            return "plane";
        case SurfaceKind::cylinder:
            return "cylinder";
        case SurfaceKind::cone:
            return "cone";
        case SurfaceKind::sphere:
            return "sphere";
        case SurfaceKind::torus:
            return "torus";
        case SurfaceKind::extruded:
            return "extruded";
        case SurfaceKind::revolved:
            return "revolved";
        case SurfaceKind::helical:
            return "helical";
    }
    return "";
}

}  // namespace fettle::core::parts
