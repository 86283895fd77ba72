// SPDX-License-Identifier: MIT
#include "design/report/spread_charts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"

namespace fettle::design::report {

namespace {

using core::base::formatted;
using core::base::percent;
using core::base::xml_text;

constexpr double chart_width = 400;  // of all charts: on a phone a unit is then nearly a pixel

// An axis: values to places.
struct Scale {
    double from = 0, to = 1, first = 0, last = 1;  // values, places
    double operator()(double value) const { return first + (value - from) / (to - from) * (last - first); }
};

std::string number_text(double value) {
    const std::string text = formatted("%.6g", value);
    return text == "-0" ? "0" : text;
}

std::string with_unit(const std::string& text, const std::string& unit) { return unit.empty() ? text : text + " " + unit; }

std::string change_text(double value) { return value == 0 ? "0" : formatted("%+.3g", value); }

std::string text_at(double x, double y, const std::string& anchor, const std::string& text, const std::string& kind = {}) {
    return formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"", x, y, anchor.c_str()) +
           (kind.empty() ? "" : " class=\"" + kind + "\"") + ">" + xml_text(text) + "</text>\n";
}

std::string line_from(double x0, double y0, double x1, double y1, const std::string& kind) {
    return formatted("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" class=\"%s\"/>\n", x0, y0, x1, y1, kind.c_str());
}

std::string bar_at(double x0, double y, double x1, double height, const std::string& kind) {
    return formatted("<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" class=\"%s\"/>\n", std::min(x0, x1), y, std::abs(x1 - x0),
                     height, kind.c_str());
}

std::string chart(const std::string& title, double height, const std::string& inside) {
    return formatted("<svg class=\"spread\" viewBox=\"0 0 %.0f %.0f\" role=\"img\">\n", chart_width, height) + "<title>" + xml_text(title) +
           "</title>\n" + inside + "</svg>\n";
}

// The middle is left out of what is too long for its row.
std::string shortened(const std::string& name, std::size_t most) {
    std::vector<std::string> letters;  // of UTF-8
    for (const char c : name)
        if ((static_cast<unsigned char>(c) & 0xC0) == 0x80 && !letters.empty())
            letters.back() += c;
        else
            letters.emplace_back(1, c);
    if (letters.size() <= most) return name;
    std::string out;
    for (std::size_t k = 0; k < most / 3; ++k) out += letters[k];
    out += "\u2026";
    for (std::size_t k = letters.size() - (most - most / 3 - 1); k < letters.size(); ++k) out += letters[k];
    return out;
}

// From the least to the most of them, and a little more; never of no width.
Scale scale_of(double least, double most, double first, double last) {
    double room = 0.04 * (most - least);
    if (!(room > 0)) room = least == 0 ? 1 : 0.01 * std::abs(least);
    return {least - room, most + room, first, last};
}

struct Bins {
    double from = 0, width = 1;
    std::vector<double> shares;  // of all that was counted, those outside of the bins too
};

Bins counted(const std::vector<double>& values, double from, double width, int count) {
    Bins bins{from, width, std::vector<double>(count, 0)};
    for (const double value : values) {
        const auto k = static_cast<long>(std::floor((value - from) / width));
        if (k >= 0 && k < count) bins.shares[static_cast<std::size_t>(k)] += 1 / static_cast<double>(values.size());
    }
    return bins;
}

// Freedman and Diaconis' width, of which there are 8 to 40.
int bin_count(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    const double middle_half = values[3 * n / 4 < n ? 3 * n / 4 : n - 1] - values[n / 4];
    const double width = 2 * middle_half / std::cbrt(static_cast<double>(n)), all = values.back() - values.front();
    return !(width > 0) ? 8 : static_cast<int>(std::clamp(std::ceil(all / width), 8.0, 40.0));
}

std::string axis_below(const Scale& x, double y, const std::string& label) {
    std::string out = line_from(x.first, y, x.last, y, "axis");
    for (const double value : round_numbers(x.from, x.to, 4)) {
        out += line_from(x(value), y, x(value), y + 4, "axis");
        const std::string text = number_text(value);
        const double half = 4.2 * static_cast<double>(text.size());  // of its width, nearly: numbers at the ends stay within the chart
        out += text_at(std::clamp(x(value), half, chart_width - half), y + 17, "middle", text, "faint");
    }
    return out + text_at((x.first + x.last) / 2, y + 35, "middle", shortened(label, 44));
}

// Words of a mark above a chart, each in a row of its own, so that none lies over another.
std::string mark_words(const ChartMark& mark, int row, const Scale& x, const std::string& unit) {
    const double y = 13 + 15 * row;
    const std::string value = mark.text + " " + with_unit(number_text(mark.value), unit);
    if (mark.value < x.from) return text_at(x.first, y, "start", "\u2190 " + value, mark.kind);
    if (mark.value > x.to) return text_at(x.last, y, "end", value + " \u2192", mark.kind);
    const double at = x(mark.value);
    const bool is_left = at < (x.first + x.last) / 2;
    return text_at(is_left ? at + 4 : at - 4, y, is_left ? "start" : "end", value, mark.kind);
}

// Its line, from its words down; none where it is farther off.
std::string mark_line(const ChartMark& mark, int row, const Scale& x, double bottom) {
    if (mark.value < x.from || mark.value > x.to) return {};
    return line_from(x(mark.value), 4 + 15 * row, x(mark.value), bottom, mark.kind);
}

}  // namespace

