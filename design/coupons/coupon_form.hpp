// SPDX-License-Identifier: MIT
/// The form for what was measured of a coupon, as a table (CSV) that people fill in by hand or in a spreadsheet:
///     feature,kind,nominal_mm,measured_1_mm,measured_2_mm,measured_3_mm
///     H3,hole,3,2.81,2.83,
/// Kinds: tolerances/process.hpp. Rows may be added (of lengths measured on other parts of the same machine) and left empty. Columns after
/// the third are measurements, as many as there are. A table whose columns are separated by semicolons may have decimal commas. Lines that
/// begin with # are comments.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/coupons/coupon.hpp"
#include "design/tolerances/process_fit.hpp"

namespace fettle::design::coupons {

/// What there is to measure of a coupon: its features, in rows; of a printed one also the pins' heights and the plate's two sides.
std::vector<tolerances::MeasuredFeature> form_of(const Coupon& coupon);

/// With empty columns for three measurements.
std::string form_text(const std::vector<tolerances::MeasuredFeature>& features);

/// Every row. Errors: not such a table (parse), each with its line; an unknown kind, a size that is none, a measurement that is a slip: not
/// over 0, or off by more than half of the nominal size and 1 mm (out_of_range).
Result<std::vector<tolerances::MeasuredFeature>> read_form(const std::string& path);
/// The same of a text in hand; `path` is the file's name in messages.
Result<std::vector<tolerances::MeasuredFeature>> parse_form(const std::string& text, const std::string& path);

}  // namespace fettle::design::coupons
