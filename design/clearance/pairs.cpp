// SPDX-License-Identifier: MIT
#include "design/clearance/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <sstream>
#include <unordered_map>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/nearest_word.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/expression.hpp"
#include "design/quantities/in_scenario.hpp"
#include "design/reading/process_file.hpp"
#include "design/tolerances/process_clearance.hpp"

namespace fettle::design::clearance {

namespace {

using core::model::Model;

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
    return parts;
}

class Selector {
public:
    Selector(const Model& model, const PairOptions& options, bool moves, const BodyPairs& wanted)
        : model_(model), options_(options), moves_(moves), wanted_(wanted) {}

    Result<PairSelection> select() {
        for (size_t i = 0; i < model_.bodies.size(); ++i) bodies_.push_back({model_.bodies[i].name, {static_cast<int>(i)}, false});
        for (const std::string& text : options_.groups) add_group(text);
        for (const Unit& body : bodies_) {
            const auto holds = [&](const Unit& g) { return std::count(g.bodies.begin(), g.bodies.end(), body.bodies[0]) > 0; };
            if (std::none_of(groups_.begin(), groups_.end(), holds)) units_.push_back(body);
        }
        units_.insert(units_.end(), groups_.begin(), groups_.end());
        if (options_.pairs.empty()) {
            add_all();
        } else {
            for (const std::string& token : split(options_.pairs, ',')) add_token(token);
        }
        for (const std::string& token : options_.touches) allow_touch(token);
        for (const std::string& token : split(options_.ignore, ',')) ignore(token);
        if (!errors_.empty()) return errors_;
        require();
        if (!errors_.empty()) return errors_;
        tidy_left_out();
        tidy_exempt();
        return std::move(selection_);
    }

private:
    struct Named {
        std::vector<Unit> units;
        bool wildcard = false;
    };

    void fail(const char* option, ErrorCode code, std::string message) { errors_.push_back({code, option, std::move(message)}); }

    void add_group(const std::string& text) {
        const size_t equals = text.find('=');
        Unit group{text.substr(0, equals), {}, true};
        if (equals == std::string::npos || group.name.empty()) {
            fail("--group", ErrorCode::parse, "\"" + text + "\" is not a group; write name=a,b,c with names of bodies");
            return;
        }
        for (const Unit& other : bodies_) {
            if (other.name == group.name) fail("--group", ErrorCode::inconsistent, "\"" + group.name + "\" is a body's name already");
        }
        for (const std::string& part : split(text.substr(equals + 1), ',')) {
            const Named found = find(part, bodies_, "--group");
            for (const Unit& body : found.units) group.bodies.push_back(body.bodies[0]);
        }
        std::sort(group.bodies.begin(), group.bodies.end());
        group.bodies.erase(std::unique(group.bodies.begin(), group.bodies.end()), group.bodies.end());
        for (const Unit& other : groups_) {
            for (const int body : group.bodies) {
                if (std::count(other.bodies.begin(), other.bodies.end(), body))
                    fail("--group", ErrorCode::inconsistent,
                         "\"" + model_.bodies[body].name + "\" is in both " + other.name + " and " + group.name);
            }
        }
        groups_.push_back(group);
    }

    Named find(const std::string& name, const std::vector<Unit>& among, const char* option) {
        Named found;
        found.wildcard = name.find('*') != std::string::npos;
        for (const Unit& unit : among) {
            if (found.wildcard ? core::base::matches_pattern(name, unit.name) : unit.name == name) found.units.push_back(unit);
        }
        if (!found.units.empty()) return found;
        std::vector<std::string_view> known;
        known.reserve(among.size());
        for (const Unit& unit : among) known.push_back(unit.name);
        std::string message = (found.wildcard ? "no name matches \"" : "there is no body \"") + name + "\"";
        message += "; " + core::files::did_you_mean(found.wildcard ? "" : name, known);
        fail(option, ErrorCode::out_of_range, message);
        return found;
    }

    // Wildcards stand for what the report has rows of; a body of a group can still be named itself.
    Named find_unit(const std::string& name, const char* option) {
        if (name.find('*') != std::string::npos) return find(name, units_, option);
        std::vector<Unit> all = bodies_;
        all.insert(all.end(), groups_.begin(), groups_.end());
        return find(name, all, option);
    }

    struct Token {
        Named a, b;
        std::optional<double> minimum;
        bool good = false;
    };

