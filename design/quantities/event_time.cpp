// SPDX-License-Identifier: MIT
#include "design/quantities/event_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.hpp"
#include "design/quantities/own_formula.hpp"
#include "design/quantities/threshold.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

namespace {

std::string at_time(double seconds) { return core::base::formatted("%.4g s", seconds); }

std::string ordinal(int k) {
    static const char* const words[] = {"first", "second", "third", "fourth", "fifth"};
    return k <= 5 ? words[k - 1] : core::base::formatted("%dth", k);
}

const char* way_of(Direction direction) {
    return direction == Direction::rising ? " rising" : direction == Direction::falling ? " falling" : "";
}

}  // namespace

std::vector<double> EventTime::beyond(const Simulated& simulated) const {
    return less_threshold(of_.series->numbers(simulated), of_.threshold, simulated);
}

std::string EventTime::amount(double si, int digits) const { return threshold_text(si, of_.series->numbers_dimension(), digits); }

std::vector<Crossing> EventTime::crossings(const Simulated& simulated) const {
    const double timestep = simulated.trajectory.timestep, room = 1e-6 * timestep;
    std::vector<Crossing> out = crossings_of_zero(beyond(simulated));
    std::erase_if(out, [&](const Crossing& crossing) {
        const double time = time_of(crossing.place, timestep);
        if (of_.direction != Direction::either && crossing.rises != (of_.direction == Direction::rising)) return true;
        return (of_.from && time < *of_.from - room) || (of_.to && time > *of_.to + room);
    });
    return out;
}

std::optional<Crossing> EventTime::crossing(const Simulated& simulated) const {
    const std::vector<Crossing> all = crossings(simulated);
    const int at = of_.occurrence > 0 ? of_.occurrence - 1 : count_of(all) + of_.occurrence;
    return at >= 0 && at < count_of(all) ? std::optional(all[at]) : std::nullopt;
}

// "`slide` crosses 3 mm rising".
std::string EventTime::crossing_text(const Simulated& simulated) const {
    return of_.name + " crosses " + amount(value_at(of_.threshold, simulated)) + way_of(of_.direction);
}

std::string EventTime::missing_text(const Simulated& simulated) const {
    const double timestep = simulated.trajectory.timestep;
    const std::vector<double> g = beyond(simulated);
    const auto all = crossings(simulated);
    const std::string during = of_.from || of_.to ? " from " + at_time(of_.from.value_or(0)) + " to " +
                                                        at_time(of_.to.value_or(time_of(count_of(g) - 1, timestep)))
                                                  : " in this motion";
    const std::string times = all.empty()          ? " at no time"
                              : count_of(all) == 1 ? " once"
                                                   : core::base::formatted(" %d times", count_of(all));
    std::string out = crossing_text(simulated) + times + during;
    if (!all.empty())
        return out + ", so there is no " + ordinal(std::abs(of_.occurrence)) + (of_.occurrence < 0 ? " from the last" : " time");
    int nearest = -1;
    for (int k = 0; k < count_of(g); ++k) {
        const double time = time_of(k, timestep);
        if ((of_.from && time < *of_.from) || (of_.to && time > *of_.to)) continue;
        if (nearest < 0 || std::abs(g[k]) < std::abs(g[nearest])) nearest = k;
    }
    if (nearest >= 0)
        out += ": it comes nearest at " + at_time(time_of(nearest, timestep)) + ", with " +
               amount(g[nearest] + value_at(of_.threshold, simulated));
    return out + "; to bring an event about, bound the \"largest\" or \"least\" of what is to cross";
}

Measurement EventTime::value(const Simulated& simulated) const {
    Measurement none = description::computed(std::numeric_limits<double>::quiet_NaN());
    const std::vector<double> g = beyond(simulated);
    if (const auto fault = fault_of_numbers(g, of_.name, of_.series->first_instant()); !fault.empty()) {
        none.fault = fault;
        return none;
    }
    const auto found = crossing(simulated);
    if (!found) {
        none.fault = missing_text(simulated);
        return none;
    }
    if (found->is_at_rest) {
        none.fault = of_.name + " rests on " + amount(value_at(of_.threshold, simulated)) + " around " +
                     at_time(time_of(found->place, simulated.trajectory.timestep)) +
                     ", where no time is that of the crossing: choose a threshold that it does not rest on";
        return none;
    }
    return description::computed(time_of(found->place, simulated.trajectory.timestep));
}

void EventTime::add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const {
    const auto found = crossing(simulated);
    if (!found) return;
    const std::vector<double> g = beyond(simulated);
    const double per_place = scale * simulated.trajectory.timestep;
    std::vector<double> weights(g.size(), 0.0);
    if (!add_place_weights(g, found->place, per_place, weights)) {
        seeds.refusal = crossing_text(simulated) + " without a rate, at " + at_time(time_of(found->place, simulated.trajectory.timestep)) +
                        ": it only touches it, and the time has no derivative";
        return;
    }
    add_beyond_seeds(*of_.series, of_.threshold, simulated, weights, seeds);
}

std::string EventTime::doubt(const Simulated& simulated, const Measurement& measured) const {
    const auto found = crossing(simulated);
    if (!found || std::isnan(measured.value)) return {};
    const std::vector<double> g = beyond(simulated);
    const double timestep = simulated.trajectory.timestep, last = count_of(g) - 1;
    const std::string told = crossing_text(simulated) + " at " + at_time(measured.value);
    if (found->place < 1 || found->place > last - 1)
        return told + ", within a step of the motion's " + (found->place < 1 ? "start" : "end") +
               ", and may leave the motion as the design changes";
    const auto turn = slightest_turn(g, of_.occurrence > 0 ? 0 : static_cast<int>(found->place),
                                     of_.occurrence > 0 ? static_cast<int>(found->place) + 1 : count_of(g) - 1);
    if (!turn) return {};
    return told + ", but at " + at_time(time_of(turn->index, timestep)) + " it turns round no more than " +
           amount(std::abs(g[turn->index]), 2) +
           " from there: a small change of the design makes crossings or takes them away, and the time jumps";
}

std::vector<std::string> EventTime::parameters() const {
    std::vector<std::string> names = of_.series->parameters();
    names.insert(names.end(), of_.threshold.inputs.begin(), of_.threshold.inputs.end());
    return names;
}

Errors EventTime::check(const core::model::Model& model, int steps) const {
    Errors errors = check_threshold(*of_.series, of_.threshold, {of_.from, of_.to}, model, steps);
    if (of_.occurrence == 0)
        errors.push_back({ErrorCode::out_of_range, "", "an occurrence counts from 1, the first, or back from -1, the last; 0 is none"});
    return errors;
}

}  // namespace fettle::design::quantities
