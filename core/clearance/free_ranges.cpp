// SPDX-License-Identifier: MIT
#include "core/clearance/free_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "core/base/contract.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::core::clearance {
namespace {

using Kind = RangeEnd::Kind;

constexpr double meet = 1e-9;  // surfaces that are closer meet, as far as this asks [m]

class OneCoordinate {
public:
    OneCoordinate(const model::Model& model, const JointRanges& ranges, int coordinate, const std::vector<std::pair<int, int>>& pairs,
                  double reach, const FreeRangeOptions& options)
        : model_(model),
          ranges_(options.others_anywhere ? ranges : alone(ranges, coordinate)),
          own_(ranges_.linkage.coordinates[coordinate]),
          asked_(options),
          coordinate_(coordinate) {
        for (const auto& [a, b] : pairs) {
            const std::vector<int> by = linked_pair(ranges_.linkage, a, b).coordinates;
            if (std::find(by.begin(), by.end(), coordinate) == by.end()) continue;
            const double minimum = are_joined(a, b) ? std::min(options.joined_minimum, options.minimum) : options.minimum;
            pairs_.push_back({a, b, std::max(minimum, meet)});
        }
        out_.coordinate = coordinate;
        out_.start = own_.start;
        double slide = 0;
        for (const certificate::LinkedBody& body : ranges_.linkage.bodies)
            for (const certificate::Screw& screw : body.screws)
                if (screw.coordinate == coordinate) slide = std::max(slide, std::abs(screw.slide));
        const bool swings = ranges_.direction_of[coordinate] >= 0;
        turns_ = slide == 0 && !swings;
        near_ = own_.joints.front().is_angle ? options.angle : options.length / slide;
        const double away = slide > 0 ? reach / slide : own_.is_whole_turn ? own_.high - own_.low : 2 * std::numbers::pi;
        lowest_ = swings ? 0 : own_.start - away;
        highest_ = swings ? std::numbers::pi : own_.start + away;
        options_.answer_is_enough = true;
        options_.measure_overlap = options_.sample_nodes = false;
        options_.should_stop = options.should_stop;
        certification_ = std::make_unique<RangeClearances>(model, ranges_, pairs_, options_);
    }

    FreeRange run() {
        std::vector<int> upwards, downwards;
        look_at_start(upwards, downwards);
        out_.above.free = out_.below.free = out_.start;
        if (asked_.above) out_.above = way(highest_, upwards, beside_above_);
        out_.turns_freely = asked_.above && turns_ && out_.above.kind == Kind::open;
        if (asked_.below && !out_.turns_freely) out_.below = way(lowest_, downwards, beside_below_);
        return std::move(out_);
    }

private:
    // Pairs by their places in pairs_; over [from, to], in either order.
    std::vector<PairClearance> over(double from, double to, const std::vector<int>& which) {
        certificate::LinkageCoordinate& own = certification_->ranges().linkage.coordinates[coordinate_];
        own.low = std::min(from, to);
        own.high = std::max(from, to);
        std::vector<PairRequest> requests;
        for (const int k : which) requests.push_back(pairs_[k]);
        return certification_->over(requests);
    }

    bool should_stop() const { return asked_.should_stop && asked_.should_stop(); }

    static double toward(double from, double end, double by) { return end > from ? std::min(end, from + by) : std::max(end, from - by); }

    // Pairs that are closer than the minimum at the start are looked at a little beside it: bodies rest on each other.
    void look_at_start(std::vector<int>& upwards, std::vector<int>& downwards) {
        std::vector<int> all(pairs_.size());
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<int>(k);
        const std::vector<PairClearance> there = over(out_.start, out_.start, all);
        std::vector<int> close;
        for (const int k : all) {
            if (there[k].status == PairStatus::clear) {
                upwards.push_back(k);
                downwards.push_back(k);
            } else {
                close.push_back(k);
            }
        }
        if (close.empty()) return;
        const double above = out_.start + near_, below = out_.start - near_;
        const std::vector<PairClearance> up = over(above, above, close), down = over(below, below, close);
        for (std::size_t i = 0; i < close.size(); ++i) {
            const int k = close[i];
            const bool goes_up = up[i].status == PairStatus::clear, goes_down = down[i].status == PairStatus::clear;
            if (!goes_up && !goes_down) {
                const bool is_known = there[k].status != PairStatus::undecided, is_joined = are_joined(pairs_[k].a, pairs_[k].b);
                const std::string why = there[k].reason.empty() ? "it is not known whether they are apart" : there[k].reason;
                out_.not_searched.push_back({pairs_[k].a, pairs_[k].b, is_known ? std::string() : why, is_joined});
                if (is_joined || !is_known) continue;
            } else {
                out_.touching.emplace_back(pairs_[k].a, pairs_[k].b);
                if (goes_up) beside_above_.push_back(k);
                if (goes_down) beside_below_.push_back(k);
            }
            upwards.push_back(k);  // blocked at once where it does not go
            downwards.push_back(k);
        }
        std::sort(upwards.begin(), upwards.end());
        std::sort(downwards.begin(), downwards.end());
    }

    bool are_joined(int a, int b) const {
        const auto& joints = model_.mechanism.joints;
        return std::any_of(joints.begin(), joints.end(),
                           [&](const model::Joint& joint) { return (joint.a == a && joint.b == b) || (joint.a == b && joint.b == a); });
    }