    Token read_token(const std::string& text, const char* option, bool with_minimum) {
        Token token;
        const size_t equals = with_minimum ? text.rfind('=') : std::string::npos;
        const std::string names = text.substr(0, equals);
        const size_t colon = names.find(':');
        if (colon == std::string::npos || names.find(':', colon + 1) != std::string::npos) {
            fail(option, ErrorCode::parse,
                 "\"" + text + "\" is not a pair; write " + (option == std::string_view("--allow-touch") ? "A:B" : "A:B,C:D") +
                     " with names of bodies" + (with_minimum ? ", or A:B=0.4mm" : ""));
            return token;
        }
        const size_t errors_before = errors_.size();
        token.a = find_unit(names.substr(0, colon), option);
        token.b = find_unit(names.substr(colon + 1), option);
        if (equals != std::string::npos) {
            const Result<double> minimum = core::base::parse_length(text.substr(equals + 1), option);
            errors_.insert(errors_.end(), minimum.errors().begin(), minimum.errors().end());
            if (minimum) token.minimum = *minimum;
            if (minimum && *minimum < 0) fail(option, ErrorCode::out_of_range, "\"" + text + "\": a length is not negative");
        }
        token.good = errors_.size() == errors_before;
        return token;
    }

    static bool same(const Unit& x, const Unit& y) { return x.name == y.name; }
    static bool overlap(const Unit& x, const Unit& y) {
        return std::any_of(x.bodies.begin(), x.bodies.end(), [&](int i) { return std::count(y.bodies.begin(), y.bodies.end(), i) > 0; });
    }

    void add_token(const std::string& text) {
        const Token token = read_token(text, "--pairs", true);
        if (!token.good) return;
        const bool named = !token.a.wildcard && !token.b.wildcard;
        if (named && overlap(token.a.units[0], token.b.units[0])) {
            fail("--pairs", ErrorCode::inconsistent, "\"" + text + "\" pairs a body with itself");
            return;
        }
        for (const Unit& a : token.a.units) {
            for (const Unit& b : token.b.units) {
                if (!overlap(a, b)) add(a, b, named, token.minimum);
            }
        }
    }

    void add_all() {
        for (size_t i = 0; i < units_.size(); ++i) {
            for (size_t j = i + 1; j < units_.size(); ++j) add(units_[i], units_[j], false, std::nullopt);
        }
    }

    // Later tokens make earlier ones more precise: `*:*,pin:plate=0.4mm`.
    void add(const Unit& a, const Unit& b, bool named, std::optional<double> minimum) {
        PairSpec pair{a, b, minimum.value_or(-1), minimum ? "--pairs" : "", false, 0, named, {}};
        for (const int i : a.bodies) {
            for (const int j : b.bodies) {
                if (named || is_judged(i, j))
                    pair.body_pairs.emplace_back(i, j);
                else if (BodyPairs* exempt = exempt_as(i, j))
                    exempt->emplace_back(std::minmax(i, j));
            }
        }
        if (pair.body_pairs.empty()) {
            for (const int i : a.bodies)
                for (const int j : b.bodies)
                    if (exempt_as(i, j) == nullptr) pair.body_pairs.emplace_back(i, j);
            if (!pair.body_pairs.empty()) selection_.left_out.push_back(pair);
            return;
        }
        const auto [place, is_new] = places_.try_emplace(key(a, b), selection_.pairs.size());
        if (is_new) {
            selection_.pairs.push_back(std::move(pair));
            return;
        }
        PairSpec& known = selection_.pairs[place->second];
        if (minimum) {
            known.minimum = *minimum;
            known.required_by = pair.required_by;
        }
        if (named && !known.named) {
            known.named = true;
            known.a = a;
            known.b = b;
            known.body_pairs = pair.body_pairs;
        }
    }

    // The same in either order.
    static std::string key(const Unit& a, const Unit& b) {
        return a.name < b.name ? a.name + std::string(1, '\0') + b.name : b.name + std::string(1, '\0') + a.name;
    }

    // Where two are listed that the scene does not want to be judged; null: it does.
    BodyPairs* exempt_as(int i, int j) {
        switch (core::model::why_no_contact(model_, i, j)) {
            case core::model::NoContact::ignored:
                return &selection_.ignored_by_scene;
            case core::model::NoContact::one_group:
                return &selection_.one_group;
            case core::model::NoContact::joined:
                return &selection_.joined;
            case core::model::NoContact::none:
            case core::model::NoContact::same_body:
            case core::model::NoContact::none_dynamic:
                break;
        }
        return nullptr;
    }

