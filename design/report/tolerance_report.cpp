// SPDX-License-Identifier: MIT
#include "design/report/tolerance_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/files/atomic_file.hpp"
#include "design/answers/run_folder.hpp"
#include "design/answers/tolerance_json.hpp"
#include "design/description/independent_inputs.hpp"
#include "design/description/requirement_text.hpp"
#include "design/report/report_page.hpp"
#include "design/report/spread_charts.hpp"

namespace fettle::design::report {

namespace {

using core::base::counted;
using core::base::formatted;
using core::base::percent;
using core::base::xml_text;
using description::CountedUnit;
using description::Tolerance;
using studies::confidence;
using studies::Contribution;
using studies::has_bounds;
using studies::MadeSample;
using studies::Response;
using studies::SampledResponse;

constexpr std::size_t most_bars = 16;
constexpr double dust = 1e-3;            // a share of the variance that is not worth a bar
constexpr int predicted_samples = 8192;  // of the prediction alone, for its line in the histograms
constexpr double group_reach = 3;        // standard deviations of what a group shares, drawn as its limits

constexpr const char* chart_style = R"css(
.spread { display: block; width: 100%; max-width: 30rem; height: auto; font: 12.5px var(--font); }
.spread text { fill: var(--ink); }
.spread .faint { fill: var(--muted); }
.spread .axis { stroke: var(--line-strong); }
.spread .grid { stroke: var(--line); }
.spread .lower { fill: var(--line-strong); stroke: var(--muted); stroke-width: 0.75; }
.spread .upper, .spread .bin { fill: var(--accent); }
.spread .bin { opacity: 0.55; }
.spread .predicted { fill: none; stroke: var(--ink); stroke-width: 1.5; }
.spread line.drawn { stroke: var(--ink); stroke-width: 1.5; }
.spread line.mean { stroke: var(--accent); stroke-width: 1.5; stroke-dasharray: 2 3; }
.spread line.limit { stroke: var(--bad); stroke-width: 1.5; stroke-dasharray: 6 4; }
.spread text.drawn, .spread text.mean, .spread text.limit { paint-order: stroke; stroke: var(--paper); stroke-width: 4px; stroke-linejoin: round; }
.spread text.mean { fill: var(--accent); }
.spread text.limit { fill: var(--bad); }
.spread .met { fill: none; stroke: var(--accent); stroke-width: 4; stroke-linecap: round; opacity: 0.55; }
.spread .missed { fill: none; stroke: var(--bad); stroke-width: 1.25; }
.spread .failed { fill: none; stroke: var(--open); stroke-width: 1.5; }
.keys { display: flex; flex-wrap: wrap; gap: 0.15rem 1.1rem; margin-top: 0.4rem; font-size: var(--s-1); color: var(--muted); }
.keys svg { display: inline-block; width: 1.2rem; height: 0.75rem; margin-right: 0.4rem; vertical-align: -0.05rem; }
main, footer { overflow-wrap: anywhere; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; font: var(--s-1)/1.5 var(--mono); margin-top: 0.75rem; }
summary { cursor: pointer; }
h2 small { font-weight: 400; color: var(--muted); font-size: var(--s-1); }
)css";

std::string element(const std::string& tag, const std::string& inside, const std::string& kind = {}) {
    return "<" + tag + (kind.empty() ? "" : " class=\"" + kind + "\"") + ">" + inside + "</" + tag + ">\n";
}

std::string list_of(const std::vector<std::string>& texts, const std::string& kind) {
    std::string out;
    for (const std::string& text : texts) out += element("li", xml_text(text));
    return texts.empty() ? "" : element("ul", out, kind);
}

// Cells of texts: the head, then the rows; with `data-label` each stands with its head where the page is narrow.
std::string table_of(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
    std::string heads, body;
    for (const std::string& name : head) heads += "<th scope=\"col\">" + xml_text(name) + "</th>";
    for (const auto& row : rows) {
        std::string cells;
        for (std::size_t k = 0; k < row.size(); ++k)
            cells += "<td data-label=\"" + xml_text(k == 0 ? "" : head[k]) + "\"" + (row[k].empty() ? " class=\"nothing\"" : "") + ">" +
                     xml_text(row[k]) + "</td>";
        body += element("tr", cells);
    }
    return element("div", element("table", "<thead><tr>" + heads + "</tr></thead><tbody>" + body + "</tbody>", "stacked"), "table-frame");
}

// A line of a legend: a drawing as the chart has it, and what it is.
std::string key_of(const std::string& drawing, const std::string& words) {
    return element("li", "<svg class=\"spread\" viewBox=\"0 0 16 10\" aria-hidden=\"true\">" + drawing + "</svg>" + xml_text(words));
}

std::string figure_of(const std::string& caption, const std::string& chart, const std::string& keys) {
    return element("figure",
                   element("figcaption", element("h3", xml_text(caption))) + chart + (keys.empty() ? "" : element("ul", keys, "keys")));
}

std::string yield_text(double within) { return formatted("%.4g%%", 100 * within); }
std::string yield_text(const tolerances::CountedYield& yield) {
    return yield_text(yield.found.within) + " (" + yield_text(yield.least.within) + " to " + yield_text(yield.most.within) + ")";
}
std::string index_text(const std::optional<tolerances::CapabilityIndex>& index) {
    return index ? formatted("%.3g \u00b1 %.2g", index->value, index->error) : std::string();
}

class Page {
public:
    explicit Page(const ToleranceReportSource& source)
        : source_(source), file_(source.file), study_(source.study), deviations_(deviations_of_predictions()) {}

