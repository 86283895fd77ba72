// SPDX-License-Identifier: MIT
#include "design/gradient_audit/contact_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "core/base/contract.hpp"

namespace fettle::design::gradient_audit {
namespace {

struct EventWords {
    const char *name, *words;
    bool is_kink;
    const char* words_with_others = nullptr;
};

const EventWords& words_at(ContactEvent event) {
    static constexpr std::array<EventWords, 7> table{{{"touch", "begin to touch", false, "touch in a further place"},
                                                      {"part", "lose touch", false, "touch in one place less"},
                                                      {"new_features", "touch elsewhere", true},
                                                      {"parallel", "have edges that become nearly parallel", true},
                                                      {"crossing", "have edges that cease to be nearly parallel", true},
                                                      {"slide", "begin to slide", false},
                                                      {"stick", "begin to stick", false}}};
    return table[static_cast<std::size_t>(event)];
}

bool are_neighbours(const ContactState& x, const ContactState& y) {
    return x.a == y.a && x.b == y.b && adjoin(x.on_a, y.on_a) && adjoin(x.on_b, y.on_b);
}

using Contacts = std::vector<ContactState>;

// The contacts that one of two steps has alone, and those that both have; each in order.
struct Compared {
    std::vector<const ContactState*> lost, found;
    std::vector<std::pair<const ContactState*, const ContactState*>> kept;
};

Compared compared(const Contacts& from, const Contacts& to) {
    Compared out;
    size_t i = 0, j = 0;
    while (i < from.size() || j < to.size()) {
        const int order = i == from.size() ? 1 : j == to.size() ? -1 : compare_contacts(from[i], to[j]);
        if (order < 0) out.lost.push_back(&from[i++]);
        if (order > 0) out.found.push_back(&to[j++]);
        if (order == 0) out.kept.emplace_back(&from[i++], &to[j++]);
    }
    return out;
}

bool touch(const Contacts& contacts, const ContactState& of) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const ContactState& c) { return c.a == of.a && c.b == of.b; });
}

// What is found beside something lost has moved there; the rest comes and goes.
void add_moved(Compared& step, int t, const Contacts& from, const Contacts& to, std::vector<ContactDifference>& out) {
    std::erase_if(step.found, [&](const ContactState* now) {
        const auto was = std::find_if(step.lost.begin(), step.lost.end(), [&](const ContactState* x) { return are_neighbours(*x, *now); });
        if (was == step.lost.end()) return false;
        out.push_back({ContactEvent::new_features, t, **was, *now});
        step.lost.erase(was);
        return true;
    });
    for (const ContactState* now : step.found) out.push_back({ContactEvent::touch, t, *now, *now, touch(from, *now)});
    for (const ContactState* was : step.lost) out.push_back({ContactEvent::part, t, *was, *was, touch(to, *was)});
}

void add_kept(const Compared& step, int t, std::vector<ContactDifference>& out) {
    for (const auto& [was, now] : step.kept) {
        if (was->is_mollified != now->is_mollified)
            out.push_back({now->is_mollified ? ContactEvent::parallel : ContactEvent::crossing, t, *was, *now});
        if (was->slides != now->slides) out.push_back({now->slides ? ContactEvent::slide : ContactEvent::stick, t, *was, *now});
    }
}

auto sort_of(const ContactDifference& d) { return std::tuple(d.is.a, d.is.b, d.event); }

}  // namespace

const char* to_string(ContactEvent event) { return words_at(event).name; }
bool is_kink(ContactEvent event) { return words_at(event).is_kink; }

std::vector<ContactDifference> contact_differences(const std::vector<Contacts>& from, const std::vector<Contacts>& to) {
    std::vector<ContactDifference> out;
    for (size_t t = 0; t < std::min(from.size(), to.size()); ++t) {
        Compared step = compared(from[t], to[t]);
        add_kept(step, static_cast<int>(t), out);
        add_moved(step, static_cast<int>(t), from[t], to[t], out);
    }
    return out;
}

void ContactWatch::add(double share, const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    FETTLE_ASSERT(share > 0, "a move");
    moves_.push_back({share, contact_differences(*contacts_, contact_states(model, trajectory))});
    std::stable_sort(moves_.begin(), moves_.end(), [](const Move& a, const Move& b) { return a.share < b.share; });
}

std::vector<ContactChange> ContactWatch::changes(const std::string& parameter, double side, double range, const core::model::Model& model,
                                                 const core::stepper::Trajectory& trajectory) const {
    std::vector<ContactChange> out;
    double before = 0;
    for (const Move& move : moves_) {
        std::vector<ContactChange> of_move;
        for (const ContactDifference& d : move.differences) {  // in the order of time
            const auto is_same = [&](const ContactChange& change) { return sort_of(change.at) == sort_of(d); };
            if (std::any_of(out.begin(), out.end(), is_same)) continue;  // seen at a lesser move
            if (const auto known = std::find_if(of_move.begin(), of_move.end(), is_same); known != of_move.end()) {
                ++known->count;
                continue;
            }
            of_move.push_back({parameter, side * before * range, side * move.share * range, move.share, d, model.bodies[d.is.a].name,
                               model.bodies[d.is.b].name, time_at(trajectory, d.step + 1)});
        }
        out.insert(out.end(), of_move.begin(), of_move.end());
        before = move.share;
    }
    return out;
}

std::string sentence_of(const ContactChange& change) {
    constexpr double millimetre = 1e-3;
    const auto features = [&](const ContactState& c) {
        return std::string(to_string(c.on_a.kind)) + " of '" + change.body_a + "' on " + to_string(c.on_b.kind) + " of '" + change.body_b +
               "'";
    };
    const Vector3 place = change.at.is.place / millimetre;
    std::array<char, 160> near{};
    std::snprintf(near.data(), near.size(), "near (%.4g, %.4g, %.4g) mm", place.x(), place.y(), place.z());
    std::array<char, 32> time{};
    std::snprintf(time.data(), time.size(), "%.4g", change.time);
    const EventWords& words = words_at(change.at.event);
    const std::string where = change.scenario.empty() ? "" : change.scenario + ": ";
    std::string text = where + "at t = " + time.data() + " s '" + change.body_a + "' and '" + change.body_b + "' " +
                       (change.at.others && words.words_with_others != nullptr ? words.words_with_others : words.words) + ", " +
                       features(change.at.is);
    if (change.at.event == ContactEvent::new_features) text += " in place of " + features(change.at.was);
    text += std::string(", ") + near.data();
    if (change.count > 1) text += "; " + std::to_string(change.count) + " contacts in all";
    return text;
}

}  // namespace fettle::design::gradient_audit
