// SPDX-License-Identifier: MIT
/// The features of a coupon and their places: the test plate shows what a printer or a laser makes of holes, pins, slots, walls and gaps. A
/// row for each kind, its letter (H, P, S, W, G) at the left, the size [mm] below each feature. Its solid: coupon_solid.hpp; the form for
/// what is measured: coupon_form.hpp.
///   printed  holes and slots through the plate; pins, walls and pairs of walls (the gap is between them) on it; pins are of different
///            heights, which are measured from the plate's underside
///   cut      holes and slots; on the upper edge fingers (walls) with gaps between them
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/coupons/stroke_font.hpp"
#include "design/tolerances/process.hpp"

namespace fettle::design::coupons {

enum class CouponKind { printed, cut };

struct SizeRange {
    tolerances::FeatureKind kind = tolerances::FeatureKind::hole;
    double from = 0, up_to = 0;  ///< [m]
};

struct CouponOptions {
    CouponKind kind = CouponKind::printed;
    int steps = 6;                 ///< features of each kind
    std::vector<SizeRange> sizes;  ///< of kinds that are not to have the usual ones
};
inline constexpr int least_steps = 3, most_steps = 12;

struct CouponFeature {
    tolerances::FeatureKind kind = tolerances::FeatureKind::hole;
    std::string name;     ///< "H3"
    double nominal = 0;   ///< [m]
    double x = 0, y = 0;  ///< of its middle [m]; of a finger, of its foot
    double length = 0;    ///< of slots, walls, gaps along y [m]
    double height = 0;    ///< of what stands on the plate, from its underside [m]
};
struct CouponLabel {
    std::string text;
    double x = 0, y = 0;  ///< lower left corner [m]
};

/// The plate's lower left corner is the origin.
struct Coupon {
    CouponKind kind = CouponKind::printed;
    double width = 0, depth = 0;   ///< [m]; of a cut one without its fingers
    double thickness = 2.4e-3;     ///< [m]
    double label_height = 0.6e-3;  ///< of labels over the plate [m]
    double rib = 1.2e-3;           ///< thickness of the walls beside a gap [m]
    StrokeFont font;
    std::vector<CouponFeature> features;
    std::vector<CouponLabel> labels;
};

/// A size as labels and forms have it, in millimetres: "3.5".
std::string size_text(double metres);

/// Kinds that such a coupon has, in the order of its rows.
std::vector<tolerances::FeatureKind> kinds_of(CouponKind kind);

/// Kinds whose sizes can be asked for: those, and of a printed one heights, of its pins' tops.
std::vector<tolerances::FeatureKind> sized_kinds(CouponKind kind);

/// Sizes in equal steps, rounded to 0.1 mm.
/// Errors (out_of_range): steps, a range that is empty or whose steps would round to the same size, sizes that cannot be made or measured
/// (over 0.1 mm, up to 40 mm), a plate of more than 200 mm; unsupported: a kind that the coupon does not have.
Result<Coupon> coupon(const CouponOptions& options);

}  // namespace fettle::design::coupons
