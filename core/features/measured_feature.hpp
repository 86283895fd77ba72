// SPDX-License-Identifier: MIT
/// What is told of a feature beside its surface: length, ends, how much of the turn is there, where its facets are.
#pragma once

#include "core/features/feature.hpp"
#include "core/features/regions.hpp"

namespace fettle::core::features {

/// All but name, `coaxial` and `is_through`.
Feature measured_feature(const Patches& patches, const Region& region, const RegionOptions& options);
/// A flat face.
Feature flat_feature(const Patches& patches, int patch);

}  // namespace fettle::core::features
