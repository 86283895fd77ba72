// SPDX-License-Identifier: MIT
/// Names that nothing else has: of bodies, links and files that are made of names from outside.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>

namespace fettle::core::files {

class UniqueNames {
public:
    /// @param between  stands between a name and its number.
    /// @param one_case  names that differ in case alone count as equal: what files may be on some disks.
    explicit UniqueNames(std::string between = "_", bool one_case = false) : between_(std::move(between)), one_case_(one_case) {}

    /// `name`, or if it has been given out already `name_2`, `name_3`, ...: the first that is free. Linear in the number of names.
    std::string unique(const std::string& name);

private:
    std::string between_;
    bool one_case_;
    std::set<std::string> given_;
    std::map<std::string, int> last_;  // number that a name was given
};

/// The same as every file system takes it: letters, digits, blanks, - _ + and, but for the first, dots; _ for all else but UTF-8. A long
/// one is cut; UniqueNames distinguishes equal ones.
std::string file_stem(std::string name);

}  // namespace fettle::core::files
