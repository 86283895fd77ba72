// SPDX-License-Identifier: MIT
// The kind of a file by a key of its outermost object, wherever it stands, and by nothing that only looks like it.
#include "core/files/json_keys.hpp"

#include <catch2/catch.hpp>

#include <string>

#include "core/files/json_document.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::core::files::json_keys_test {

using fettle::core::files::has_top_level_key;

namespace {

bool has_kind(const std::string& text) {
    const fettle::tests::support::TemporaryFolder folder;
    return has_top_level_key(folder.write("a.json", text), "kind");
}

}  // namespace

TEST_CASE("A top-level key is found wherever it stands", "[scene]") {
    CHECK(has_kind(R"({"kind": 1})"));
    CHECK(has_kind("\xEF\xBB\xBF \n{ \"kind\"\n : 1"));
    CHECK(has_kind(R"({"a": [{"b": "}]"}, "\"{\\", 3], "c": {"kind": {}}, "kind": 1})"));
    CHECK(has_kind("{\"a\": \"" + std::string(200000, '[') + "\", \"b\": [" + std::string(200000, '1') + "], \"kind\": 1}"));
}

TEST_CASE("Another of our files is told by what it is, and what takes it", "[scene]") {
    const auto told = [](const std::string& text) {
        auto document = JsonDocument::parse(text, "a.json");
        CHECK_FALSE(is_format(document->root(), "fettle_part", "part", 1));
        return document->errors().front().message;
    };
    CHECK(told(R"({"fettle_process": 1})") ==
          "no part: the key `fettle_part` is missing; by its `fettle_process` it is a process, which --process takes, and a design names");
    CHECK(told(R"({"fetle_part": 1})").find("did you mean `fettle_part`") != std::string::npos);
    CHECK(told(R"({"a": 1})") == "no part: the key `fettle_part` is missing");
    CHECK(told(R"({"fettle_part": 2})").find("a file of version 2 is not read") == 0);
}

TEST_CASE("What is no top-level key is not taken for one", "[scene]") {
    CHECK_FALSE(has_kind(""));
    CHECK_FALSE(has_kind(R"({"a": {"kind": 1}})"));
    CHECK_FALSE(has_kind(R"({"a": [{"kind": 1}]})"));
    CHECK_FALSE(has_kind(R"({"a": "kind", "b": "\"kind\": 1"})"));
    CHECK_FALSE(has_kind(R"({"kinds": 1, "kin": 2, "akind": 3, "\"kind": 4})"));
    CHECK_FALSE(has_kind(R"("kind": 1)"));
    CHECK_FALSE(has_kind(R"({"a": 1} {"kind": 1})"));
    CHECK_FALSE(has_kind("solid {\"kind\": 1}"));
    CHECK_FALSE(has_top_level_key("/no/such/file.json", "kind"));
    CHECK_FALSE(has_top_level_key("/", "kind"));
}

}  // namespace fettle::core::files::json_keys_test