std::vector<double> round_numbers(double least, double most, int count) {
    FETTLE_ASSERT(least <= most && std::isfinite(least) && std::isfinite(most), "a range of finite numbers");
    if (!(most > least)) return {least};
    const double raw = (most - least) / std::max(count, 1), ten = std::pow(10, std::floor(std::log10(raw)));
    double step = 10 * ten;
    for (const double each : {1.0, 2.0, 5.0})
        if (each * ten >= raw) {
            step = each * ten;
            break;
        }
    std::vector<double> out;
    for (double k = std::ceil(least / step); k * step <= most && out.size() < 1000; ++k) out.push_back(k * step);
    return out;
}

std::string tornado_svg(const std::string& title, const std::vector<TornadoBar>& bars, const std::string& unit) {
    constexpr double row = 42, bar = 8, side = 84;
    double reach = 0;
    for (const TornadoBar& each : bars) reach = std::max({reach, std::abs(each.at_lower), std::abs(each.at_upper)});
    const Scale x{-1, 1, side, chart_width - side};
    const auto place = [&](double change) { return x(reach > 0 ? change / reach : 0); };
    const double height = row * static_cast<double>(bars.size()) + 4;
    std::string out;
    for (std::size_t k = 0; k < bars.size(); ++k) {
        const TornadoBar& each = bars[k];
        const double top = row * static_cast<double>(k);
        const auto [least, most] = std::minmax(each.at_lower, each.at_upper);
        out += "<g><title>" +
               xml_text(each.of + (each.limits.empty() ? "" : ", " + each.limits) + ": " + with_unit(change_text(each.at_lower), unit) +
                        " at the lower limit, " + with_unit(change_text(each.at_upper), unit) + " at the upper one; " +
                        percent(each.share) + " of the variance") +
               "</title>\n";
        out += text_at(0, top + 14, "start", shortened(each.of, 42));
        out += text_at(chart_width, top + 14, "end", percent(each.share), "faint");
        out += bar_at(place(0), top + 20, place(each.at_lower), bar, "lower");
        out += bar_at(place(0), top + 20 + bar, place(each.at_upper), bar, "upper");
        out += text_at(side - 6, top + 32, "end", change_text(least));
        out += text_at(chart_width - side + 6, top + 32, "start", change_text(most));
        out += "</g>\n";
    }
    for (std::size_t k = 0; k < bars.size(); ++k)
        out += line_from(x(0), row * static_cast<double>(k) + 18, x(0), row * static_cast<double>(k) + 38, "axis");
    return chart(title, height, out);
}