    std::string all() const {
        std::string main = "<section id=\"hero\" class=\"plain\" aria-label=\"The verdict\"><header id=\"verdict\" tabindex=\"-1\">" +
                           element("h1", xml_text(name())) + lead() + facts() + list_of(notices(), "notices") + "</header></section>\n";
        std::string sections;
        if (study_.reason.empty()) sections += table_of_responses();
        if (study_.reason.empty())
            for (const Response* response : worst_first()) sections += of_response(*response);
        sections += failures() + section("Tolerances", "What deviates, by how much.", table_of_tolerances());
        sections +=
            "<section><details><summary>All of it as text</summary>" + element("pre", xml_text(source_.answer)) + "</details></section>";
        main += "<div id=\"sections\">" + sections + "</div>";
        return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
               "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light "
               "dark\">\n"
               "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:\">\n"
               "<link rel=\"icon\" href=\"data:,\">\n<title>" +
               xml_text(name()) + " \u2013 fettle tolerances</title>\n<style>" + std::string(page_style()) + chart_style +
               "</style>\n</head>\n<body>\n<div class=\"topbar\"><span class=\"brand\">fettle<span "
               "class=\"brand-kind\">tolerances</span></span></div>\n" +
               element("main", main) + footer() + "</body>\n</html>\n";
    }

private:
    std::string name() const {
        const std::string file = std::filesystem::path(file_.path).filename().string();
        const std::string ending = ".design.json";
        return file.ends_with(ending) ? file.substr(0, file.size() - ending.size()) : file;
    }

    std::vector<VectorX> deviations_of_predictions() const {
        std::vector<VectorX> out;
        if (study_.samples.empty()) return out;
        const description::DeviationSamples samples(file_.tolerances, study_.seed + 1);
        for (int k = 0; k < predicted_samples; ++k) out.push_back(samples.at(k));
        return out;
    }

    std::size_t failed_count() const {
        return static_cast<std::size_t>(
            std::count_if(study_.samples.begin(), study_.samples.end(), [](const MadeSample& sample) { return sample.failed(); }));
    }

    std::string lead() const {
        std::string head, rest;
        if (!study_.reason.empty()) {
            head = "Undecided.";
            rest = study_.reason;
        } else if (!study_.samples.empty()) {
            const int n = count_of(study_.samples);
            head = formatted("%d of %d samples meet every requirement", study_.met_all, n);
            rest = "\u2013 a yield of " + yield_text(tolerances::counted_yield(study_.met_all, n, confidence)) +
                   formatted(" at %.0f%% confidence.", 100 * confidence);
            if (const std::size_t failed = failed_count(); failed > 0)
                rest += " " + counted(failed, "sample") + " could not be made or simulated.";
        } else {
            const Response* worst = nullptr;
            for (const Response& response : study_.responses)
                if (has_bounds(response) && (worst == nullptr || response.linear_yield.within < worst->linear_yield.within))
                    worst = &response;
            head = worst == nullptr ? "No requirement is at stake." : "Predicted, not sampled.";
            if (worst != nullptr)
                rest = worst->name + " is met least often: by the linear prediction in " + yield_text(worst->linear_yield.within) +
                       " of what is made.";
        }
        return element("p", element("strong", xml_text(head)) + " " + xml_text(rest), "lead");
    }

