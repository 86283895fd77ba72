// SPDX-License-Identifier: MIT
#include "core/files/json_document.hpp"
#include "core/files/json_text.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "core/files/nearest_word.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::files::json_document_test {

namespace {

using base::ErrorCode;

JsonDocument parsed(const std::string& text) {
    auto document = JsonDocument::parse(text, "a.json");
    REQUIRE(document);
    return std::move(document).value();
}

base::Error only_error(const base::Errors& errors) {
    REQUIRE(errors.size() == 1);
    return errors.front();
}

using fettle::tests::support::contains;

TEST_CASE("Faults of syntax have a line and a column", "[scene]") {
    const auto missing_comma = JsonDocument::parse("{\n  \"a\": 1\n  \"b\": 2\n}", "a.json");
    const auto error = only_error(missing_comma.errors());
    CHECK(error.code == ErrorCode::parse);
    CHECK(contains(error.where, "a.json:3:"));
    for (const char* empty : {"", "  \r\n\t"}) {
        const auto nothing = only_error(JsonDocument::parse(empty, "a.json").errors());
        CHECK(nothing.code == ErrorCode::parse);
        CHECK(contains(nothing.message, "is empty"));
    }
    CHECK(only_error(JsonDocument::read("/nonexistent/a.json").errors()).code == ErrorCode::file_not_found);
}

TEST_CASE("Faults of syntax that are common are told in plain words", "[scene]") {
    const std::pair<const char*, const char*> said[] = {{R"({"a": 1, })", "a comma stands before }"},
                                                        {R"({"a": [1,]})", "a comma stands before ]"},
                                                        {"{'a': 1}", "text is in double quotes"},
                                                        {R"({"a": 'x'})", "text is in double quotes"},
                                                        {"{\"a\": 1 // one\n}", "JSON has no comments"},
                                                        {R"({"a": 1, /* two */ "b": 2})", "JSON has no comments"},
                                                        {"# three\n{}", "JSON has no comments"},
                                                        {R"({"a": 1 "b": 2})", "a comma is missing before this entry"},
                                                        {R"({"a": [1 2]})", "a comma is missing before this entry"},
                                                        {R"({"a" 1})", "a colon is missing"},
                                                        {"{a: 1}", "a key is expected, which is text in double quotes"},
                                                        {R"({"a": True})", "JSON writes true, false and null"},
                                                        {R"({"a": 1)", "the text ends too early"},
                                                        {R"({"a": "x)", "a text has no closing quote"},
                                                        {R"({"a": 1}})", "more text follows"}};
    for (const auto& [text, words] : said) {
        const auto error = only_error(JsonDocument::parse(text, "a.json").errors());
        CAPTURE(text, error.message);
        CHECK(error.code == ErrorCode::parse);
        CHECK(contains(error.message, std::string("not valid JSON: ") + words));
    }
}

TEST_CASE("Numbers that are not finite are called so", "[scene]") {
    for (const std::string text : {"{\"a\": 1,\n \"b\": NaN}", "{\"a\": 1,\n \"b\": -Infinity}", "{\"a\": 1,\n \"b\": nan}",
                                   "{\"a\": 1,\n \"b\": 1e999}", "{\"a\": 1,\n \"b\": -1e999}"}) {
        CAPTURE(text);
        const auto error = only_error(JsonDocument::parse(text, "a.json").errors());
        CHECK(error.code == ErrorCode::not_finite);
        CHECK(contains(error.where, "a.json:2:7"));
    }
    for (const std::string text : {"{\"b\": \"NaN\"}", "{\"b\": \"-inf\"}"}) {
        JsonDocument document = parsed(text);
        CHECK_FALSE(document.root()["b"].number());
        CHECK_FALSE(document.root()["b"].length(1));
        REQUIRE(document.errors().size() == 2);
        CHECK(document.errors()[0].code == ErrorCode::not_finite);
        CHECK(document.errors()[1].code == ErrorCode::not_finite);
        CHECK(document.errors()[0].where == "a.json#/b");
    }
}

TEST_CASE("Numbers beyond any mechanism are out of range, wherever they stand", "[scene]") {
    JsonDocument document = parsed(R"({"a": 1e160, "b": [0, -1e31, 0], "c": "1e40 mm", "d": 1e30, "e": "30mm"})");
    const JsonNode root = document.root();
    CHECK_FALSE(root["a"].number());
    CHECK_FALSE(root["b"].numbers());
    CHECK_FALSE(root["b"].vector3());
    CHECK_FALSE(root["c"].length(1));
    CHECK(root["d"].number() == 1e30);
    REQUIRE(document.errors().size() == 4);
    for (const base::Error& error : document.errors()) {
        CHECK(error.code == ErrorCode::out_of_range);
        CHECK(contains(error.message, "at most 1e30"));
    }
    CHECK(document.errors()[1].where == "a.json#/b/1");
    CHECK_FALSE(root["e"].quantity(base::Dimension::mass, 1));
    CHECK(document.errors().back().code == ErrorCode::wrong_type);
}

TEST_CASE("Two equal keys in one object are refused", "[scene]") {
    const auto error = only_error(JsonDocument::parse(R"({"a": {"mass": 1, "mass": 2}, "mass": 3})", "a.json").errors());
    CHECK(error.code == ErrorCode::inconsistent);
    CHECK(contains(error.message, "mass"));
    CHECK(error.where == "a.json#/a/mass");
    const auto deep = only_error(JsonDocument::parse(R"([{"x/y": [1, [2], {"b": 1, "b": 1}]}])", "a.json").errors());
    CHECK(deep.where == "a.json#/0/x~1y/2/b");
}

TEST_CASE("A NUL ends nothing", "[scene]") {
    const std::string nul(1, '\0');
    for (const std::string& text :
         {"{\"a\": 1}" + nul, "{\"a\": 1}\n" + nul + " garbage", "{\"a" + nul + "\": 1}", nul, "{\"a\":" + nul + " 1}"}) {
        const auto error = only_error(JsonDocument::parse(text, "a.json").errors());
        CHECK(error.code == ErrorCode::parse);
        CHECK(contains(error.message, "NUL"));
        CHECK_FALSE(is_safe_json_text(text));
    }
    CHECK(JsonDocument::parse("{\"a\": \"\\u0000\"}", "a.json"));  // written as JSON wants it
}

TEST_CASE("Lists and objects nested too deep are refused, by whoever reads them", "[scene]") {
    const auto nested = [](std::size_t depth, const std::string& open, const std::string& close) {
        std::string text;
        for (std::size_t i = 0; i < depth; ++i) text += open;
        text += "1";
        for (std::size_t i = 0; i < depth; ++i) text += close;
        return text;
    };
    for (const std::string open : {"[", "{\"# why\":"}) {
        const std::string close = open == "[" ? "]" : "}";
        CHECK(JsonDocument::parse(nested(deepest_json, open, close), "a.json"));
        CHECK(is_safe_json_text(nested(deepest_json, open, close)));
        for (const std::size_t depth : {deepest_json + 1, std::size_t{1'000'000}}) {
            const auto error = only_error(JsonDocument::parse(nested(depth, open, close), "a.json").errors());
            CHECK(error.code == ErrorCode::out_of_range);
            CHECK(contains(error.message, "nested deeper than 100"));
            CHECK(contains(error.where, open == "[" ? "a.json#/0/0/0/..." : "a.json#/# why/# why/# why/..."));
            CHECK_FALSE(is_safe_json_text(nested(depth, open, close)));
        }
    }
    CHECK(is_safe_json_text("[\"" + std::string(1000, '[') + "\", \"\\\"[\"]"));  // in strings nothing is nested
}

TEST_CASE("Every fault is collected, each with its place", "[scene]") {
    JsonDocument document = parsed(R"({"bodies": [{"mass": -1, "densty": 2, "a/b": "x", "n": 1.5}], "flag": 1})");
    const JsonNode root = document.root();
    const JsonNode body = root["bodies"].elements().at(0);
    CHECK_FALSE(body["mass"].number(positive));
    body.allow_keys({"mass", "density", "a/b", "n"});
    CHECK_FALSE(body["a/b"].number());
    CHECK_FALSE(body["n"].integer(0));
    CHECK_FALSE(root["flag"].boolean());
    CHECK_FALSE(root.require("units").exists());
    CHECK_FALSE(root["absent"]["deeper"].number());
    const auto& errors = document.errors();
    REQUIRE(errors.size() == 6);
    CHECK(errors[0].code == ErrorCode::out_of_range);
    CHECK(errors[0].where == "a.json#/bodies/0/mass");
    CHECK(contains(errors[0].message, "-1"));
    CHECK(contains(errors[0].message, "greater than 0"));
    CHECK(errors[1].code == ErrorCode::unknown_key);
    CHECK(contains(errors[1].message, "did you mean `density`?"));
    CHECK(errors[2].where == "a.json#/bodies/0/a~1b");
    CHECK(errors[3].code == ErrorCode::wrong_type);
    CHECK(errors[4].where == "a.json#/flag");
    CHECK(errors[5].code == ErrorCode::missing_key);
}

TEST_CASE("Lengths take the file's unit or their own", "[scene]") {
    JsonDocument document = parsed(R"({"a": 30, "b": "0.3mm", "c": "1 in", "d": "3 parsec", "e": [1, "2mm", 3], "f": -2})");
    const JsonNode root = document.root();
    CHECK(root["a"].length(0.001) == 0.03);  // bit for bit
    CHECK(root["b"].length(0.001) == 0.0003);
    CHECK(root["c"].length(1) == 0.0254);
    CHECK(root["e"].length3(1)->isApprox(Vector3(1, 0.002, 3)));
    CHECK(document.errors().empty());
    CHECK_FALSE(root["d"].length(1));
    CHECK_FALSE(root["f"].length(1, positive));
    REQUIRE(document.errors().size() == 2);
    CHECK(document.errors()[0].where == "a.json#/d");
    CHECK(document.errors()[1].code == ErrorCode::out_of_range);
    CHECK(document.errors()[1].message == "-2 is out of range: it must be greater than 0");  // of no unit
    CHECK_FALSE(root["f"].length(0.001, {1, 2}));
    CHECK(document.errors()[2].message == "-2 is out of range: it must be at least 1 and at most 2 m");
}

TEST_CASE("The nearest word is a slip of the pen, not a guess", "[scene]") {
    const std::vector<std::string_view> known{"density", "position", "rotation", "dhat", "dmin"};
    CHECK(nearest_word("densty", known) == "density");
    CHECK(nearest_word("postiion", known) == "position");
    CHECK(nearest_word("Rotation", known) == "rotation");
    CHECK(nearest_word("DHAT", known) == "dhat");
    CHECK(nearest_word("dmim", known) == "dmin");
    CHECK_FALSE(nearest_word("colour", known));
    CHECK_FALSE(nearest_word("", known));
}

TEST_CASE("Other keys of a lenient file are warned of, comments are not", "[scene]") {
    JsonDocument document = parsed(R"({"#note": 1, "timstep": 0.1, "timestep": 0.2})");
    document.root().warn_of_other_keys({"timestep"});
    REQUIRE(document.warnings().size() == 1);
    CHECK(contains(document.warnings()[0], "did you mean `timestep`?"));
    CHECK(document.errors().empty());
}

TEST_CASE("What is said of several elements of a list is said once", "[scene]") {
    JsonDocument document = parsed(R"({"list": [{"a": 1}, {"a": 2}, {"b": 3}, {"a": 4}, {"a": 5}, {"a": 6}], "other": [{"a": 7}]})");
    const JsonNode root = document.root();
    root["other"].warn("odd");
    for (const JsonNode& element : root["list"].elements()) element.warn_of_other_keys({});
    root["other"].warn("odd");
    for (const JsonNode& element : root["other"].elements()) element.warn_of_other_keys({});
    const std::string path = document.path();
    CHECK(document.warnings() == std::vector<std::string>{path + "#/other: odd", path + "#/list/[0, 1, 3-5]/a: unknown key `a` is ignored",
                                                          path + "#/list/2/b: unknown key `b` is ignored",
                                                          path + "#/other/0/a: unknown key `a` is ignored"});
}

TEST_CASE("What is read on all threads reports in the order of the list", "[scene]") {
    constexpr std::size_t count = 200;
    std::string text = R"({"first": "x", "list": [)";
    for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? "," : "") + std::string(i % 3 == 0 ? R"({"a": "x", "b": 1})" : R"({"a": 2})");
    text += R"(], "last": "x"})";
    const auto report = [&](bool on_all_threads) {
        JsonDocument document = parsed(text);
        std::vector<double> sums(count);
        const auto read = [&](std::size_t i, const JsonNode& node) {
            const std::size_t before = node.error_count();
            node.warn_of_other_keys({"a"});
            sums[i] = node["a"].number().value_or(-1);
            if (node.error_count() > before) sums[i] -= 10;
        };
        document.root()["first"].number();
        const std::vector<JsonNode> nodes = document.root()["list"].elements();
        if (on_all_threads) {
            JsonNode::read_each(nodes, read);
        } else {
            for (std::size_t i = 0; i < count; ++i) read(i, nodes[i]);
        }
        document.root()["last"].number();
        std::vector<std::string> told = document.warnings();
        for (const base::Error& error : document.errors()) told.push_back(error.where + ": " + error.message);
        return std::pair(told, sums);
    };
    const auto [told, sums] = report(true);
    CHECK(told.size() == 1 + 2 + (count + 2) / 3);
    CHECK(std::count(sums.begin(), sums.end(), -11) == static_cast<int>((count + 2) / 3));
    CHECK(std::pair(told, sums) == report(false));
    JsonNode::read_each({}, [](std::size_t, const JsonNode&) { FAIL("there is nothing to read"); });
}

}  // namespace

}  // namespace fettle::core::files::json_document_test
