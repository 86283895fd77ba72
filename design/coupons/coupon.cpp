// SPDX-License-Identifier: MIT
#include "design/coupons/coupon.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "core/base/units.hpp"

namespace fettle::design::coupons {

namespace {

using tolerances::FeatureKind;

constexpr double mm = 1e-3;
constexpr double margin = 2.5 * mm;        // round everything
constexpr double row_space = 1.5 * mm;     // between rows
constexpr double label_space = 0.8 * mm;   // between a feature and its size
constexpr double beside = 2.2 * mm;        // between features, or between their labels
constexpr double beside_pins = 3.5 * mm;   // a caliper's jaws stand between
constexpr double row_length = 7 * mm;      // of slots, walls, gaps
constexpr double wall_height = 6.4 * mm;   // from the underside
constexpr double finger_length = 10 * mm;  // of a cut coupon
constexpr double largest_plate = 200 * mm;

/// A row: what is usual of it.
struct Row {
    FeatureKind kind;
    const char* letter;
    double from, up_to;  // [mm]
};
constexpr Row printed_rows[] = {{FeatureKind::hole, "H", 3, 8},
                                {FeatureKind::pin, "P", 2, 7},
                                {FeatureKind::slot, "S", 2, 7},
                                {FeatureKind::wall, "W", 1, 4},
                                {FeatureKind::gap, "G", 0.5, 3}};
constexpr Row cut_rows[] = {
    {FeatureKind::hole, "H", 3, 8}, {FeatureKind::slot, "S", 2, 7}, {FeatureKind::wall, "W", 2, 7}, {FeatureKind::gap, "G", 4, 9}};
constexpr Row heights{FeatureKind::height, "", 5, 9};

std::vector<Row> rows_of(CouponKind kind) {
    return kind == CouponKind::printed ? std::vector<Row>(std::begin(printed_rows), std::end(printed_rows))
                                       : std::vector<Row>(std::begin(cut_rows), std::end(cut_rows));
}

// Up to the next tenth of a millimetre: the sides are measured too.
double whole_tenths(double metres) { return std::ceil(metres / mm * 10 - 1e-6) / 10 * mm; }

class Layout {
public:
    explicit Layout(const CouponOptions& options) : options_(options) { coupon_.kind = options.kind; }

    Result<Coupon> make() {
        check();
        if (errors_.empty()) {
            options_.kind == CouponKind::printed ? place_printed() : place_cut();
            if (std::max(coupon_.width, coupon_.depth) > largest_plate)
                errors_.push_back({ErrorCode::out_of_range, "--sizes",
                                   "the plate would be " + size_text(coupon_.width) + " x " + size_text(coupon_.depth) +
                                       " mm; a coupon is up to 200 mm: ask for fewer --steps or smaller sizes"});
        }
        if (!errors_.empty()) return errors_;
        return std::move(coupon_);
    }

private:
    void check() {
        if (options_.steps < least_steps || options_.steps > most_steps)
            errors_.push_back({ErrorCode::out_of_range, "--steps",
                               "found " + std::to_string(options_.steps) + "; a coupon has " + std::to_string(least_steps) + " to " +
                                   std::to_string(most_steps) + " features of each kind"});
        const std::vector<FeatureKind> kinds = sized_kinds(options_.kind);
        for (const SizeRange& range : options_.sizes)
            if (std::find(kinds.begin(), kinds.end(), range.kind) == kinds.end())
                errors_.push_back({ErrorCode::unsupported, "--sizes",
                                   "a " + std::string(options_.kind == CouponKind::cut ? "cut" : "printed") + " coupon has no " +
                                       to_string(range.kind) + " features"});
        for (const FeatureKind kind : kinds) check_sizes(kind);
    }

    void check_sizes(FeatureKind kind) {
        const auto range = std::find_if(options_.sizes.begin(), options_.sizes.end(), [&](const auto& each) { return each.kind == kind; });
        if (range == options_.sizes.end() || options_.steps < least_steps || options_.steps > most_steps) return;
        const std::string name = to_string(kind), found = name + " " + size_text(range->from) + " to " + size_text(range->up_to) + " mm: ";
        const double least = kind == FeatureKind::height ? coupon_.thickness + 1 * mm : 0.1 * mm;
        if (!(range->from >= least - 1e-9 && range->up_to <= 40 * mm + 1e-9 && range->from < range->up_to))
            errors_.push_back(
                {ErrorCode::out_of_range, "--sizes", found + "sizes rise from at least " + size_text(least) + " to at most 40 mm"});
        else if ((range->up_to - range->from) / (options_.steps - 1) < 0.1 * mm - 1e-9)
            errors_.push_back(
                {ErrorCode::out_of_range, "--sizes",
                 found + "steps are at least 0.1 mm; take a wider range or fewer than " + std::to_string(options_.steps) + " --steps"});
    }

