// SPDX-License-Identifier: MIT
/// Springs, dampers, stops, friction of joints, forces of motors and loads at points (measure_law.hpp) as one term of the incremental
/// potential. Reports their energy and the force along each. docs/method/joints.md#springs-dampers-stops-friction.
#pragma once

#include "fettle/core/energy/measure_law.hpp"
#include "fettle/core/energy/term.hpp"

namespace fettle::core::energy {

extern const CouplingTerm measure_terms;

}  // namespace fettle::core::energy