    std::string facts() const {
        const auto fact = [](const std::string& term, const std::string& value, const std::string& small) {
            return element("div", element("dt", xml_text(term)) +
                                      element("dd", xml_text(value) + (small.empty() ? "" : element("small", xml_text(small)))));
        };
        std::string out =
            fact("Tolerances", std::to_string(file_.tolerances.size()), file_.process.empty() ? "" : "process " + file_.process);
        if (!study_.samples.empty())
            out += fact("Samples", std::to_string(study_.samples.size()),
                        formatted("seed %llu", static_cast<unsigned long long>(study_.seed)));
        const Response* least = nullptr;
        for (const Response& response : study_.responses)
            if (response.sampled && response.sampled->capability.cpk &&
                (least == nullptr || response.sampled->capability.cpk->value < least->sampled->capability.cpk->value))
                least = &response;
        if (least != nullptr) out += fact("Least Cpk", formatted("%.3g", least->sampled->capability.cpk->value), least->name);
        if (study_.controlled_yield)
            out += fact("Yield, prediction as control", yield_text(study_.controlled_yield->found.within),
                        yield_text(study_.controlled_yield->least.within) + " to " + yield_text(study_.controlled_yield->most.within));
        return element("dl", out, "facts");
    }

    std::vector<std::string> notices() const {
        std::vector<std::string> out;
        if (study_.interrupted) out.emplace_back("Interrupted: these are the samples that were made by then.");
        if (!study_.no_second_order.empty())
            out.push_back("There is no second order, as the design cannot be simulated " + study_.no_second_order + ".");
        for (const reading::Untoleranced& each : file_.untoleranced)
            out.push_back("Without a tolerance: " + each.name + ", " + each.why + ".");
        return out;
    }

    static std::string section(const std::string& title, const std::string& intro, const std::string& inside) {
        return element("section",
                       element("h2", xml_text(title)) + (intro.empty() ? "" : element("p", xml_text(intro), "section-intro")) + inside);
    }

    double unit_of_tolerance(const Tolerance& tolerance) const {
        return core::base::to_si(1, file_.design.parameters[tolerance.parameter].unit);
    }
    std::string unit_name_of(const Tolerance& tolerance) const {
        return std::string(file_.design.parameters[tolerance.parameter].unit.name);
    }
    std::string limits_text(const Tolerance& tolerance) const {
        const double one = unit_of_tolerance(tolerance);
        return formatted("%+.4g to %+.4g ", tolerance.deviation.lower / one, tolerance.deviation.upper / one) + unit_name_of(tolerance);
    }

    std::string table_of_tolerances() const {
        std::vector<std::vector<std::string>> rows;
        for (const Tolerance& tolerance : file_.tolerances) {
            const double sigma = moments_of(tolerance.deviation).standard_deviation / unit_of_tolerance(tolerance);
            rows.push_back({tolerance.of, tolerance.stated, limits_text(tolerance), to_string(tolerance.deviation.kind),
                            formatted("%.4g ", sigma) + unit_name_of(tolerance), tolerance.group});
        }
        return table_of({"Of", "Stated", "Limits", "Distribution", "Sigma", "Shares with"}, rows);
    }

    // The share that meets it: of the samples, else by the linear prediction; all where nothing is required.
    double share_met(const Response& response) const {
        if (!has_bounds(response)) return 2;
        return response.sampled ? tolerances::counted_yield(response.sampled->met, count_of(study_.samples), confidence).found.within
                                : response.linear_yield.within;
    }

    // Those that are met least often, then those of which nothing is required.
    std::vector<const Response*> worst_first() const {
        std::vector<const Response*> out;
        for (const Response& response : study_.responses) out.push_back(&response);
        std::stable_sort(out.begin(), out.end(), [&](const Response* a, const Response* b) {
            return std::pair(share_met(*a), a->linear_yield.within) < std::pair(share_met(*b), b->linear_yield.within);
        });
        return out;
    }

