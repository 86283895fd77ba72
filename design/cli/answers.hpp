// SPDX-License-Identifier: MIT
/// Parts of answers that several commands share. All numbers SI unless a key says otherwise.
#pragma once

#include <string>

#include "fettle/core/base/text.hpp"
#include "fettle/design/cli/console.hpp"
#include "fettle/design/description/design.hpp"
#include "fettle/design/optimisers/problem.hpp"

namespace fettle::design::cli {

/// A line per relation, for people.
std::string relations_text(const description::Design& design, const optimisers::Rows& relations, const Console& console);

/// Largest resident memory of this process so far [bytes].
long peak_memory_bytes();

using core::base::formatted;

}  // namespace fettle::design::cli
