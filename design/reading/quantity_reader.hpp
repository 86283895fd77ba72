// SPDX-License-Identifier: MIT
/// The kinds of quantity (design/quantities/) by the `type` that a design file calls them, and their reading.
/// Add one: a row here, a branch of `quantity` in design.schema.json, a row and a dataclass of Python
/// (design/python/library_quantities.hpp), and the line that tests/design/quantities/quantity_table_test.cpp asks for.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/json_document.hpp"
#include "design/description/quantity.hpp"
#include "design/quantities/clearance.hpp"
#include "design/reading/read_context.hpp"

namespace fettle::design::reading {

struct QuantityType {
    std::string_view name;
    /// @return nothing if something was wrong; the faults are with the document.
    std::shared_ptr<const description::Quantity> (*read)(const core::files::JsonNode& node, const ReadContext& context);
    std::vector<std::string_view> keys;                                          ///< besides those common to all terms and constraints
    std::function<std::string(const core::files::JsonNode& node)> default_name;  ///< "stroke piston"
    std::string_view unit;                                                       ///< of its value
    std::string_view meaning;                                                    ///< for people: one line
    std::vector<std::string_view> names_in{};                                    ///< keys whose texts name other quantities
};
const std::vector<QuantityType>& quantity_table();
std::vector<std::string_view> quantity_names();
const QuantityType* find_quantity_type(std::string_view name);

/// type.read, of numbers that all count: what follows from a deviation and cannot is refused.
std::shared_ptr<const description::Quantity> read_quantity(const QuantityType& type, const core::files::JsonNode& node,
                                                           const ReadContext& context);

inline constexpr std::string_view expression_type = "expression";

/// The bodies that a clearance is between, and what it is over: all keys of the quantity.
std::optional<quantities::ClearanceRange> read_clearance_range(const core::files::JsonNode& node, const ReadContext& context);

/// The `quantities` of a design file, which expressions and others of them name; each may name any that does not follow from it:
///     "quantities": { "force": { "type": "joint_force", "joint": "pin", "over": "largest" }, "arm": { "type": "mass", "bodies": ["arm"] }
///     }, "objective": [ { "type": "expression", "expression": "force / arm" } ]
std::vector<quantities::NamedQuantity> read_named_quantities(const core::files::JsonNode& node, const ReadContext& context);

}  // namespace fettle::design::reading
