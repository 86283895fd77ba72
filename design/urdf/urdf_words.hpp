// SPDX-License-Identifier: MIT
/// The words of a URDF file: the elements of the format with their attributes, in one table, and the fate of each: it is read, or it is
/// passed over with a warning that names it and says why. What is not in the table is passed over so too. The parser asks this table, and
/// the tests go through it.
/// Source: the schema of urdfdom and the pages http://wiki.ros.org/urdf/XML.
#pragma once

#include <string_view>
#include <vector>

namespace fettle::design::urdf {

struct UrdfAttribute {
    std::string_view name;
    std::string_view passed_over = {};  ///< why; empty: it is read
};

struct UrdfElement {
    std::string_view path;  ///< "robot/link/visual"
    std::vector<UrdfAttribute> attributes = {};
    std::string_view passed_over = {};  ///< with all that is in it: why; empty: it is read
};

const std::vector<UrdfElement>& urdf_elements();

/// Null: none. @param path  as above.
const UrdfElement* find_urdf_element(std::string_view path);

}  // namespace fettle::design::urdf
