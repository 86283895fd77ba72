// SPDX-License-Identifier: MIT
#include "design/tolerances/process_fit.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <numeric>
#include <set>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"

namespace fettle::design::tolerances {

namespace {

constexpr double confidence = 0.95;
constexpr double least_spread = 1e-9;  // more than rounding [m]
using DoublesAlone = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

// The t that |t| exceeds with probability `outside`.
double student_t(int freedom, double outside) {
    double complement = 0;
    const double x = boost::math::ibeta_inv(freedom / 2.0, 0.5, outside, &complement, DoublesAlone());
    return std::sqrt(freedom * complement / x);
}

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// r and its degrees of freedom.
void measure_repeatability(const std::vector<MeasuredFeature>& features, ProcessFit& fit) {
    double squares = 0;
    for (const MeasuredFeature& feature : features) {
        if (feature.measured.empty()) continue;
        const double mean = mean_of(feature.measured);
        for (const double x : feature.measured) squares += (x - mean) * (x - mean);
        fit.repeats += count_of(feature.measured) - 1;
    }
    fit.repeatability = fit.repeats > 0 ? std::sqrt(squares / fit.repeats) : 0;
}

/// The features of one kind, as columns.
struct Columns {
    VectorX size, off, measurements;  // d, y, m
    int count() const { return static_cast<int>(size.size()); }
};

/// A weighted line, or constant, through them.
struct Line {
    VectorX weights, residuals;
    double centre = 0, at_centre = 0, slope = 0;
    double weight = 0, moment = 0;  // sum w, sum w (d - centre)^2; 0 without a slope
};

Line line_through(const Columns& data, const VectorX& weights, bool has_slope) {
    Line line;
    line.weights = weights;
    line.weight = weights.sum();
    line.centre = weights.dot(data.size) / line.weight;
    line.at_centre = weights.dot(data.off) / line.weight;
    const VectorX d = data.size.array() - line.centre;
    if (has_slope) {
        line.moment = weights.dot(d.cwiseAbs2());
        line.slope = (weights.array() * d.array() * data.off.array()).sum() / line.moment;
    }
    line.residuals = data.off - line.slope * d - VectorX::Constant(data.count(), line.at_centre);
    return line;
}

double weighted_squares(const Line& line) { return line.weights.dot(line.residuals.cwiseAbs2()); }

VectorX variances(const Columns& data, double process_variance, double repeat_variance) {
    return process_variance + repeat_variance / data.measurements.array();
}

// The process' variance for which residuals are as large as their variances say; 0 where measuring alone says larger ones.
double process_variance(const Columns& data, double repeat_variance, int freedom, bool has_slope) {
    const auto excess = [&](double variance) {
        return weighted_squares(line_through(data, variances(data, variance, repeat_variance).cwiseInverse(), has_slope)) - freedom;
    };
    if (!(excess(0) > 0)) return 0;
    double low = 0, high = repeat_variance;
    while (excess(high) > 0) high *= 2;
    for (int k = 0; k < 100; ++k) {
        const double middle = (low + high) / 2;
        (excess(middle) > 0 ? low : high) = middle;
    }
    return (low + high) / 2;
}

VectorX weights_of(const Columns& data, double repeatability, int freedom, bool has_slope) {
    const bool is_even = (data.measurements.array() == data.measurements[0]).all();
    if (is_even || repeatability == 0) return VectorX::Ones(data.count());
    const double repeat = repeatability * repeatability, process = process_variance(data, repeat, freedom, has_slope);
    const double usual = process + repeat * data.measurements.cwiseInverse().mean();
    return usual * variances(data, process, repeat).cwiseInverse();
}

// @param measuring  Variance that measuring alone has: no feature lies out by less than that shows.
std::vector<OutlyingFeature> outliers_of(const std::vector<const MeasuredFeature*>& features, const Columns& data, const Line& line,
                                         int freedom, double measuring) {
    std::vector<OutlyingFeature> found;
    if (freedom < 2) return found;
    const double squares = weighted_squares(line), limit = student_t(freedom - 1, (1 - confidence) / data.count());
    for (int i = 0; i < data.count(); ++i) {
        const double w = line.weights[i], d = data.size[i] - line.centre, e2 = w * line.residuals[i] * line.residuals[i];
        const double leverage = w * (1 / line.weight + (line.moment > 0 ? d * d / line.moment : 0));
        if (!(leverage < 1)) continue;
        const double others = std::max({(squares - e2 / (1 - leverage)) / (freedom - 1), measuring, least_spread * least_spread});
        const double t = std::copysign(std::sqrt(e2 / (others * (1 - leverage))), line.residuals[i]);
        if (e2 > 0 && std::abs(t) > limit) found.push_back({features[i]->name, line.residuals[i], t});
    }
    return found;
}

void set_spread(double s, int f, double measuring, KindFit& fit) {
    const double tail = (1 - confidence) / 2;
    fit.degrees_of_freedom = f;
    fit.spread = {s, s * std::sqrt(f / chi_square_quantile(f, 1 - tail)), s * std::sqrt(f / chi_square_quantile(f, tail))};
    fit.spread_bound = s * std::sqrt(f / chi_square_quantile(f, 1 - confidence));
    fit.process_spread = std::sqrt(std::max(0.0, s * s - measuring));
}

/// What the features of one print come to.
struct PrintMean {
    int features = 0;
    double size = 0, off = 0;
};

// Fits several prints (process_fit.hpp). @param print  The print of each feature, 0 to prints - 1.
void fit_prints(const Columns& data, const std::vector<int>& print, double measuring, KindFit& fit) {
    std::vector<PrintMean> means(fit.prints);
    for (int i = 0; i < data.count(); ++i) ++means[print[i]].features;
    for (int i = 0; i < data.count(); ++i) {
        PrintMean& mean = means[print[i]];
        mean.size += data.size[i] / mean.features;
        mean.off += data.off[i] / mean.features;
    }
    double moment = 0, product = 0, squares = 0;
    for (int i = 0; i < data.count(); ++i) {
        const double d = data.size[i] - means[print[i]].size;
        moment += d * d;
        product += d * data.off[i];
    }
    fit.has_slope = fit.has_slope && moment > 0;  // sizes may differ between prints alone
    const double slope = fit.has_slope ? product / moment : 0;
    for (int i = 0; i < data.count(); ++i) {
        const PrintMean& mean = means[print[i]];
        squares += std::pow(data.off[i] - mean.off - slope * (data.size[i] - mean.size), 2);
    }
    const int f = data.count() - fit.prints - (fit.has_slope ? 1 : 0);
    set_spread(std::sqrt(squares / f), f, measuring, fit);
    // The prints' constants at their mean size.
    const double prints = fit.prints;
    double size = 0, reciprocals = 0, off = 0, between = 0;
    for (const PrintMean& mean : means) {
        size += mean.size / prints;
        reciprocals += 1.0 / mean.features / prints;
    }
    const auto at_size = [&](const PrintMean& mean) { return mean.off - slope * (mean.size - size); };
    for (const PrintMean& mean : means) off += at_size(mean) / prints;
    for (const PrintMean& mean : means) between += std::pow(at_size(mean) - off, 2) / (prints - 1);
    const double error = student_t(fit.prints - 1, 1 - confidence) * std::sqrt(between / prints);
    fit.mean_size = size;
    fit.bias = {off, off - error, off + error};
    if (fit.has_slope) {
        const double slope_error = student_t(f, 1 - confidence) * fit.spread.value / std::sqrt(moment);
        fit.bias_per_size = {slope, slope - slope_error, slope + slope_error};
    }
    fit.components = variance_components({between / reciprocals, squares / f, fit.prints - 1, f, 1 / reciprocals});
}

// The prints of the features, numbered from 0 without gaps.
std::vector<int> prints_of(const std::vector<const MeasuredFeature*>& features) {
    std::set<int> all;
    for (const MeasuredFeature* feature : features) all.insert(feature->print);
    std::vector<int> out;
    for (const MeasuredFeature* feature : features) out.push_back(static_cast<int>(std::distance(all.begin(), all.find(feature->print))));
    return out;
}

KindFit fit_kind(FeatureKind kind, const std::vector<const MeasuredFeature*>& features, double repeatability) {
    KindFit fit;
    fit.kind = kind;
    fit.features = count_of(features);
    Columns data{VectorX(fit.features), VectorX(fit.features), VectorX(fit.features)};
    std::set<double> sizes;
    for (int i = 0; i < fit.features; ++i) {
        const MeasuredFeature& feature = *features[i];
        data.size[i] = feature.nominal;
        data.off[i] = mean_of(feature.measured) - feature.nominal;
        data.measurements[i] = static_cast<double>(feature.measured.size());
        fit.measurements += count_of(feature.measured);
        sizes.insert(feature.nominal);
    }
    fit.from = *sizes.begin();
    fit.up_to = *sizes.rbegin();
    fit.has_slope = fit.features >= 5 && sizes.size() >= 3;
    const double measuring = repeatability * repeatability * data.measurements.cwiseInverse().mean();
    const std::vector<int> prints = prints_of(features);
    fit.prints = 1 + *std::max_element(prints.begin(), prints.end());
    if (fit.prints > 1) {
        if (fit.features < fit.prints + 2) fit.has_slope = false;
        if (fit.features > fit.prints) {
            fit_prints(data, prints, measuring, fit);
            return fit;
        }
        fit.prints = 1;  // one of each: as if they were of one print
    }
    const int f = fit.features - (fit.has_slope ? 2 : 1);
    const Line line = line_through(data, weights_of(data, repeatability, f, fit.has_slope), fit.has_slope);
    const double s = std::sqrt(weighted_squares(line) / f), t = student_t(f, 1 - confidence);
    const double bias_error = s / std::sqrt(line.weight);
    fit.mean_size = line.centre;
    fit.bias = {line.at_centre, line.at_centre - t * bias_error, line.at_centre + t * bias_error};
    if (fit.has_slope) {
        const double slope_error = s / std::sqrt(line.moment);
        fit.bias_per_size = {line.slope, line.slope - t * slope_error, line.slope + t * slope_error};
    }
    set_spread(s, f, measuring, fit);
    if (has_spread(fit)) fit.outliers = outliers_of(features, data, line, f, measuring);
    return fit;
}

}  // namespace

bool has_spread(const KindFit& fit) { return fit.spread.value > least_spread; }

double taken_spread(const KindFit& fit) {
    if (!fit.components) return fit.spread_bound;
    return fit.prints >= least_bounded_prints ? fit.components->total_bound : std::hypot(fit.spread_bound, fit.components->between.value);
}

double bias_at_no_size(const KindFit& fit) { return fit.bias.value - fit.bias_per_size.value * fit.mean_size; }

Result<ProcessFit> fit_process(const std::vector<MeasuredFeature>& features, const std::string& where) {
    ProcessFit fit;
    measure_repeatability(features, fit);
    std::set<int> prints;
    for (const MeasuredFeature& feature : features)
        if (!feature.measured.empty()) prints.insert(feature.print);
    fit.prints = std::max(1, count_of(prints));
    for (const FeatureKind kind : feature_kinds) {
        std::vector<const MeasuredFeature*> measured;
        for (const MeasuredFeature& feature : features) {
            FETTLE_ASSERT(feature.kind != FeatureKind::angle && feature.nominal > 0, "a size");
            if (feature.kind == kind && !feature.measured.empty()) measured.push_back(&feature);
        }
        if (count_of(measured) >= least_features)
            fit.kinds.push_back(fit_kind(kind, measured, fit.repeatability));
        else if (!measured.empty())
            fit.too_few.push_back({kind, count_of(measured)});
    }
    if (!fit.kinds.empty()) return fit;
    return Error{ErrorCode::out_of_range, where,
                 std::string(fit.too_few.empty() ? "nothing is measured" : "no kind of feature is measured often enough") +
                     "; bias and spread of a kind take at least " + std::to_string(least_features) +
                     " features of it, each measured once or more"};
}

Process fitted_process(const ProcessFit& fit, const std::string& name, const Process& base) {
    Process process = base;
    if (process.clearance) process.clearance->minimum_of = process.clearance->bands_of = base.name;
    process.name = name;
    process.description = "measured; what is not, as " + base.name;
    for (const KindFit& kind : fit.kinds) {
        FeatureSpread feature{kind.kind, bias_at_no_size(kind), kind.bias_per_size.value, 3 * taken_spread(kind)};
        if (kind.components) feature.correlation = kind.components->share.value;
        feature.from = kind.from;
        feature.up_to = kind.up_to;
        feature.source = core::base::counted(static_cast<std::size_t>(kind.features), "feature") + ", " +
                         core::base::counted(static_cast<std::size_t>(kind.measurements), "measurement") +
                         (kind.prints > 1 ? ", " + std::to_string(kind.prints) + " prints" : "");
        if (const FeatureSpread* usual = find_feature(base, kind.kind); usual != nullptr && !has_spread(kind)) {
            feature.tolerance = usual->tolerance;
            feature.tolerance_per_size = usual->tolerance_per_size;
            feature.per_size_over = usual->per_size_over;
            feature.general_class = usual->general_class;
        }
        std::erase_if(process.features, [&](const FeatureSpread& each) { return each.kind == kind.kind; });
        process.features.push_back(std::move(feature));
        if (kind.kind != FeatureKind::length || !process.clearance) continue;
        process.clearance->bands.clear();
        process.clearance->bands_of.clear();
    }
    std::sort(process.features.begin(), process.features.end(), [](const auto& a, const auto& b) { return a.kind < b.kind; });
    return process;
}

}  // namespace fettle::design::tolerances
