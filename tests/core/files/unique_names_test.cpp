// SPDX-License-Identifier: MIT
#include "core/files/unique_names.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <string>

namespace fettle::core::files::unique_names_test {

TEST_CASE("Names that are taken are numbered, and the numbers are free") {
    UniqueNames names;
    CHECK(names.unique("arm") == "arm");
    CHECK(names.unique("arm_2") == "arm_2");
    CHECK(names.unique("arm") == "arm_3");
    CHECK(names.unique("ARM") == "ARM");
    UniqueNames files(" ", true);
    CHECK(files.unique("arm") == "arm");
    CHECK(files.unique("ARM") == "ARM 2");
}

TEST_CASE("Very long names become different file names that every file system takes") {
    constexpr std::size_t longest_file_name = 255;  // bytes
    const std::string e_acute = "\xc3\xa9";
    for (const std::string& unit : {std::string("a"), e_acute, "a" + e_acute}) {
        std::string name;
        while (name.size() < 5000) name += unit;
        UniqueNames files("_", true);
        std::set<std::string> stems;
        for (int i = 0; i < 1000; ++i) {
            const std::string stem = files.unique(file_stem(name + std::to_string(i)));  // they differ at the end, which is cut off
            CHECK(stem.size() + std::string(".obj").size() <= longest_file_name);
            const std::size_t end = stem.find('_');  // what stands before it is whole characters, and the name's own
            CHECK(name.compare(0, std::min(end, stem.size()), stem, 0, end) == 0);
            CHECK(std::min(end, stem.size()) % (unit == "a" ? 1 : unit.size()) <= (unit.size() == 3 ? 1 : 0));
            stems.insert(stem);
        }
        CHECK(stems.size() == 1000);
    }
    CHECK(file_stem("a short name") == "a short name");
}

}  // namespace fettle::core::files::unique_names_test