    // @param beside  pairs that are known to be apart beside the start alone
    RangeEnd way(double end, const std::vector<int>& which, const std::vector<int>& beside) {
        RangeEnd out;
        out.free = out_.start;
        std::vector<double> proven(pairs_.size(), out_.start);  // of each pair, up to where
        for (const int k : beside) proven[k] = toward(out_.start, end, near_);
        double stop = end, to = end;
        std::optional<int> blocked;
        while (std::abs(stop - out.free) > (blocked ? near_ : 0)) {
            const Round found = ask(which, to, proven);
            if (found.closer) {
                blocked = found.closer;
                stop = found.at;
                to = 0.5 * (out.free + stop);
            } else if (found.unknown) {
                if (should_stop() || std::abs(to - out.free) <= near_) return not_known(*found.unknown, to, proven, out);
                to = 0.5 * (out.free + to);
            } else {
                const double step = 2 * std::abs(to - out.free);
                out.free = to;
                if (asked_.on_progress) asked_.on_progress(own_.joints.front().joint, out.free);
                to = blocked ? 0.5 * (out.free + stop) : toward(out.free, stop, step);
            }
        }
        if (!blocked) return out;
        out.kind = Kind::blocked;
        out.at = stop;
        certification_->options().measure_overlap = true;
        out.pair = over(stop, stop, {*blocked}).front();
        certification_->options().measure_overlap = false;
        return out;
    }

    struct Round {
        std::optional<int> closer, unknown;  // pairs
        double at = 0;                       // where the nearest of those that are closer is so
    };

    // Each pair from where it is proven to `to`.
    Round ask(const std::vector<int>& which, double to, std::vector<double>& proven) {
        std::map<double, std::vector<int>> from;
        for (const int k : which)
            if (std::abs(proven[k] - out_.start) < std::abs(to - out_.start)) from[proven[k]].push_back(k);
        Round out;
        for (const auto& [begin, pairs] : from) {
            const std::vector<PairClearance> found = over(begin, to, pairs);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (found[i].status == PairStatus::clear) {
                    proven[pairs[i]] = to;
                } else if (found[i].status == PairStatus::undecided) {
                    out.unknown = pairs[i];
                } else if (const double at = value_of(found[i]); !out.closer || std::abs(at - out_.start) < std::abs(out.at - out_.start)) {
                    out.closer = pairs[i];
                    out.at = at;
                }
            }
        }
        return out;
    }

    RangeEnd not_known(int pair, double to, const std::vector<double>& proven, RangeEnd out) {
        out.kind = Kind::undecided;
        out.pair = over(proven[pair], to, {pair}).front();
        return out;
    }

    double value_of(const PairClearance& found) const {
        const auto at = std::find(found.coordinates.begin(), found.coordinates.end(), coordinate_);
        FETTLE_ASSERT(at != found.coordinates.end(), "the coordinate moves the pair");
        return found.at[static_cast<std::size_t>(at - found.coordinates.begin())];
    }

    const model::Model& model_;
    const JointRanges ranges_;
    const certificate::LinkageCoordinate& own_;
    const FreeRangeOptions& asked_;
    const int coordinate_;
    std::vector<PairRequest> pairs_;
    ClearanceOptions options_;
    double near_ = 0, lowest_ = 0, highest_ = 0;
    bool turns_ = false;
    std::vector<int> beside_above_, beside_below_;  // pairs that touch at the start, and come apart this way
    std::unique_ptr<RangeClearances> certification_;
    FreeRange out_;
};

}  // namespace

const NotSearched* FreeRange::clash_at_start() const {
    const auto found = std::find_if(not_searched.begin(), not_searched.end(),
                                    [](const NotSearched& each) { return !each.is_joined && each.undecided.empty(); });
    return found == not_searched.end() ? nullptr : &*found;
}

bool FreeRange::is_decided() const {
    const auto is_unknown = [](const NotSearched& each) { return !each.is_joined && !each.undecided.empty(); };
    return below.kind != RangeEnd::Kind::undecided && above.kind != RangeEnd::Kind::undecided &&
           std::none_of(not_searched.begin(), not_searched.end(), is_unknown);
}

std::vector<std::pair<int, int>> searched_pairs(const model::Model& model) {
    std::vector<std::pair<int, int>> out;
    for (int a = 0; a < count_of(model.bodies); ++a)
        for (int b = a + 1; b < count_of(model.bodies); ++b) {
            const model::NoContact why = model::why_no_contact(model, a, b);
            if (why != model::NoContact::ignored && why != model::NoContact::one_group) out.emplace_back(a, b);
        }
    return out;
}

base::Result<int> coordinate_of(const JointRanges& ranges, const std::string& joint) {
    std::vector<std::string_view> known;
    for (int k = 0; k < count_of(ranges.linkage.coordinates); ++k)
        for (const certificate::JointCoordinate& each : ranges.linkage.coordinates[k].joints) {
            if (each.joint == joint) return k;
            known.emplace_back(each.joint);
        }
    return base::Error{base::ErrorCode::out_of_range, "",
                       "no joint that moves is called \"" + joint + "\"; " + files::did_you_mean(joint, known)};
}

JointRanges alone(JointRanges ranges, int coordinate) {
    const int direction = ranges.direction_of[coordinate];
    for (certificate::LinkedBody& body : ranges.linkage.bodies)
        std::erase_if(body.screws, [&](const certificate::Screw& screw) {
            return screw.coordinate != coordinate && (direction < 0 || screw.coordinate != direction);
        });
    return ranges;
}

std::vector<FreeRange> free_ranges(const model::Model& model, const JointRanges& ranges, const std::vector<int>& coordinates,
                                   const std::vector<std::pair<int, int>>& pairs, double reach, const FreeRangeOptions& options) {
    std::vector<FreeRange> out;
    for (const int coordinate : coordinates) out.push_back(OneCoordinate(model, ranges, coordinate, pairs, reach, options).run());
    return out;
}

}  // namespace fettle::core::clearance
