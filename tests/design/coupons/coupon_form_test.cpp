// SPDX-License-Identifier: MIT
#include "design/coupons/coupon_form.hpp"

#include <catch2/catch.hpp>

namespace fettle::design::coupons::coupon_form_test {

namespace {

using tolerances::FeatureKind;

const std::string head = "feature,kind,nominal_mm,measured_1_mm,measured_2_mm,measured_3_mm\n";

std::string faults(const std::string& text) {
    std::string told;
    const auto read = parse_form(text, "coupon.csv");
    for (const Error& error : read.errors()) told += error.where + ": " + error.message + "\n";
    return told;
}

}  // namespace

TEST_CASE("coupon forms: the empty one reads back as what is to be measured") {
    for (const CouponKind kind : {CouponKind::printed, CouponKind::cut}) {
        const auto plate = coupon({kind, 5, {}});
        REQUIRE(plate);
        const auto rows = form_of(*plate);
        const auto read = parse_form(form_text(rows), "x");
        REQUIRE(read);
        REQUIRE(read->size() == rows.size());
        for (std::size_t k = 0; k < rows.size(); ++k) {
            CHECK((*read)[k].name == rows[k].name);
            CHECK((*read)[k].kind == rows[k].kind);
            CHECK((*read)[k].nominal == Approx(rows[k].nominal).epsilon(1e-12));
            CHECK((*read)[k].measured.empty());
        }
    }
}

TEST_CASE("coupon forms: filled in by hand, or by spreadsheets of several countries") {
    const auto check = [](const std::string& text) {
        CAPTURE(text);
        const auto read = parse_form(text, "x");
        for (const Error& error : read.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(read);
        REQUIRE(read->size() == 2);
        CHECK((*read)[0].name == "H3");
        CHECK((*read)[0].kind == FeatureKind::hole);
        REQUIRE((*read)[0].measured.size() == 2);
        CHECK((*read)[0].measured[1] == Approx(2.85e-3));
        CHECK((*read)[1].nominal == Approx(100e-3));
        CHECK((*read)[1].measured.size() == 1);
    };
    check(head + "H3,hole,3,2.8,,2.85\nlong side,length,100,99.8,,\n");
    check("\xef\xbb\xbf" + head + "# a comment\n\nH3, hole, 3, 2.8, 2.85\r\n,,,,,\nlong side,length,100,99.8\r\n");
    check("feature;kind;nominal_mm;measured_1_mm;measured_2_mm\nH3;hole;3;2,8;2,85\nlong side;length;100,0;99,8;\n");
    check(
        "\"feature\",\"kind\",\"nominal_mm\",\"a\",\"b\"\n\"H3\",\"hole\",\"3\",\"2.8\",\"2.85\"\n\"long "
        "side\",\"length\",\"100\",\"99.8\",\n");
}

TEST_CASE("coupon forms: faults, each with its line") {
    CHECK(faults("") == "coupon.csv:1: it is empty; a form begins with " + head);
    CHECK(faults("a,b,c\n1,2,3\n") == "coupon.csv:1: this is no form of a coupon, which begins with " + head);
    CHECK(faults(head + "H3,hole\n").find("coupon.csv:2: a row has") == 0);
    CHECK(faults(head + "H3,hoel,3,2.8\n") == "coupon.csv:2: \"hoel\" is no kind of feature; did you mean \"hole\"?\n");
    CHECK(faults(head + "A,angle,3,2.8\n").find("no kind of feature") != std::string::npos);
    CHECK(faults(head + "H3,hole,three,2.8\n").find("nominal_mm is a number over 0") != std::string::npos);
    CHECK(faults(head + "H3,hole,3,2.8x\n").find("H3: a measurement is a number over 0 [mm], found \"2.8x\"") != std::string::npos);
    CHECK(faults(head + "H3,hole,3,nan\n") != "");
    CHECK(faults(head + "H3,hole,3,-2.8\n") != "");
    const std::string slip = faults(head + "H8,hole,8,7.8\nH3,hole,3,28\nP3,pin,3,0.3\n");
    CHECK(slip.find("coupon.csv:3: H3: 28 mm measured, where 3 mm was drawn: a slip?") == 0);
    CHECK(slip.find("coupon.csv:4") != std::string::npos);
}

}  // namespace fettle::design::coupons::coupon_form_test
