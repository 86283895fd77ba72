// SPDX-License-Identifier: MIT
#include "design/report/spread_charts.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>
#include <string>

namespace fettle::design::report::spread_charts_test {

namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

// A number of each element of a class, in the order of the page.
std::vector<double> numbers_of(const std::string& svg, const std::string& pattern) {
    std::vector<double> out;
    const std::regex wanted(pattern);
    for (std::sregex_iterator each(svg.begin(), svg.end(), wanted), end; each != end; ++each) out.push_back(std::stod((*each)[1]));
    return out;
}

}  // namespace

TEST_CASE("spread charts: round numbers within a range") {
    CHECK(round_numbers(0, 10, 5) == std::vector<double>{0, 2, 4, 6, 8, 10});
    const auto few = round_numbers(-0.13, 0.11, 4);
    REQUIRE(few.size() == 3);
    CHECK(few[0] == Approx(-0.1));
    CHECK(few[1] == 0);
    CHECK(few[2] == Approx(0.1));
    CHECK(round_numbers(3, 3, 4) == std::vector<double>{3});
    CHECK(round_numbers(1e6, 1e6 + 1e-9, 4).size() <= 1000);
}

TEST_CASE("spread charts: bars are as long as what they say, names are text") {
    const std::string svg = tornado_svg("of <a>", {{"big", "-1 to +1 mm", -2, 2, 0.9}, {"<i>small</i> & co", "", 1, 0.5, 0.1}}, "mm");
    CHECK(svg.find("<title>of &lt;a&gt;</title>") != std::string::npos);
    CHECK(svg.find("<i>") == std::string::npos);
    CHECK(svg.find("&lt;i&gt;small&lt;/i&gt; &amp; co") != std::string::npos);
    const auto lower = numbers_of(svg, "width=\"([0-9.]+)\" height=\"[0-9.]+\" class=\"lower\"");
    const auto upper = numbers_of(svg, "width=\"([0-9.]+)\" height=\"[0-9.]+\" class=\"upper\"");
    REQUIRE(lower.size() == 2);
    REQUIRE(upper.size() == 2);
    CHECK(lower[1] == Approx(lower[0] / 2).margin(0.02));
    CHECK(upper[1] == Approx(upper[0] / 4).margin(0.02));
    // Both changes of the second are to the right of zero.
    const auto from = numbers_of(svg, "rect x=\"([0-9.]+)\" [^>]*class=\"lower\"");
    CHECK(from[0] + lower[0] == Approx(from[1]).margin(0.02));
    CHECK(svg.find(">+0.5</text>") != std::string::npos);
    CHECK(tornado_svg("none moves", {{"x", "", 0, 0, 0}}, "").find("nan") == std::string::npos);
}

TEST_CASE("spread charts: a histogram counts every sample once") {
    std::vector<double> values;
    for (int k = 0; k < 1000; ++k) values.push_back(std::sin(k));
    const std::string svg = histogram_svg("sines", values, values, {{"as drawn", "drawn", 0}, {"at most", "limit", 50}}, "mm");
    double all = 0;
    for (const double share : numbers_of(svg, "<title>([0-9.]+)% from")) all += share;
    CHECK(all == Approx(100).margin(2));  // told to two digits
    // The prediction is of the same values: its line goes through the tops of the bars.
    CHECK(count_of(svg, "class=\"predicted\"") == 1);
    // A limit far off is told at the edge, and has no line.
    CHECK(svg.find("at most 50 mm \u2192") != std::string::npos);
    CHECK(count_of(svg, "<line") - count_of(svg, "class=\"axis\"") == 1);
    // All the same.
    const std::string same = histogram_svg("same", {2, 2, 2}, {}, {{"as drawn", "drawn", 2}}, "");
    CHECK(same.find("<title>100% from") != std::string::npos);
    CHECK(same.find("nan") == std::string::npos);
    CHECK(count_of(histogram_svg("one", {0}, {}, {}, ""), "class=\"bin\"") == 1);
}

TEST_CASE("spread charts: a scatter has a mark for each sample, made or not") {
    const std::vector<ScatterPoint> points{
        {0, 1.0, true}, {1, 2.0, false}, {2, 3.0, true}, {3, std::nullopt, true}, {4, std::nullopt, true}};
    const std::string svg = scatter_svg("samples", points, {{"at least", "limit", 1.5}}, "x", "y");
    CHECK(count_of(svg, "h0") == 2);
    CHECK(count_of(svg, "l5 5m0-5l-5 5") == 1);
    CHECK(count_of(svg, "l4 9h-8z") == 2);
    CHECK(svg.find("at least</text>") != std::string::npos);
    CHECK(svg.find("class=\"limit\"") != std::string::npos);
    // None could be made.
    const std::string none = scatter_svg("none", {{0, std::nullopt, true}}, {}, "x", "y");
    CHECK(count_of(none, "l4 9h-8z") == 1);
    CHECK(none.find("nan") == std::string::npos);
}

}  // namespace fettle::design::report::spread_charts_test
