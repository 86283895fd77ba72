// SPDX-License-Identifier: MIT
#include "design/urdf/joint_starts.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/base/limits.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::design::urdf {

namespace {

/// coordinate = scale * that of the joint `drive` + offset.
struct Following {
    std::size_t drive = 0;
    double scale = 1, offset = 0;
};

struct Span {
    double low = -infinity, high = infinity;
    bool is_empty() const { return !(low <= high); }
};

class StartFinder {
public:
    explicit StartFinder(const Robot& robot) : joints_(robot.joints), following_(joints_.size()), known_(joints_.size(), 0) {
        for (std::size_t i = 0; i < joints_.size(); ++i) index_.try_emplace(joints_[i].name, i);
    }

    Result<JointStarts> find() {
        for (std::size_t i = 0; i < joints_.size(); ++i) resolve(i);
        if (!errors_.empty()) return errors_;
        std::vector<Span> spans(joints_.size());
        for (std::size_t i = 0; i < joints_.size(); ++i)
            if (following_[i].drive == i) spans[i] = own_span(i);
        for (std::size_t i = 0; i < joints_.size(); ++i)
            if (following_[i].drive != i) narrow(i, spans[following_[i].drive]);
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            if (following_[i].drive != i || !spans[i].is_empty()) continue;
            found_.warnings.push_back("joint \"" + joints_[i].name +
                                      "\": no position of it has it and all that mimic it within their limits");
            spans[i] = own_span(i);
        }
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            if (!joints_[i].has_coordinate()) continue;
            const Following& by = following_[i];
            const double drive = std::clamp(0.0, spans[by.drive].low, spans[by.drive].high);
            found_.of[joints_[i].name] = {at_a_limit(joints_[i], by.scale * drive + by.offset), by.scale == 0};
        }
        return std::move(found_);
    }

private:
    Span own_span(std::size_t i) const { return joints_[i].is_limited() ? Span{*joints_[i].lower, *joints_[i].upper} : Span{}; }

    /// A coordinate that rounding moved away from a limit.
    static double at_a_limit(const Joint& joint, double coordinate) {
        if (!joint.is_limited()) return coordinate;
        for (const double limit : {*joint.lower, *joint.upper})
            if (std::abs(coordinate - limit) <= 1e-14 * (1 + std::abs(limit))) return limit;
        return coordinate;
    }

    /// To where the follower is within its own limits.
    void narrow(std::size_t i, Span& drive) const {
        const Following& by = following_[i];
        const Span own = own_span(i);
        if (by.scale == 0) return;
        const double low = (own.low - by.offset) / by.scale, high = (own.high - by.offset) / by.scale;
        drive.low = std::max(drive.low, std::min(low, high));
        drive.high = std::min(drive.high, std::max(low, high));
    }

    void fail(const Joint& joint, const std::string& what) {
        errors_.push_back({ErrorCode::inconsistent, "joint \"" + joint.name + "\"", "mimics \"" + joint.mimics + "\", " + what});
    }

    /// What it follows in the end, by way of the joints between.
    void resolve(std::size_t joint) {
        std::vector<std::size_t> way;
        std::size_t at = joint;
        while (known_[at] == 0 && !joints_[at].mimics.empty()) {
            known_[at] = on_the_way;
            way.push_back(at);
            const auto other = index_.find(joints_[at].mimics);
            if (other == index_.end()) {
                std::vector<std::string_view> names;
                for (const Joint& each : joints_) names.emplace_back(each.name);
                fail(joints_[at], "which is not there; " + core::files::did_you_mean(joints_[at].mimics, names));
            } else if (known_[other->second] == on_the_way) {
                fail(joints_[at], "which follows it in turn");
            } else if (!joints_[at].has_coordinate() || !joints_[other->second].has_coordinate()) {
                fail(joints_[at], "and both must be joints that turn or slide: revolute, continuous or prismatic");
            } else {
                at = other->second;
                continue;
            }
            break;
        }
        if (known_[at] == 0) following_[at] = {at, 1, 0};
        known_[at] = resolved;
        for (; !way.empty(); way.pop_back()) {
            const std::size_t follower = way.back();
            known_[follower] = resolved;
            const auto other = index_.find(joints_[follower].mimics);
            if (other == index_.end() || !errors_.empty()) continue;
            const Following& by = following_[other->second];
            const double multiplier = joints_[follower].multiplier;
            following_[follower] = {by.drive, multiplier * by.scale, multiplier * by.offset + joints_[follower].offset};
        }
    }

    static constexpr char on_the_way = 1, resolved = 2;
    const std::vector<Joint>& joints_;
    std::unordered_map<std::string_view, std::size_t> index_;
    std::vector<Following> following_;
    std::vector<char> known_;
    JointStarts found_;
    Errors errors_;
};

}  // namespace

Result<JointStarts> joint_starts(const Robot& robot) { return StartFinder(robot).find(); }

}  // namespace fettle::design::urdf
