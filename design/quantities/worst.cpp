// SPDX-License-Identifier: MIT
#include "design/quantities/worst.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/contract.hpp"

namespace fettle::design::quantities {

using description::Measurement;
using description::Seeds;
using description::Simulated;

Worst::Worst(std::vector<std::shared_ptr<const Quantity>> parts, bool greatest) : parts_(std::move(parts)), greatest_(greatest) {
    FETTLE_ASSERT(!parts_.empty(), "the worst of nothing");
}

description::QuantityFacts Worst::facts() const {
    description::QuantityFacts facts{.kind = description::QuantityFacts::Kind::worst};
    for (const auto& part : parts_) facts.parts.push_back({"", part});
    return facts;
}

Measurement Worst::value(const Simulated& simulated) const {
    Measurement out;
    for (const auto& part : parts_) out.parts.push_back(part->value(simulated));
    const auto extreme = [&](double Measurement::*side) {
        double found = out.parts.front().*side;
        for (const Measurement& part : out.parts) {
            if (std::isnan(part.*side)) return part.*side;
            found = greatest_ ? std::max(found, part.*side) : std::min(found, part.*side);
        }
        return found;
    };
    out.value = extreme(&Measurement::value);
    out.lower = extreme(&Measurement::lower);
    out.upper = extreme(&Measurement::upper);
    out.is_proven = true;
    for (const Measurement& part : out.parts) {
        out.is_proven = out.is_proven && part.is_proven;
        if (out.fault.empty()) out.fault = part.fault;
    }
    return out;
}

int Worst::worst(const Measurement& measured) const {
    int found = 0;
    while (measured.parts[found].value != measured.value && found + 1 < count_of(parts_)) ++found;
    return found;
}

void Worst::add_seeds(const Simulated& simulated, const Measurement& measured, double scale, Seeds& seeds) const {
    const int found = worst(measured);
    if (parts_[found]->is_about(simulated.scenario)) parts_[found]->add_seeds(simulated, measured.parts[found], scale, seeds);
}

std::vector<description::Branch> Worst::branches(const Simulated& simulated, const Measurement& measured, double limit) const {
    const double reach = limit - measured.value;
    std::vector<description::Branch> out;
    const auto add = [&](int i) {
        const description::Quantity& part = *parts_[i];
        const Measurement& of_part = measured.parts[i];
        const double behind = std::abs(measured.value - of_part.value);
        if (!part.is_about(simulated.scenario) || behind > reach) return;
        std::vector<description::Branch> own;
        if (part.is_greatest_branch() == greatest_) own = part.branches(simulated, of_part, of_part.value + reach - behind);
        if (own.empty())
            own.push_back({of_part.value, [&part, &simulated, &of_part](double scale, Seeds& seeds) {
                               part.add_seeds(simulated, of_part, scale, seeds);
                           }});
        std::move(own.begin(), own.end(), std::back_inserter(out));
    };
    const int first = worst(measured);
    add(first);
    for (int i = 0; i < count_of(parts_); ++i)
        if (i != first) add(i);
    return out;
}

std::string Worst::doubt(const Simulated& simulated, const Measurement& measured) const {
    for (int i = 0; i < count_of(parts_); ++i)
        if (std::string found = parts_[i]->doubt(simulated, measured.parts[i]); !found.empty()) return found;
    return {};
}

bool Worst::is_at_rest() const {
    return std::all_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->is_at_rest(); });
}

bool Worst::is_about(int scenario) const {
    return std::any_of(parts_.begin(), parts_.end(), [&](const auto& part) { return part->is_about(scenario); });
}

std::vector<std::string> Worst::parameters() const {
    std::vector<std::string> out;
    for (const auto& part : parts_) {
        const std::vector<std::string> own = part->parameters();
        out.insert(out.end(), own.begin(), own.end());
    }
    return out;
}

Errors Worst::check(const core::model::Model& model, int steps) const {
    Errors errors;
    for (const auto& part : parts_)
        for (Error& error : part->check(model, steps)) {
            const auto same = [&](const Error& known) { return known.message == error.message; };  // one quantity in several scenarios
            if (std::none_of(errors.begin(), errors.end(), same)) errors.push_back(std::move(error));
        }
    return errors;
}

}  // namespace fettle::design::quantities