std::string histogram_svg(const std::string& title, const std::vector<double>& values, const std::vector<double>& predicted,
                          const std::vector<ChartMark>& marks, const std::string& unit) {
    FETTLE_ASSERT(!values.empty(), "a histogram of something");
    constexpr double below = 42, plot = 150;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double spread = *most - *least;
    double from = *least, to = *most;
    for (const ChartMark& mark : marks)  // those that are near
        if (mark.value > *least - spread && mark.value < *most + spread) {
            from = std::min(from, mark.value);
            to = std::max(to, mark.value);
        }
    const double top = 15 * static_cast<double>(marks.size()) + 8, bottom = top + plot;
    const Scale x = scale_of(from, to, 8, chart_width - 8);
    const double bin = spread > 0 ? spread / bin_count(values) : (x.to - x.from) / 20;
    const double first = spread > 0 ? *least - bin * std::ceil((*least - x.from) / bin) : *least - bin / 2 - 9 * bin;
    const int count = std::max(1, static_cast<int>(std::ceil((x.to - first) / bin)));
    // The largest of all falls on the end of the last bin.
    std::vector<double> inside = values;
    for (double& value : inside) value = std::min(value, *most - 1e-9 * spread);
    const Bins found = counted(inside, first, bin, count), wanted = counted(predicted, first, bin, count);
    double tallest = *std::max_element(found.shares.begin(), found.shares.end());
    if (!predicted.empty()) tallest = std::max(tallest, *std::max_element(wanted.shares.begin(), wanted.shares.end()));
    const auto y = [&](double share) { return bottom - plot * share / (tallest > 0 ? tallest : 1); };
    const auto place = [&](double value) { return std::clamp(x(value), x.first, x.last); };
    std::string out;
    for (int k = 0; k < count; ++k) {
        const double share = found.shares[static_cast<std::size_t>(k)];
        if (share == 0) continue;
        const double left = first + bin * k;
        out += "<g><title>" + xml_text(percent(share) + " from " + number_text(left) + " to " + with_unit(number_text(left + bin), unit)) +
               "</title>" + bar_at(place(left) + 0.5, y(share), place(left + bin) - 0.5, bottom - y(share), "bin") + "</g>\n";
    }
    if (!predicted.empty()) {
        std::string path;
        for (int k = 0; k < count; ++k) {
            const double at = y(wanted.shares[static_cast<std::size_t>(k)]);
            path += formatted("%s%.2f %.2f", path.empty() ? "M" : "L", place(first + bin * (k + 0.5)), at);
        }
        out += "<path class=\"predicted\" d=\"" + path + "\"/>\n";
    }
    out += axis_below(x, bottom, unit.empty() ? "value" : unit);
    for (std::size_t k = 0; k < marks.size(); ++k) out += mark_line(marks[k], static_cast<int>(k), x, bottom);
    for (std::size_t k = 0; k < marks.size(); ++k) out += mark_words(marks[k], static_cast<int>(k), x, unit);
    return chart(title, bottom + below, out);
}

std::string scatter_svg(const std::string& title, const std::vector<ScatterPoint>& points, const std::vector<ChartMark>& limits,
                        const std::string& x_label, const std::string& y_label) {
    FETTLE_ASSERT(!points.empty(), "a scatter of something");
    constexpr double top = 26, plot = 200, bottom = top + plot, left = 64, failed_row = 16;
    double x0 = points.front().x, x1 = x0, y0 = 0, y1 = 0;
    bool is_first = true;
    for (const ScatterPoint& point : points) {
        x0 = std::min(x0, point.x);
        x1 = std::max(x1, point.x);
        if (!point.y) continue;
        y0 = is_first ? *point.y : std::min(y0, *point.y);
        y1 = is_first ? *point.y : std::max(y1, *point.y);
        is_first = false;
    }
    const double least = y0, most = y1;
    for (const ChartMark& limit : limits)  // those that are near
        if (limit.value > least - (most - least) && limit.value < most + (most - least)) {
            y0 = std::min(y0, limit.value);
            y1 = std::max(y1, limit.value);
        }
    const Scale x = scale_of(x0, x1, left, chart_width - 8), y = scale_of(y0, y1, bottom - failed_row, top);
    std::string out = text_at(0, 13, "start", shortened(y_label, 48));
    for (const double value : round_numbers(y.from, y.to, 5)) {
        out += line_from(x.first, y(value), x.last, y(value), "grid");
        out += text_at(left - 6, y(value) + 4, "end", number_text(value), "faint");
    }
    out += axis_below(x, bottom, x_label);
    std::string met, missed, failed;
    for (const ScatterPoint& point : points) {
        const double at = x(point.x);
        if (!point.y)
            failed += formatted("M%.1f %.1fl4 9h-8z", at, bottom - 12);
        else if (point.is_met)
            met += formatted("M%.1f %.1fh0", at, y(*point.y));
        else
            missed += formatted("M%.1f %.1fl5 5m0-5l-5 5", at - 2.5, y(*point.y) - 2.5);
    }
    for (const auto& [kind, path] : {std::pair("met", met), std::pair("missed", missed), std::pair("failed", failed)})
        if (!path.empty()) out += std::string("<path class=\"") + kind + "\" d=\"" + path + "\"/>\n";
    for (const ChartMark& limit : limits) {
        if (limit.value < y.from || limit.value > y.to) continue;
        out += line_from(x.first, y(limit.value), x.last, y(limit.value), limit.kind);
        out += text_at(x.last - 2, y(limit.value) - 4, "end", limit.text, limit.kind);
    }
    return chart(title, bottom + 42, out);
}

}  // namespace fettle::design::report