    std::vector<double> sizes_of(const Row& row) const {
        double from = row.from * mm, up_to = row.up_to * mm;
        for (const SizeRange& range : options_.sizes)
            if (range.kind == row.kind) from = range.from, up_to = range.up_to;
        std::vector<double> sizes;
        for (int k = 0; k < options_.steps; ++k)
            sizes.push_back(std::round((from + (up_to - from) * k / (options_.steps - 1)) / mm * 10) / 10 * mm);
        return sizes;
    }

    // How wide a feature stands on the plate.
    double width_of_feature(FeatureKind kind, double size) const { return kind == FeatureKind::gap ? size + 2 * coupon_.rib : size; }

    void add(const Row& row, double size, double x, double y, double length, double height) {
        coupon_.features.push_back({row.kind, row.letter + size_text(size), size, x, y, length, height});
    }

    void label(const std::string& text, double middle, double y) {
        coupon_.labels.push_back({text, middle - width_of(text, coupon_.font) / 2, y});
    }

    // Rows from below, the last kind first; labels below the features.
    void place_printed() {
        const double letter_width = width_of("W", coupon_.font) + beside;
        std::vector<Row> rows = rows_of(CouponKind::printed);
        std::reverse(rows.begin(), rows.end());
        double y = margin;
        for (const Row& row : rows) y = place_row(row, margin + letter_width, y) + row_space;
        coupon_.depth = whole_tenths(y - row_space + margin);
        coupon_.width = whole_tenths(coupon_.width + margin);
    }

    // @return where it ends
    double place_row(const Row& row, double x, double y) {
        const std::vector<double> sizes = sizes_of(row), tops = sizes_of(heights);
        const bool is_round = row.kind == FeatureKind::hole || row.kind == FeatureKind::pin;
        const double depth = is_round ? sizes.back() : row_length, foot = y + coupon_.font.height + label_space;
        coupon_.labels.push_back({row.letter, margin, foot + (depth - coupon_.font.height) / 2});
        for (std::size_t k = 0; k < sizes.size(); ++k) {
            const double own = width_of_feature(row.kind, sizes[k]), space = row.kind == FeatureKind::pin ? beside_pins : beside;
            const double text = width_of(size_text(sizes[k]), coupon_.font), pitch = std::max(own + space, text + beside);
            const double height = row.kind == FeatureKind::pin                                    ? tops[k]
                                  : row.kind == FeatureKind::wall || row.kind == FeatureKind::gap ? wall_height
                                                                                                  : 0;
            add(row, sizes[k], x + pitch / 2, foot + depth / 2, row_length, height);
            label(size_text(sizes[k]), x + pitch / 2, y);
            x += pitch;
        }
        coupon_.width = std::max(coupon_.width, x);
        return foot + depth;
    }

    void place_cut() {
        const std::vector<Row> rows = rows_of(CouponKind::cut);
        const double letter_width = width_of("W", coupon_.font) + beside;
        double y = margin;
        for (int k = 1; k >= 0; --k) y = place_row(rows[static_cast<std::size_t>(k)], margin + letter_width, y) + row_space;
        // Sizes of gaps above those of fingers; both letters at the left.
        const std::vector<double> walls = sizes_of(rows[2]), gaps = sizes_of(rows[3]);
        const double wall_text = y, gap_text = y + coupon_.font.height + label_space;
        coupon_.depth = gap_text + coupon_.font.height + margin;
        coupon_.labels.push_back({"W", margin, wall_text});
        coupon_.labels.push_back({"G", margin, gap_text});
        double x = margin + letter_width;
        for (std::size_t k = 0; k < walls.size(); ++k) {
            x += (k == 0 ? std::max(0.0, width_of(size_text(walls[k]), coupon_.font) - walls[k]) / 2 : 0);
            add(rows[2], walls[k], x + walls[k] / 2, coupon_.depth, finger_length, 0);
            label(size_text(walls[k]), x + walls[k] / 2, wall_text);
            x += walls[k];
            add(rows[3], gaps[k], x + gaps[k] / 2, coupon_.depth, finger_length, 0);
            label(size_text(gaps[k]), x + gaps[k] / 2, gap_text);
            x += gaps[k];
        }
        coupon_.width = whole_tenths(std::max(coupon_.width, x) + margin);  // beside the last gap stands a finger that is not measured
    }

    const CouponOptions& options_;
    Coupon coupon_;
    Errors errors_;
};

}  // namespace

std::string size_text(double metres) { return core::base::formatted("%g", std::round(metres / mm * 1e6) / 1e6); }

std::vector<FeatureKind> kinds_of(CouponKind kind) {
    std::vector<FeatureKind> kinds;
    for (const Row& row : rows_of(kind)) kinds.push_back(row.kind);
    return kinds;
}

std::vector<FeatureKind> sized_kinds(CouponKind kind) {
    std::vector<FeatureKind> kinds = kinds_of(kind);
    if (kind == CouponKind::printed) kinds.push_back(FeatureKind::height);
    return kinds;
}

Result<Coupon> coupon(const CouponOptions& options) { return Layout(options).make(); }

}  // namespace fettle::design::coupons
