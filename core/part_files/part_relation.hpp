// SPDX-License-Identifier: MIT
/// What must hold between the dimensions of a part, in its designer's words:
///     {"check": "pin_radius + clearance < pitch / 2", "or": "the slots meet", "when": "slots > 1"}
/// Comparisons < <= > >= may follow each other: "0 < shift < 1". A number without a unit counts in the file's unit of what it is compared
/// with. Part of part_file.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/part_files/part_numbers.hpp"

namespace fettle::core::part_files {

struct Comparison {
    std::vector<PartNumber> sides;   ///< at least two
    std::vector<std::string> signs;  ///< one between each two of them: < <= > >=
};

struct PartRelation {
    std::string check;      ///< as written
    std::string otherwise;  ///< what becomes of a part for which it does not hold; may be empty
    std::string where;      ///< file and JSON pointer

    Comparison comparison;
    std::optional<Comparison> when;  ///< it need not hold where this does not
};

std::optional<PartRelation> read_relation(const files::JsonNode& node, const PartNumbers& numbers);

/// Why it does not hold at these values (of PartNumbers::names(), SI), with what was found; nothing: it holds.
std::optional<Error> fault_of(const PartRelation& relation, const std::vector<double>& values);

/// 0.0025 of a length as "2.5 mm".
std::string shown(double si, const expression::DimensionPowers& dimension);

}  // namespace fettle::core::part_files