    // Patterns of --pairs ask for whatever they match and nothing exempts.
    bool is_judged(int i, int j) {
        if (std::binary_search(wanted_.begin(), wanted_.end(), std::pair<int, int>(std::minmax(i, j)))) return true;
        if (!options_.pairs.empty() || !moves_) return exempt_as(i, j) == nullptr;
        return judged_by_default(model_, i, j);
    }

    // Wildcards stand for the pairs that there are; a pair of names becomes one.
    void allow_touch(const std::string& text) {
        const Token token = read_token(text, "--allow-touch", true);
        if (!token.good) return;
        if (token.minimum && !(*token.minimum > 0))
            return fail("--allow-touch", ErrorCode::out_of_range, "\"" + text + "\": a depth is greater than 0");
        if (!token.a.wildcard && !token.b.wildcard) {
            const Unit &a = token.a.units[0], &b = token.b.units[0];
            if (overlap(a, b)) return fail("--allow-touch", ErrorCode::inconsistent, "\"" + text + "\" pairs a body with itself");
            add(a, b, true, std::nullopt);
        }
        bool found = false;
        for (PairSpec& pair : selection_.pairs) {
            if (!is_of(pair, token)) continue;
            found = true;
            if (pair.minimum > 0 && pair.required_by == "--pairs") {
                fail("--allow-touch", ErrorCode::inconsistent,
                     "\"" + text + "\": --pairs requires a clearance of the same pair; give one of the two");
                return;
            }
            pair.may_touch = true;
            pair.touch_depth = token.minimum.value_or(0);
        }
        if (!found) fail("--allow-touch", ErrorCode::out_of_range, "no pair that is judged matches \"" + text + "\"");
    }

    static bool is_of(const PairSpec& pair, const Token& token) {
        const auto among = [](const Unit& unit, const Named& named) {
            return std::any_of(named.units.begin(), named.units.end(), [&](const Unit& u) { return same(u, unit); });
        };
        return (among(pair.a, token.a) && among(pair.b, token.b)) || (among(pair.a, token.b) && among(pair.b, token.a));
    }

    void ignore(const std::string& text) {
        const Token token = read_token(text, "--ignore", false);
        if (!token.good) return;
        auto& pairs = selection_.pairs;
        const auto hit = [&](const PairSpec& p) { return is_of(p, token); };
        for (const PairSpec& pair : pairs) {
            if (hit(pair)) selection_.ignored.push_back(pair.a.name + ":" + pair.b.name);
        }
        pairs.erase(std::remove_if(pairs.begin(), pairs.end(), hit), pairs.end());
        auto& out = selection_.left_out;
        out.erase(std::remove_if(out.begin(), out.end(), hit), out.end());
        std::erase_if(selection_.joined, [&](const std::pair<int, int>& joined) {
            const PairSpec pair{unit_of(joined.first), unit_of(joined.second), 0, "", false, 0, false, {}};
            if (!is_of(pair, token)) return false;
            selection_.ignored.push_back(name_of(model_, joined));
            return true;
        });
    }

    // The row of the report that a body is in.
    const Unit& unit_of(int body) const {
        return *std::find_if(units_.begin(), units_.end(),
                             [&](const Unit& unit) { return std::count(unit.bodies.begin(), unit.bodies.end(), body) > 0; });
    }

    // The longest side of the box of a part as it is drawn: the largest part of a group.
    double size_of(const Unit& unit) const {
        double size = 0;
        for (const int i : unit.bodies) {
            const Matrix3X& x = model_.bodies[i].mesh.vertices;
            size = std::max(size, core::geometry::box_sides(x).maxCoeff());
        }
        return size;
    }

    void require() {
        std::optional<tolerances::Process> process;
        if (!options_.process.empty()) {
            const auto found = reading::find_process(options_.process, "", "--process");
            errors_.insert(errors_.end(), found.errors().begin(), found.errors().end());
            if (!found) return;
            process = *found;
        }
        bool by_process = false;
        for (PairSpec& pair : selection_.pairs) {
            if (!pair.required_by.empty()) continue;
            pair.minimum = 0;
            if (pair.may_touch) continue;
            const std::string name = pair.a.name + ":" + pair.b.name;
            if (options_.minimum) {
                pair.minimum = *options_.minimum;
                pair.required_by = "--minimum";
            } else if (process) {
                const Result<double> required = tolerances::required_clearance(*process, size_of(pair.a), size_of(pair.b), "pair " + name);
                errors_.insert(errors_.end(), required.errors().begin(), required.errors().end());
                pair.minimum = required ? *required : 0;
                pair.required_by = "--process " + options_.process;
                by_process = true;
            }
        }
        const std::string borrowed = by_process ? tolerances::borrowed_clearance(*process) : "";
        if (!borrowed.empty()) selection_.notes.push_back("--process " + options_.process + ": " + borrowed);
    }

