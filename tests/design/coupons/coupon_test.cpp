// SPDX-License-Identifier: MIT
#include "design/coupons/coupon.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "design/coupons/coupon_form.hpp"

namespace fettle::design::coupons::coupon_test {

namespace {

using tolerances::FeatureKind;

constexpr double mm = 1e-3;

struct Box {
    double left, right, low, high;
};

// What a feature takes of the plate.
Box box_of(const Coupon& coupon, const CouponFeature& feature) {
    const bool is_round = feature.kind == FeatureKind::hole || feature.kind == FeatureKind::pin;
    const double half = feature.nominal / 2 + (feature.kind == FeatureKind::gap && coupon.kind == CouponKind::printed ? coupon.rib : 0);
    const double high = is_round ? half : feature.length / 2;
    return {feature.x - half, feature.x + half, feature.y - high, feature.y + high};
}

double apart(const Box& a, const Box& b) {
    const double x = std::max(a.left - b.right, b.left - a.right), y = std::max(a.low - b.high, b.low - a.high);
    return std::max(x, y);
}

void check_room(const Coupon& coupon) {
    std::vector<Box> boxes;
    for (const CouponFeature& feature : coupon.features) {
        const bool is_finger = coupon.kind == CouponKind::cut && (feature.kind == FeatureKind::wall || feature.kind == FeatureKind::gap);
        if (!is_finger) boxes.push_back(box_of(coupon, feature));
    }
    for (const CouponLabel& label : coupon.labels)
        boxes.push_back({label.x, label.x + width_of(label.text, coupon.font), label.y, label.y + coupon.font.height});
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        CHECK(boxes[i].left > 1 * mm);
        CHECK(boxes[i].right < coupon.width - 1 * mm);
        CHECK(boxes[i].low > 1 * mm);
        CHECK(boxes[i].high < coupon.depth - 1 * mm);
        for (std::size_t j = 0; j < i; ++j) CHECK(apart(boxes[i], boxes[j]) > 0.7 * mm);
    }
}

}  // namespace

TEST_CASE("coupons: the usual one holds six of each kind, with room between them, on a small plate") {
    const auto plate = coupon({});
    REQUIRE(plate);
    std::map<FeatureKind, int> count;
    for (const CouponFeature& feature : plate->features) ++count[feature.kind];
    CHECK(count ==
          std::map<FeatureKind, int>{
              {FeatureKind::hole, 6}, {FeatureKind::pin, 6}, {FeatureKind::slot, 6}, {FeatureKind::gap, 6}, {FeatureKind::wall, 6}});
    CHECK(plate->width < 66 * mm);
    CHECK(plate->depth < 66.1 * mm);
    check_room(*plate);
    CHECK(plate->features.front().name == "G0.5");
    CHECK(form_of(*plate).size() == 6 * 6 + 2);
}

TEST_CASE("coupons: other numbers and sizes keep their room") {
    for (const CouponKind kind : {CouponKind::printed, CouponKind::cut}) {
        for (const int steps : {3, 4, 9, 12}) {
            CAPTURE(static_cast<int>(kind), steps);
            const auto plate = coupon({kind, steps, {}});
            for (const Error& error : plate.errors()) UNSCOPED_INFO(error.message);
            REQUIRE(plate);
            check_room(*plate);
        }
    }
    const auto large = coupon({CouponKind::printed, 4, {{FeatureKind::hole, 10 * mm, 25 * mm}, {FeatureKind::height, 4 * mm, 20 * mm}}});
    REQUIRE(large);
    check_room(*large);
    double highest = 0;
    for (const CouponFeature& feature : large->features) highest = std::max(highest, feature.height);
    CHECK(highest == Approx(20 * mm));
}

TEST_CASE("coupons: what cannot be made is refused with what can") {
    const auto fault = [](const CouponOptions& options) {
        const auto plate = coupon(options);
        REQUIRE(!plate);
        return plate.errors()[0].where + ": " + plate.errors()[0].message;
    };
    const CouponKind printed = CouponKind::printed;
    CHECK(fault({printed, 2, {}}).find("--steps: found 2; a coupon has 3 to 12") == 0);
    CHECK(fault({printed, 6, {{FeatureKind::hole, 8 * mm, 3 * mm}}}).find("hole 8 to 3 mm: sizes rise") != std::string::npos);
    CHECK(fault({printed, 6, {{FeatureKind::hole, 0, 3 * mm}}}).find("at least 0.1") != std::string::npos);
    CHECK(fault({printed, 6, {{FeatureKind::hole, 3 * mm, 50 * mm}}}).find("at most 40 mm") != std::string::npos);
    CHECK(fault({printed, 6, {{FeatureKind::hole, 3 * mm, 3.3 * mm}}}).find("steps are at least 0.1 mm") != std::string::npos);
    CHECK(fault({printed, 6, {{FeatureKind::length, 3 * mm, 9 * mm}}}).find("has no length features") != std::string::npos);
    CHECK(fault({CouponKind::cut, 6, {{FeatureKind::pin, 3 * mm, 9 * mm}}}).find("a cut coupon has no pin features") != std::string::npos);
    CHECK(fault({printed, 12, {{FeatureKind::hole, 20 * mm, 40 * mm}}}).find("a coupon is up to 200 mm") != std::string::npos);
    CHECK(fault({printed, 6, {{FeatureKind::height, 2 * mm, 9 * mm}}}).find("at least 3.4") != std::string::npos);
}

}  // namespace fettle::design::coupons::coupon_test
