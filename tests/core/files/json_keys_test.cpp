// SPDX-License-Identifier: MIT
// The kind of a file by a key of its outermost object, wherever it stands, and by nothing that only looks like it.
#include "core/files/json_keys.hpp"

#include <catch2/catch.hpp>

#include <string>

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