    // Each once, and not what another token named.
    void tidy_left_out() {
        std::set<std::string> told;
        for (const PairSpec& pair : selection_.pairs) told.insert(key(pair.a, pair.b));
        std::vector<PairSpec> once;
        for (PairSpec& pair : selection_.left_out) {
            pair.minimum = 0;
            if (told.insert(key(pair.a, pair.b)).second) once.push_back(std::move(pair));
        }
        selection_.left_out = std::move(once);
    }

    // Each once, and not what was named in spite of it.
    void tidy_exempt() {
        std::set<std::pair<int, int>> judged;
        for (const PairSpec& pair : selection_.pairs)
            for (const auto& [a, b] : pair.body_pairs) judged.insert(std::minmax(a, b));
        for (BodyPairs* pairs : {&selection_.ignored_by_scene, &selection_.one_group, &selection_.joined}) {
            std::sort(pairs->begin(), pairs->end());
            pairs->erase(std::unique(pairs->begin(), pairs->end()), pairs->end());
            std::erase_if(*pairs, [&](const auto& pair) { return judged.count(pair) > 0; });
        }
    }

    const Model& model_;
    const PairOptions& options_;
    bool moves_;
    const BodyPairs& wanted_;
    std::vector<Unit> bodies_, groups_, units_;  // units: rows of the report by default
    PairSelection selection_;
    std::unordered_map<std::string, size_t> places_;  // in selection_.pairs while it grows, by key()
    Errors errors_;
};

/// A constraint's clearance, and what it is required to be [m].
struct BoundedClearance {
    const quantities::ClearanceRange* range = nullptr;
    double minimum = 0;
};

// A clearance, or one less a limit that follows from parameters: a formula f(q) of slope 1 in the clearance q requires q >= bound - f(0).
std::optional<BoundedClearance> bounded_clearance(const description::Design& design, const description::Constraint& constraint) {
    const description::QuantityFacts facts = quantities::without_scenario(*constraint.quantity).facts();
    if (facts.clearance != nullptr) return BoundedClearance{facts.clearance, constraint.bounds.lower};
    if (facts.kind != description::QuantityFacts::Kind::formula || facts.parts.size() != 1) return std::nullopt;
    const quantities::NamedQuantity& part = facts.parts.front();
    const quantities::ClearanceRange* range = quantities::clearance_of(*part.quantity);
    if (range == nullptr) return std::nullopt;
    const core::expression::Formula& formula = *facts.formula;
    const auto value_at = [&](double q) {
        std::vector<double> inputs;
        for (const std::string& input : formula.inputs) {
            const auto parameter = std::find_if(design.parameters.begin(), design.parameters.end(),
                                                [&](const description::Parameter& each) { return each.name == input; });
            const bool is_clearance = input == part.name || parameter == design.parameters.end();
            inputs.push_back(is_clearance ? q : parameter->value);
        }
        return core::expression::value_of<double>(formula, inputs);
    };
    const double at_zero = value_at(0);
    const bool has_slope_1 = std::abs(value_at(1) - at_zero - 1) < 1e-12 && std::abs(value_at(2) - at_zero - 2) < 1e-12;
    if (!has_slope_1) return std::nullopt;
    return BoundedClearance{range, constraint.bounds.lower - at_zero};
}

std::optional<PairMinimum> asked_minimum(const description::Design& design, const description::Constraint& constraint, MinimumOver over) {
    const std::optional<BoundedClearance> bounded = bounded_clearance(design, constraint);
    if (!bounded || !(bounded->minimum > 0) || !std::isfinite(bounded->minimum)) return std::nullopt;
    const quantities::ClearanceRange& range = *bounded->range;
    const MinimumOver own = range.ranges ? MinimumOver::ranges : range.motion ? MinimumOver::motion : MinimumOver::assembly;
    const bool is_whole = range.faces_a.empty() && range.faces_b.empty() && !range.from && !range.to;
    if (own != over || !is_whole) return std::nullopt;
    const auto [a, b] = std::minmax(range.a, range.b);
    return PairMinimum{a, b, bounded->minimum};
}

}  // namespace

