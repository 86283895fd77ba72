// SPDX-License-Identifier: MIT
#include "core/setup/round_contact.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/text.hpp"
#include "core/contact/round_contacts.hpp"

namespace fettle::core::setup {
namespace {

using geometry::CornerKind;
using geometry::RoundSurfaces;
using model::FacetSides;
using model::Model;

// Corners one after another whose arcs are about one line: a bore, a pin, the bottom of a slot.
struct Bearing {
    int side = 0;
    bool is_hollow = false, is_circle = false;
    double radius = 0, cover = 0;
};

// @return  of three corners or more; two may be of any curve
std::vector<Bearing> bearings_of(const RoundSurfaces& round) {
    constexpr double alike = 1e-6;
    constexpr int fewest = 3;
    std::vector<Bearing> out;
    for (int s = 0; s < count_of(round.sides); ++s) {
        const RoundSurfaces::Side& side = round.sides[s];
        const auto& corners = round.mesh_sides.sides[s].corners;
        int first = 0;
        const auto goes_on = [&](int k) {
            const int c = round.centre(s, k, 0), c0 = round.centre(s, first, 0);
            return k < count_of(corners) && corners[k].kind == corners[first].kind &&
                   (round.centres.col(c) - round.centres.col(c0)).norm() <= alike * round.radii[c0];
        };
        while (first < count_of(corners)) {
            int end = first + 1;
            while (end < count_of(corners) && goes_on(end)) ++end;
            const CornerKind kind = corners[first].kind;
            if (end - first >= fewest && (kind == CornerKind::convex_round || kind == CornerKind::concave_round))
                out.push_back({s, kind == CornerKind::concave_round, side.is_circle, round.radii[round.centre(s, first, 0)], side.cover});
            first = end;
        }
    }
    return out;
}

// Why two sides take facets: the room that they leave each other, and the room that they would need.
struct Narrow {
    double has = 0, needs = 0;
    bool is_play = true;  // else the gap at the start
};
using NarrowSides = std::map<FacetSides, Narrow>;

// @param a, b  of these bodies
void add_narrow_bearings(const Model& model, int a, int b, const std::vector<Bearing>& of_a, const std::vector<Bearing>& of_b,
                         NarrowSides& out) {
    for (const Bearing& x : of_a)
        for (const Bearing& y : of_b) {
            if (x.is_hollow == y.is_hollow) continue;
            const double play = x.is_hollow ? x.radius - y.radius : y.radius - x.radius;
            const bool is_whole = x.is_circle && y.is_circle;
            const double needs = x.cover + y.cover + model.dmin + (is_whole ? 0 : model.dhat);
            if (play > 0 && play < needs) out.try_emplace({a, x.side, b, y.side}, Narrow{play, needs, true});
        }
}

void add_narrow_starts(const Model& model, const ccd::Candidates& candidates, const std::vector<kinematics::Pose>& poses,
                       NarrowSides& out) {
    const contact::WorldVertices vertices(model, candidates, poses);
    for (const ccd::BodyPairCandidates& pair : candidates.pairs) {
        if (pair.sides.empty()) continue;
        for (const contact::SidesGap& sides : contact::gaps_of_sides({model, pair, poses, vertices})) {
            const double between = sides.gap + sides.covers;  // surfaces that overlap too are no matter of covers
            if (sides.gap <= model.dmin && between > model.dmin)
                out.try_emplace({pair.a, sides.side_a, pair.b, sides.side_b}, Narrow{between, sides.covers + model.dmin, false});
        }
    }
}

NarrowSides narrow_sides(const Model& model) {
    std::vector<kinematics::Pose> poses;
    for (const model::Body& body : model.bodies) poses.push_back(body.pose_start);
    const ccd::Candidates candidates = ccd::find_candidates(model, poses, 0);
    NarrowSides out;
    std::map<int, std::vector<Bearing>> bearings;
    const auto of = [&](int body) -> const std::vector<Bearing>& {
        const auto [entry, is_new] = bearings.try_emplace(body);
        if (is_new) entry->second = bearings_of(*model.bodies[body].round);
        return entry->second;
    };
    for (const ccd::BodyPairCandidates& pair : candidates.pairs) add_narrow_bearings(model, pair.a, pair.b, of(pair.a), of(pair.b), out);
    add_narrow_starts(model, candidates, poses, out);
    return out;
}

std::string warning_of(const Model& model, const FacetSides& sides, const Narrow& narrow) {
    const auto length = [&](double metres) { return base::length_text(metres, model.length_unit); };
    return "between `" + model.bodies[sides.a].name + "` and `" + model.bodies[sides.b].name + "` contact takes " +
           (narrow.is_play ? "some facets as they are: a play of " : "some facets as they are: a gap of ") + length(narrow.has) +
           ", and round surfaces need " + length(narrow.needs) + " there; finer facets need less" +
           (narrow.is_play ? ", and a smaller contact.dhat" : "");
}

// One for each pair of bodies.
void warn(const NarrowSides& narrow, Model& model) {
    constexpr int most = 5;
    std::map<std::pair<int, int>, std::string> of_bodies;
    for (const auto& [sides, why] : narrow) of_bodies.try_emplace({sides.a, sides.b}, warning_of(model, sides, why));
    int told = 0;
    for (const auto& [bodies, text] : of_bodies)
        if (told++ < most) model.warnings.push_back(text);
    if (told > most)
        model.warnings.push_back("contact takes some facets as they are between " + std::to_string(told - most) + " more pairs of bodies");
}

}  // namespace

void add_round_contact(const std::optional<bool>& wanted, const std::optional<std::vector<FacetSides>>& facet_sides, Model& model) {
    if (!wanted.value_or(true)) return;
    if (model.area_weighted || model.contact_damping_time > 0) {
        if (wanted)
            model.warnings.push_back(std::string("contact.round has no effect with ") +
                                     (model.area_weighted ? "contact.area_weighted" : "contact.damping_time") +
                                     ": contact takes facets as they are");
        return;
    }
    std::vector<std::shared_ptr<const RoundSurfaces>> round(model.bodies.size());
    base::parallel_for(count_of(model.bodies), 1,
                       [&](int i) { round[i] = std::make_shared<const RoundSurfaces>(geometry::round_surfaces(model.bodies[i].mesh)); });
    double height = 0;
    for (const auto& of : round)
        if (of->any()) height = std::max(height, of->largest_height);
    if (!(height > 0)) return;  // each contact is that of a side with a side: nothing is gained where none is round
    model.round_reach = 2 * height;
    for (std::size_t i = 0; i < round.size(); ++i) model.bodies[i].round = round[i];
    if (facet_sides) {
        model.facet_sides = *facet_sides;
        return;
    }
    const NarrowSides narrow = narrow_sides(model);
    for (const auto& [sides, why] : narrow) model.facet_sides.push_back(sides);
    warn(narrow, model);
}

}  // namespace fettle::core::setup