    std::string table_of_responses() const {
        const bool is_sampled = !study_.samples.empty();
        std::vector<std::string> head{"Of", "As drawn", "Required", "Sigma", "Yield, predicted"};
        if (is_sampled) head.emplace_back("Yield, sampled");
        head.emplace_back("Most by");
        std::vector<std::vector<std::string>> rows;
        for (const Response* response : worst_first()) {
            const CountedUnit unit = answers::unit_of(file_.design, *response);
            const auto amount = [&](double si) { return description::amount_text(si, unit.si, unit.name, 5); };
            const bool judged = has_bounds(*response);
            rows.push_back({response->name, amount(response->nominal),
                            judged ? description::required_text(response->bounds, unit.name) : "",
                            amount(response->linear.standard_deviation), judged ? yield_text(response->linear_yield.within) : ""});
            if (is_sampled)
                rows.back().push_back(judged && response->sampled ? yield_text(tolerances::counted_yield(
                                                                        response->sampled->met, count_of(study_.samples), confidence))
                                                                  : "");
            const auto most = std::max_element(response->contributions.begin(), response->contributions.end(),
                                               [](const Contribution& a, const Contribution& b) { return a.share < b.share; });
            const bool is_moved = most != response->contributions.end() && most->share > 0;
            rows.back().push_back(is_moved ? most->of + " (" + percent(most->share) + ")" : "");
        }
        return section("All at a glance", "Worst first. Each has its own part below, in this order.", table_of(head, rows));
    }

    std::string of_response(const Response& response) const {
        const CountedUnit unit = answers::unit_of(file_.design, response);
        const auto amount = [&](double si) { return description::amount_text(si, unit.si, unit.name, 5); };
        std::string intro = amount(response.nominal) + " as drawn";
        if (has_bounds(response)) intro += ", required " + description::required_text(response.bounds, unit.name);
        std::string figures = tornado(response, unit);
        if (response.sampled) figures += histogram(response, unit) + scatter(response, unit);
        return section(
            response.name, intro + ".",
            numbers_of(response, amount) + list_of(notes_on(response, amount), "plain-list") + element("div", figures, "figures"));
    }

    template <class Amount>
    std::string numbers_of(const Response& response, const Amount& amount) const {
        const bool judged = has_bounds(response);
        std::vector<std::string> head{"", "Mean", "Sigma"};
        if (judged) head.insert(head.end(), {"Yield", "Cp", "Cpk"});
        std::vector<std::vector<std::string>> rows;
        const auto row = [&](const std::string& what, double mean, double sigma, const std::string& yield,
                             const tolerances::Capability& c) {
            rows.push_back({what, amount(mean), amount(sigma)});
            if (judged) rows.back().insert(rows.back().end(), {yield, index_text(c.cp), index_text(c.cpk)});
        };
        row("linear", response.linear.mean, response.linear.standard_deviation, yield_text(response.linear_yield.within), {});
        if (response.second_order)
            row("second order", response.second_order->mean, response.second_order->standard_deviation,
                response.second_order_yield ? yield_text(response.second_order_yield->within) : "not known, far from normal", {});
        if (response.sampled) {
            const SampledResponse& s = *response.sampled;
            row("sampled", s.moments.moments.mean, s.moments.moments.standard_deviation,
                yield_text(tolerances::counted_yield(s.met, count_of(study_.samples), confidence)), s.capability);
        }
        return table_of(head, rows);
    }

