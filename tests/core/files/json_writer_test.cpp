// SPDX-License-Identifier: MIT
// What is written is JSON, and reads back as it was: strings by their characters, numbers by their bits.
#include "core/files/json_writer.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/files/json_document.hpp"

namespace fettle::core::files::json_writer_test {

TEST_CASE("Written JSON reads back bit for bit", "[scene]") {
    const std::vector<double> numbers{0, -0.0, 0.1, -1.0 / 3, 5e-324, 9.9999999999999989e29, 9007199254740993.0 * 1024};
    const std::string name = "a \"quoted\" \\ name,\n\ttab \x01, µm";
    JsonWriter out;
    out.text = "{";
    out.key("numbers");
    out.numbers(numbers);
    out.key(name);
    out.list(2, ", ", [&](std::size_t i) { out.string(i == 0 ? name : ""); });
    out.key("empty");
    out.numbers(std::vector<int>{});
    out.text += "}";

    auto document = JsonDocument::parse(out.text, "written");
    REQUIRE(document);
    const JsonNode root = document->root();
    const auto read = root.require("numbers").numbers();
    REQUIRE(read);
    CHECK(*read == numbers);
    CHECK(std::signbit(read->at(1)));
    const auto words = root.require(name).elements();
    REQUIRE(words.size() == 2);
    CHECK(words[0].string() == name);
    CHECK(words[1].string() == "");
    CHECK(root.require("empty").elements().empty());
    CHECK(document->errors().empty());
}

TEST_CASE("Written JSON is this text", "[scene]") {
    JsonWriter out;
    out.text = "{";
    out.key("a");
    out.numbers(Vector3(1, -0.0, 0.5));
    out.key("b");
    out.list(0, ",", [](std::size_t) {});
    out.text += "}";
    CHECK(out.text == "{\"a\": [1,-0.0,0.5],\n \"b\": []}");
}

}  // namespace fettle::core::files::json_writer_test
