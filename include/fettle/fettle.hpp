// SPDX-License-Identifier: MIT
/// All of fettle: core.hpp, adjoint.hpp and design.hpp.
#pragma once

#include "fettle/design.hpp"