    template <class Amount>
    std::vector<std::string> notes_on(const Response& response, const Amount& amount) const {
        std::vector<std::string> out;
        out.push_back("Worst case by the linear prediction: " + amount(response.worst.least) + " to " + amount(response.worst.most) + ".");
        for (const auto& [what, found] : {std::pair("Least", &response.least_found), std::pair("Largest", &response.most_found)})
            if (*found && std::isfinite((*found)->value))
                out.push_back(std::string(what) + " that a search by simulations found: " + amount((*found)->value) +
                              ((*found)->settled ? "." : " (it ended early)."));
        if (response.is_rough)
            out.emplace_back("Its derivatives change too much within a standard deviation for a prediction, as where a contact begins.");
        if (!response.sampled) return out;
        const SampledResponse& s = *response.sampled;
        out.push_back("Least of the samples: " + amount(s.least) + formatted(" (sample %d); most: ", s.least_sample) + amount(s.most) +
                      formatted(" (sample %d).", s.most_sample));
        if (s.unexplained > studies::much_unexplained)
            out.push_back("Predictions miss the samples by " + percent(s.unexplained) + " of their sigma, most (" + amount(s.farthest) +
                          ") in sample " + std::to_string(s.farthest_sample) + ".");
        for (const studies::SwitchedContacts& switched : study_.switched) {
            if (switched.sample != s.farthest_sample || s.unexplained <= studies::much_unexplained) continue;
            for (const gradient_audit::ContactChange& change : switched.changes)
                out.push_back(formatted("In sample %d: ", switched.sample) + sentence_of(change) + ".");
        }
        return out;
    }

    std::string tornado(const Response& response, const CountedUnit& unit) const {
        std::vector<TornadoBar> bars;
        for (const Contribution& c : response.contributions) {
            TornadoBar bar{c.of, "", 0, 0, c.share};
            if (c.tolerance < 0) {
                bar.of = "what " + c.of + " shares";
                bar.limits = formatted("at %.0f standard deviations", group_reach);
                bar.at_lower = -group_reach * c.sensitivity / unit.si;
                bar.at_upper = group_reach * c.sensitivity / unit.si;
            } else {
                const Tolerance& tolerance = file_.tolerances[c.tolerance];
                bar.limits = limits_text(tolerance);
                bar.at_lower = change_by(response, c.tolerance, tolerance.deviation.lower) / unit.si;
                bar.at_upper = change_by(response, c.tolerance, tolerance.deviation.upper) / unit.si;
            }
            if (bar.at_lower != 0 || bar.at_upper != 0) bars.push_back(bar);
        }
        if (bars.empty()) return element("p", "No tolerance changes it.");
        const auto reach = [](const TornadoBar& bar) { return std::max(std::abs(bar.at_lower), std::abs(bar.at_upper)); };
        std::stable_sort(bars.begin(), bars.end(), [&](const TornadoBar& a, const TornadoBar& b) { return reach(a) > reach(b); });
        const std::size_t all = bars.size();
        std::erase_if(bars, [&, first = bars.front().of](const TornadoBar& bar) { return bar.share < dust && bar.of != first; });
        bars.resize(std::min(bars.size(), most_bars));
        const std::size_t left_out = all - bars.size();
        std::string keys = key_of("<rect class=\"lower\" y=\"1\" width=\"16\" height=\"8\"/>", "at the lower limit") +
                           key_of("<rect class=\"upper\" y=\"1\" width=\"16\" height=\"8\"/>", "at the upper limit") +
                           element("li", "on the right: share of the variance");
        if (left_out > 0) keys += element("li", xml_text(counted(left_out, "tolerance") + " that move it less are not shown"));
        const std::string caption = "What moves it" + (unit.name.empty() ? "" : " [" + unit.name + "]");
        return figure_of(caption, tornado_svg("What each tolerance, alone at its limits, moves " + response.name + " by", bars, unit.name),
                         keys);
    }

    // The predicted change by one deviation.
    static double change_by(const Response& response, int tolerance, double deviation) {
        VectorX deviations = VectorX::Zero(response.gradient.size());
        deviations[tolerance] = deviation;
        if (response.is_rough) return response.gradient.dot(deviations);
        return predicted(response, deviations) - response.nominal;
    }

    static std::vector<ChartMark> limits_of(const Response& response, const CountedUnit& unit) {
        std::vector<ChartMark> out;
        if (std::isfinite(response.bounds.lower)) out.push_back({"at least", "limit", response.bounds.lower / unit.si});
        if (std::isfinite(response.bounds.upper)) out.push_back({"at most", "limit", response.bounds.upper / unit.si});
        return out;
    }