std::vector<PairMinimum> design_minima(const description::Design& design, int scenario, MinimumOver over) {
    std::vector<PairMinimum> minima;
    for (const description::Constraint& constraint : design.constraints) {
        if (!constraint.quantity->is_about(scenario)) continue;
        const std::optional<PairMinimum> asked = asked_minimum(design, constraint, over);
        if (!asked) continue;
        const auto known = std::find_if(minima.begin(), minima.end(),
                                        [&](const PairMinimum& other) { return other.a == asked->a && other.b == asked->b; });
        if (known == minima.end())
            minima.push_back(*asked);
        else
            known->minimum = std::max(known->minimum, asked->minimum);
    }
    return minima;
}

BodyPairs design_pairs(const description::Design& design) {
    BodyPairs pairs;
    const std::function<void(const description::Quantity*)> add = [&](const description::Quantity* quantity) {
        const description::QuantityFacts facts = quantity->facts();
        const quantities::ClearanceRange* range = facts.clearance;
        if (range != nullptr && range->faces_a.empty() && range->faces_b.empty())  // what else is nearer than faces is not asked for
            pairs.emplace_back(std::minmax(range->a, range->b));
        if (facts.kind == description::QuantityFacts::Kind::formula)
            for (const quantities::NamedQuantity& part : facts.parts) add(part.quantity.get());
    };
    for (const description::ObjectiveTerm& term : design.objective) add(term.quantity.get());
    for (const description::Constraint& constraint : design.constraints) add(constraint.quantity.get());
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

Result<PairSelection> select_pairs(const Model& model, const PairOptions& options, bool moves, const BodyPairs& wanted) {
    return Selector(model, options, moves, wanted).select();
}

bool judged_by_default(const core::model::Model& model, int a, int b) {
    const auto dynamic = [](const core::model::Body& body) { return body.type == core::scene::BodyType::dynamic_body; };
    const core::model::NoContact why = core::model::why_no_contact(model, a, b);
    if (std::any_of(model.bodies.begin(), model.bodies.end(), dynamic)) return why == core::model::NoContact::none;
    if (why != core::model::NoContact::none_dynamic) return false;
    const auto still = [](const core::model::Body& body) { return body.type == core::scene::BodyType::static_body; };
    return !still(model.bodies[a]) || !still(model.bodies[b]) || std::all_of(model.bodies.begin(), model.bodies.end(), still);
}

std::vector<std::string> pair_names(const std::vector<PairSpec>& pairs) {
    std::vector<std::string> names;
    for (const PairSpec& pair : pairs) names.push_back(pair.a.name + ":" + pair.b.name);
    return names;
}

std::string name_of(const Model& model, const std::pair<int, int>& bodies) {
    return model.bodies[bodies.first].name + ":" + model.bodies[bodies.second].name;
}

std::vector<std::string> pair_names(const Model& model, const BodyPairs& pairs) {
    std::vector<std::string> names;
    for (const auto& pair : pairs) names.push_back(name_of(model, pair));
    return names;
}

BodyPairs uncovered_pairs(const Model& model, const PairSelection& selection) {
    std::set<std::pair<int, int>> covered;
    for (const PairSpec& pair : selection.pairs)
        for (const auto& [a, b] : pair.body_pairs) covered.insert(std::minmax(a, b));
    BodyPairs list;
    const auto count = count_of(model.bodies);
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b)
            if (covered.count({a, b}) == 0) list.emplace_back(a, b);
    return list;
}

BodyPairs unexplained_pairs(const Model& model, const BodyPairs& uncovered, const PairSelection& selection) {
    std::set<std::pair<int, int>> told;
    for (const BodyPairs* pairs : {&selection.ignored_by_scene, &selection.one_group, &selection.joined})
        told.insert(pairs->begin(), pairs->end());
    for (const PairSpec& pair : selection.left_out)
        for (const auto& [a, b] : pair.body_pairs) told.insert(std::minmax(a, b));
    BodyPairs list;
    const std::set<std::string> ignored(selection.ignored.begin(), selection.ignored.end());
    std::copy_if(uncovered.begin(), uncovered.end(), std::back_inserter(list), [&](const auto& pair) {
        return told.count(pair) == 0 && ignored.count(name_of(model, pair)) == 0 &&
               ignored.count(name_of(model, {pair.second, pair.first})) == 0;
    });
    return list;
}

}  // namespace fettle::design::clearance
