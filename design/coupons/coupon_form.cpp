// SPDX-License-Identifier: MIT
#include "design/coupons/coupon_form.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/text.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/nearest_word.hpp"
#include "core/files/text_lines.hpp"

namespace fettle::design::coupons {

namespace {

using tolerances::FeatureKind;
using tolerances::MeasuredFeature;

constexpr double millimetre = 1e-3;
constexpr const char* heading = "feature,kind,nominal_mm,measured_1_mm,measured_2_mm,measured_3_mm";
constexpr std::string_view blanks = " \t\r\"";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> fields_of(std::string_view line, char separator) {
    std::vector<std::string> fields;
    for (std::size_t at = 0; at <= line.size();) {
        const std::size_t end = std::min(line.find(separator, at), line.size());
        fields.emplace_back(trimmed(line.substr(at, end - at)));
        at = end + 1;
    }
    return fields;
}

class FormReader {
public:
    explicit FormReader(const std::string& path) : path_(path) {}

    Result<std::vector<MeasuredFeature>> read(std::string_view text) {
        if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // as spreadsheets write it
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++line_;
            read_line(trimmed_line(text.substr(0, end)));
            text.remove_prefix(std::min(end + 1, text.size()));
            if (!has_heading_ && !errors_.empty()) break;
        }
        line_ = std::max(line_, 1);
        if (!has_heading_ && errors_.empty()) fail(ErrorCode::parse, std::string("it is empty; a form begins with ") + heading);
        if (!errors_.empty()) return errors_;
        return std::move(features_);
    }

private:
    static std::string_view trimmed_line(std::string_view line) {
        const std::size_t last = line.find_last_not_of(" \t\r");
        return last == std::string_view::npos ? std::string_view{} : line.substr(0, last + 1);
    }

    void fail(ErrorCode code, const std::string& message) { errors_.push_back({code, path_ + ":" + std::to_string(line_), message}); }

    void read_line(std::string_view line) {
        if (line.find_first_not_of(",; \t") == std::string_view::npos || trimmed(line).starts_with("#")) return;
        if (has_heading_) {
            read_row(fields_of(line, separator_));
            return;
        }
        separator_ = line.find(';') != std::string_view::npos ? ';' : ',';
        const std::vector<std::string> names = fields_of(line, separator_);
        has_heading_ = names.size() >= 4 && names[0] == "feature" && names[1] == "kind" && names[2] == "nominal_mm";
        if (!has_heading_) fail(ErrorCode::parse, std::string("this is no form of a coupon, which begins with ") + heading);
    }

    std::optional<double> number(std::string text) const {
        if (separator_ == ';') std::replace(text.begin(), text.end(), ',', '.');
        const auto value = core::files::parsed_number(text);
        return value && std::isfinite(*value) ? value : std::nullopt;
    }

    void read_row(const std::vector<std::string>& fields) {
        if (fields.size() < 3) {
            fail(ErrorCode::parse, "a row has a feature, its kind and its nominal size");
            return;
        }
        MeasuredFeature feature;
        feature.name = fields[0].empty() ? "line " + std::to_string(line_) : fields[0];
        std::vector<std::string_view> kinds = tolerances::feature_kind_names();
        std::erase(kinds, tolerances::to_string(FeatureKind::angle));
        const auto kind = tolerances::feature_kind(fields[1]);
        if (!kind || *kind == FeatureKind::angle) {
            fail(ErrorCode::out_of_range, "\"" + fields[1] + "\" is no kind of feature; " + core::files::did_you_mean(fields[1], kinds));
            return;
        }
        feature.kind = *kind;
        const auto nominal = number(fields[2]);
        if (!nominal || !(*nominal > 0)) {
            fail(ErrorCode::out_of_range, "nominal_mm is a number over 0, found \"" + fields[2] + "\"");
            return;
        }
        feature.nominal = *nominal * millimetre;
        for (std::size_t k = 3; k < fields.size(); ++k)
            if (!fields[k].empty()) read_measurement(fields[k], feature);
        features_.push_back(std::move(feature));
    }

    void read_measurement(const std::string& field, MeasuredFeature& feature) {
        const auto value = number(field);
        if (!value || !(*value > 0)) {
            fail(ErrorCode::out_of_range, feature.name + ": a measurement is a number over 0 [mm], found \"" + field + "\"" +
                                              (separator_ == ',' ? " (columns are separated by commas: the decimal sign is a point)" : ""));
            return;
        }
        if (std::abs(*value * millimetre - feature.nominal) > feature.nominal / 2 + millimetre) {
            fail(ErrorCode::out_of_range, feature.name + ": " + field + " mm measured, where " + size_text(feature.nominal) +
                                              " mm was drawn: a slip? Leave the cell empty if the feature failed");
            return;
        }
        feature.measured.push_back(*value * millimetre);
    }

    const std::string& path_;
    std::vector<MeasuredFeature> features_;
    Errors errors_;
    int line_ = 0;
    char separator_ = ',';
    bool has_heading_ = false;
};

}  // namespace

std::vector<MeasuredFeature> form_of(const Coupon& coupon) {
    std::vector<MeasuredFeature> form, heights;
    for (const FeatureKind kind : kinds_of(coupon.kind))
        for (const CouponFeature& feature : coupon.features) {
            if (feature.kind != kind) continue;
            form.push_back({feature.name, kind, feature.nominal, {}});
            if (kind == FeatureKind::pin) heights.push_back({feature.name + " top", FeatureKind::height, feature.height, {}});
        }
    form.insert(form.end(), heights.begin(), heights.end());
    form.push_back({"plate width", FeatureKind::length, coupon.width, {}});
    if (coupon.kind == CouponKind::printed) form.push_back({"plate depth", FeatureKind::length, coupon.depth, {}});
    return form;
}

std::string form_text(const std::vector<MeasuredFeature>& features) {
    std::string text = std::string(heading) + "\n";
    for (const MeasuredFeature& feature : features)
        text += core::base::csv_cell(feature.name) + "," + tolerances::to_string(feature.kind) + "," + size_text(feature.nominal) + ",,,\n";
    return text;
}

Result<std::vector<MeasuredFeature>> parse_form(const std::string& text, const std::string& path) { return FormReader(path).read(text); }

Result<std::vector<MeasuredFeature>> read_form(const std::string& path) {
    const Result<std::string> text = core::files::read_file(path);
    if (!text) return text.errors();
    return parse_form(*text, path);
}

}  // namespace fettle::design::coupons