    std::string histogram(const Response& response, const CountedUnit& unit) const {
        std::vector<double> values, predictions;
        for (const MadeSample& sample : study_.samples)
            if (!sample.failed()) values.push_back(sample.values[index_of(response)] / unit.si);
        if (values.empty()) return {};
        if (!response.is_rough)
            for (const VectorX& deviations : deviations_) predictions.push_back(predicted(response, deviations) / unit.si);
        std::vector<ChartMark> marks{{"as drawn", "drawn", response.nominal / unit.si},
                                     {"mean", "mean", response.sampled->moments.moments.mean / unit.si}};
        for (ChartMark& limit : limits_of(response, unit)) marks.push_back(std::move(limit));
        std::string keys = key_of("<rect class=\"bin\" y=\"1\" width=\"16\" height=\"8\"/>", counted(values.size(), "sample"));
        if (!predictions.empty())
            keys += key_of("<path class=\"predicted\" d=\"M0 8L8 2L16 8\"/>",
                           response.curvature.size() == 0 ? "linear prediction" : "second-order prediction");
        return figure_of("How it came out",
                         histogram_svg("Histogram of " + response.name + " over the samples", values, predictions, marks, unit.name), keys);
    }

    std::string scatter(const Response& response, const CountedUnit& unit) const {
        const auto first = std::find_if(response.contributions.begin(), response.contributions.end(),
                                        [](const Contribution& c) { return c.tolerance >= 0 && c.sensitivity != 0; });
        if (first == response.contributions.end() || study_.samples.empty()) return {};
        const Tolerance& tolerance = file_.tolerances[first->tolerance];
        const int i = index_of(response);
        std::vector<ScatterPoint> points;
        bool any_missed = false, any_failed = false;
        for (const MadeSample& sample : study_.samples) {
            ScatterPoint point{sample.deviations[first->tolerance] / unit_of_tolerance(tolerance), std::nullopt, true};
            if (!sample.failed()) {
                point.y = sample.values[i] / unit.si;
                point.is_met = sample.met[i];
            }
            any_missed = any_missed || !point.is_met;
            any_failed = any_failed || !point.y;
            points.push_back(point);
        }
        std::string keys = key_of("<path class=\"met\" d=\"M8 5h0\"/>", has_bounds(response) ? "met" : "sample");
        if (any_missed) keys += key_of("<path class=\"missed\" d=\"M5 2l6 6m0-6l-6 6\"/>", "missed");
        if (any_failed) keys += key_of("<path class=\"failed\" d=\"M8 1l4 8h-8z\"/>", "could not be made or simulated");
        const std::string of = tolerance.of + " [" + unit_name_of(tolerance) + " from nominal]";
        return figure_of("By what moves it most",
                         scatter_svg("Samples: " + response.name + " over the deviation of " + tolerance.of, points,
                                     limits_of(response, unit), of, response.name + (unit.name.empty() ? "" : " [" + unit.name + "]")),
                         keys);
    }

    int index_of(const Response& response) const { return static_cast<int>(&response - study_.responses.data()); }

    std::string failures() const {
        std::vector<std::vector<std::string>> rows;
        for (const MadeSample& sample : study_.samples)
            if (sample.failed()) rows.push_back({std::to_string(sample.number), sample.reason});
        if (rows.empty()) return {};
        return section("Samples that could not be made or simulated", "They count as misses of every requirement.",
                       table_of({"Sample", "Why"}, rows));
    }

    std::string footer() const {
        std::string out;
        if (!source_.command.empty()) out += element("p", "Command: " + element("code", xml_text(source_.command)));
        out += element("p", xml_text("fettle " + std::string(core::base::version()) + ". Design: " + file_.path));
        out += element("p", "Predictions and samples are computed; nothing here is proven, but the clearance of each sample by itself.");
        return element("footer", out);
    }

    const ToleranceReportSource& source_;
    const reading::DesignFile& file_;
    const studies::ToleranceReport& study_;
    const std::vector<VectorX> deviations_;  // at which the predictions of histograms are
};

}  // namespace

std::string tolerance_page(const ToleranceReportSource& source) { return Page(source).all(); }

Errors write_tolerance_report(const std::string& file, const ToleranceReportSource& source) {
    return core::files::write_file_atomically(file, tolerance_page(source));
}

}  // namespace fettle::design::report
