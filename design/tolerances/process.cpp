// SPDX-License-Identifier: MIT
#include "design/tolerances/process.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "design/tolerances/iso2768.hpp"
#include "design/tolerances/size_steps.hpp"

namespace fettle::design::tolerances {

namespace {

std::string kinds_of(const Process& process) {
    std::vector<std::string> names;
    for (const FeatureSpread& feature : process.features) names.emplace_back(to_string(feature.kind));
    return core::base::joined(names);
}

// t.
Result<double> half_width(const FeatureSpread& feature, double size, const std::string& where) {
    if (feature.general_class.empty())
        return std::max(feature.tolerance, size > feature.per_size_over + size_rounding ? feature.tolerance_per_size * size : 0);
    const Result<DeviationLimits> limits = iso2768_linear(feature.general_class, size, where);
    if (!limits) return limits.errors();
    return limits->upper;
}

Result<ProcessDeviation> angle_deviation(const FeatureSpread& length, double leg, const std::string& where) {
    if (!length.general_class.empty()) {
        const Result<DeviationLimits> limits = iso2768_angle(length.general_class, leg, where);
        if (!limits) return limits.errors();
        return ProcessDeviation{*limits, true};
    }
    const Result<double> width = half_width(length, leg, where);
    if (!width) return width.errors();
    return ProcessDeviation{{-*width / leg, *width / leg}, true};
}

}  // namespace

const char* to_string(FeatureKind kind) {
    switch (kind) {
        case FeatureKind::hole:
            return "hole";
        case FeatureKind::pin:
            return "pin";
        case FeatureKind::slot:
            return "slot";
        case FeatureKind::gap:
            return "gap";
        case FeatureKind::wall:
            return "wall";
        case FeatureKind::length:
            return "length";
        case FeatureKind::height:
            return "height";
        case FeatureKind::angle:
            return "angle";
    }
    return "";
}

std::optional<FeatureKind> feature_kind(std::string_view name) {
    for (const FeatureKind kind : feature_kinds)
        if (name == to_string(kind)) return kind;
    return std::nullopt;
}

std::vector<std::string_view> feature_kind_names() {
    std::vector<std::string_view> names;
    for (const FeatureKind kind : feature_kinds) names.emplace_back(to_string(kind));
    return names;
}

const FeatureSpread* find_feature(const Process& process, FeatureKind kind) {
    const auto found = std::find_if(process.features.begin(), process.features.end(), [&](const auto& each) { return each.kind == kind; });
    return found == process.features.end() ? nullptr : &*found;
}

Result<ProcessDeviation> process_deviation(const Process& process, FeatureKind kind, double size, const std::string& where) {
    const bool is_angle = kind == FeatureKind::angle;
    if (!std::isfinite(size)) return Error{ErrorCode::not_finite, where, "a size is a number"};
    if (size <= 0)
        return Error{ErrorCode::out_of_range, where,
                     is_angle
                         ? "the shorter leg of an angle is longer than 0"
                         : core::base::format_length(size, "mm") + " is no size of a feature: give this number a tolerance of its own"};
    const FeatureSpread* feature = find_feature(process, is_angle ? FeatureKind::length : kind);
    if (feature == nullptr)
        return Error{ErrorCode::unsupported, where,
                     "process \"" + process.name + "\" says nothing of " +
                         (is_angle ? "lengths, from which an angle would follow" : "features of the kind " + std::string(to_string(kind))) +
                         "; it has " + kinds_of(process)};
    if (is_angle) return angle_deviation(*feature, size, where);
    const Result<double> width = half_width(*feature, size, where);
    if (!width) return width.errors();
    const double known = std::clamp(size, feature->from, feature->up_to), bias = feature->bias + feature->bias_per_size * known;
    return ProcessDeviation{{bias - *width, bias + *width}, known == size};
}

SharedPart shared_part(const Process& process, FeatureKind kind) {
    const FeatureSpread* feature = find_feature(process, kind);
    const double correlation = feature != nullptr ? feature->correlation.value_or(process.correlation) : process.correlation;
    if (correlation == 0 || kind == FeatureKind::angle) return {};
    if (kind == FeatureKind::length || kind == FeatureKind::height) return {process.name + " " + to_string(kind) + "s", correlation};
    const bool is_inside = kind == FeatureKind::hole || kind == FeatureKind::slot || kind == FeatureKind::gap;
    return {process.name, is_inside ? -correlation : correlation};
}

}  // namespace fettle::design::tolerances
