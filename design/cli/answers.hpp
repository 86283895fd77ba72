// SPDX-License-Identifier: MIT
/// Parts of answers that several commands share. All numbers SI unless a key says otherwise.
#pragma once

#include <string>

#include "core/base/text.hpp"
#include "design/cli/console.hpp"
#include "design/description/design.hpp"
#include "design/optimisers/problem.hpp"

namespace fettle::design::cli {

/// A line per relation, for people.
std::string relations_text(const description::Design& design, const optimisers::Rows& relations, const Console& console);

/// Largest resident memory of this process so far [bytes].
long peak_memory_bytes();

using core::base::formatted;

}  // namespace fettle::design::cli
