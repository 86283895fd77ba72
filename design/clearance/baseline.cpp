// SPDX-License-Identifier: MIT
#include "design/clearance/baseline.hpp"

#include <limits>

#include "core/base/text.hpp"
#include "core/files/json_document.hpp"

namespace fettle::design::clearance {

using core::base::formatted;

namespace {

bool is_finding(const std::string& status) { return status == "violated" || status == "undecided"; }

std::string pair_key(const std::string& a, const std::string& b) { return a < b ? a + '\n' + b : b + '\n' + a; }

}  // namespace

Result<Baseline> Baseline::read(const std::string& path) {
    auto document = core::files::JsonDocument::read(path);
    if (!document) return document.errors();
    Baseline baseline;
    baseline.file_ = path;
    const core::files::JsonNode list = document->root().require("pairs");
    for (const core::files::JsonNode& node : list.elements()) {
        const auto a = node.require("a").string(), b = node.require("b").string();
        const auto status = node.require("status").choice({"clear", "violated", "undecided", "contact"});
        const core::files::JsonNode lower_node = node.require("lower");
        const auto lower = lower_node.is_null() ? std::numeric_limits<double>::quiet_NaN() : lower_node.number();
        const core::files::JsonNode upper_node = node.require("upper");
        const auto upper = upper_node.is_null() ? std::numeric_limits<double>::infinity() : upper_node.number();
        if (!a || !b || !status || !lower || !upper) continue;
        baseline.by_pair_[pair_key(*a, *b)] = baseline.rows_.size();
        baseline.rows_.push_back({*a, *b, {*status, *lower, *upper}});
    }
    if (!document->errors().empty()) return document->errors();
    return baseline;
}

Change Baseline::compare(const std::string& a, const std::string& b, core::clearance::PairStatus now) {
    Change change;
    if (const auto found = by_pair_.find(pair_key(a, b)); found != by_pair_.end()) {
        Row& row = rows_[found->second];
        row.judged = true;
        change.before = row.before;
    }
    const bool is_now = is_finding(core::clearance::to_string(now)), was = change.before && is_finding(change.before->status);
    change.word = is_now ? (was ? "existing" : "new") : (was ? "resolved" : "");
    new_ += change.word == "new" ? 1 : 0;
    existing_ += change.word == "existing" ? 1 : 0;
    resolved_ += change.word == "resolved" ? 1 : 0;
    return change;
}

std::vector<std::string> Baseline::missing() const {
    std::vector<std::string> names;
    for (const Row& row : rows_) {
        const bool judged = rows_[by_pair_.at(pair_key(row.a, row.b))].judged;
        if (!judged && is_finding(row.before.status)) names.push_back(row.a + ":" + row.b);
    }
    return names;
}

std::string Baseline::text() const {
    std::string text = formatted("against %s: %d new, %d existing, %d resolved\n", file_.c_str(), new_, existing_, resolved_);
    const std::vector<std::string> names = missing();
    if (!names.empty()) text += "found there and not judged now: " + core::base::joined(names) + "\n";
    return text;
}

}  // namespace fettle::design::clearance
