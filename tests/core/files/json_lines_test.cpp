// SPDX-License-Identifier: MIT
#include "core/files/json_lines.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace fettle::core::files::json_lines_test {

TEST_CASE("the line of a JSON pointer", "[json_lines]") {
    const std::string text = R"({
  "a": [1, "x]\"", {"b": -1.5e3,
    "c": {"d": true}}, null],
  "a/b": {
    "~": [[
      []], 7]
  }, "last": 3 })";
    const auto line = [&](const char* pointer) { return line_of_pointer(text, pointer); };
    CHECK(line("") == 1);
    CHECK(line("/a") == 2);
    CHECK(line("/a/1") == 2);
    CHECK(line("/a/2/b") == 2);
    CHECK(line("/a/2/c/d") == 3);
    CHECK(line("/a/3") == 3);
    CHECK(line("/a~1b") == 4);
    CHECK(line("/a~1b/~0/0/0") == 6);
    CHECK(line("/a~1b/~0/1") == 6);
    CHECK(line("/last") == 7);
    // What is not there: as far as it goes.
    CHECK(line("/absent") == 1);
    CHECK(line("/a/2/absent") == 2);
    CHECK(line("/a~1b/~0/5") == 5);
    CHECK(line("/last/0") == 7);
}

TEST_CASE("the line in what is no JSON", "[json_lines]") {
    for (const char* text :
         {"", "{", "[", "{\"a\"", "{\"a\":", "{\"a\": [1,", "}", "]]", "{\"a", "{\"a\\", "[,,,", "{,}", "{{{{", "[[[[\n"})
        CHECK(line_of_pointer(text, "/a/0/b") == 1);
}

}  // namespace fettle::core::files::json_lines_test
