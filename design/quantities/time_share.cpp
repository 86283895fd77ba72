// SPDX-License-Identifier: MIT
#include "design/quantities/time_share.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/text.hpp"
#include "design/quantities/own_formula.hpp"
#include "design/quantities/threshold.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

namespace {

/// A place where a part of the motion begins or ends that counts.
struct End {
    double place = 0;          // counted in steps from the first number
    double sign = 1;           // 1: the end of a part, -1: its begin
    bool is_crossing = false;  // else the window's
};

// Before the first crossing it is on the side of the first number that is on one.
bool is_above_at(const std::vector<double>& g, double place, const std::vector<Crossing>& crossings) {
    bool above = false;
    const double on_zero = room_on_zero(g);
    const auto first = std::find_if(g.begin(), g.end(), [&](double number) { return std::abs(number) > on_zero; });
    if (first != g.end()) above = *first > 0;
    for (const Crossing& crossing : crossings)
        if (crossing.place <= place) above = crossing.rises;
    return above;
}

}  // namespace

/// What the share is made from.
struct TimeShare::Parts {
    std::vector<double> g, x;   // the numbers, above 0 where they count; the drive's
    double begin = 0, end = 0;  // places of the window
    std::vector<End> ends;
    double counted = 0, whole = 0;
    std::string fault;
};

int TimeShare::first_instant() const { return std::max(of_.series->first_instant(), of_.along ? of_.along->first_instant() : 0); }

TimeShare::Parts TimeShare::parts(const Simulated& simulated) const {
    Parts out;
    const int first = first_instant();
    const double timestep = simulated.trajectory.timestep;
    out.g = less_threshold(of_.series->numbers(simulated), of_.threshold, simulated);
    if (!of_.is_above)
        for (double& number : out.g) number = -number;
    out.x = of_.along ? of_.along->numbers(simulated) : std::vector<double>(out.g.size());
    if (!of_.along) std::iota(out.x.begin(), out.x.end(), 0.0);
    out.g.erase(out.g.begin(), out.g.begin() + (first - of_.series->first_instant()));
    if (of_.along) out.x.erase(out.x.begin(), out.x.begin() + (first - of_.along->first_instant()));
    out.fault = fault_of_numbers(out.g, of_.name, first);
    if (out.fault.empty()) out.fault = fault_of_numbers(out.x, "what it is along", first);
    if (!out.fault.empty()) return out;
    const double last = count_of(out.g) - 1;
    const auto place = [&](double time) { return std::clamp(time / timestep - first, 0.0, last); };
    out.begin = of_.from ? place(*of_.from) : 0;
    out.end = of_.to ? place(*of_.to) : last;
    if (const auto rest = rest_on_zero(out.g, out.begin, out.end)) {
        out.fault = of_.name + " rests on " + threshold_text(value_at(of_.threshold, simulated), of_.series->numbers_dimension(), 4) +
                    core::base::formatted(" at %.4g s", (*rest + first) * timestep) +
                    ", where it is neither above nor below: choose a threshold that it does not rest on";
        return out;
    }
    const std::vector<Crossing> crossings = crossings_of_zero(out.g);
    if (is_above_at(out.g, out.begin, crossings)) out.ends.push_back({out.begin, -1});
    for (const Crossing& crossing : crossings)
        if (crossing.place > out.begin && crossing.place < out.end) out.ends.push_back({crossing.place, crossing.rises ? -1.0 : 1.0, true});
    if (is_above_at(out.g, out.end, crossings)) out.ends.push_back({out.end, 1});
    for (const End& each : out.ends) out.counted += each.sign * interpolated(out.x, each.place).value;
    out.whole = interpolated(out.x, out.end).value - interpolated(out.x, out.begin).value;
    const auto [least, largest] = std::minmax_element(out.x.begin(), out.x.end());
    if (!(std::abs(out.whole) > 1e-9 * (*largest - *least)) || *largest == *least)
        out.fault = "what it is along does not get on in this part of the motion, so there is nothing to have a share of";
    return out;
}

Measurement TimeShare::value(const Simulated& simulated) const {
    const Parts found = parts(simulated);
    Measurement out = description::computed(found.fault.empty() ? found.counted / found.whole : std::numeric_limits<double>::quiet_NaN());
    out.fault = found.fault;
    return out;
}

void TimeShare::add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const {
    const Parts found = parts(simulated);
    if (!found.fault.empty()) return;
    std::vector<double> of_g(found.g.size(), 0.0), of_x(found.x.size(), 0.0);
    const auto add_x = [&](double place, double factor) {
        const Interpolated here = interpolated(found.x, place);
        for (int k = 0; k < 4; ++k)
            if (here.weights[k] != 0) of_x[here.first + k] += factor * here.weights[k];
        return here.slope;
    };
    const double by_counted = scale / found.whole, by_whole = -scale * found.counted / (found.whole * found.whole);
    for (const End& each : found.ends) {
        const double slope = add_x(each.place, by_counted * each.sign);
        if (!each.is_crossing || add_place_weights(found.g, each.place, by_counted * each.sign * slope, of_g)) continue;
        seeds.refusal = of_.name + " only touches the threshold, and the share of the time has no derivative there";
        return;
    }
    add_x(found.end, by_whole);
    add_x(found.begin, -by_whole);
    const auto with_earlier = [&](std::vector<double> weights, const StepSeries& series) {
        weights.insert(weights.begin(), static_cast<std::size_t>(first_instant() - series.first_instant()), 0.0);
        return weights;
    };
    if (!of_.is_above)
        for (double& weight : of_g) weight = -weight;
    add_beyond_seeds(*of_.series, of_.threshold, simulated, with_earlier(std::move(of_g), *of_.series), seeds);
    if (of_.along) of_.along->add_number_seeds(simulated, with_earlier(std::move(of_x), *of_.along), seeds);
}

std::vector<std::string> TimeShare::parameters() const {
    std::vector<std::string> names = of_.series->parameters();
    names.insert(names.end(), of_.threshold.inputs.begin(), of_.threshold.inputs.end());
    if (!of_.along) return names;
    for (std::string& name : of_.along->parameters()) names.push_back(std::move(name));
    return names;
}

Errors TimeShare::check(const core::model::Model& model, int steps) const {
    Errors errors = check_threshold(*of_.series, of_.threshold, {of_.from, of_.to}, model, steps);
    if (steps - first_instant() < 1)
        errors.push_back({ErrorCode::out_of_range, "", "a share of the time needs a step between two instants that it is known at"});
    if (!of_.along) return errors;
    for (const Error& error : of_.along->check(model, steps)) errors.push_back(error);
    if (!of_.along->reduction().is_plain())
        errors.push_back(
            {ErrorCode::unsupported, "", "what a share is along has a number at each instant; leave out what is taken over them"});
    return errors;
}

}  // namespace fettle::design::quantities
