// SPDX-License-Identifier: MIT
#include "core/clearance/contact_gap.hpp"

#include <algorithm>
#include <utility>

#include "core/clearance/clearance.hpp"
#include "core/contact/contact_set.hpp"

namespace fettle::core::clearance {

namespace {

using contact::ContactPair;
using kinematics::Pose;

constexpr double exact = 1e-9;  // of the distance of meshes [m]

// By the meshes.
Witness nearest_facets(const model::Model& model, const std::vector<Pose>& poses, int a, int b) {
    stepper::Trajectory here = as_assembled(model);
    here.poses.front() = poses;
    ClearanceOptions options;
    options.tolerance = exact;
    options.measure_overlap = false;
    options.sample_nodes = false;
    return certify(model, here, {{a, b}}, options).front().witness;
}

// A triangle's corners; an edge or a vertex is a triangle without area.
std::array<int, 3> corners_of(const geometry::Mesh& mesh, Primitive kind, int index) {
    if (kind == Primitive::triangle) return mesh.triangles[index];
    if (kind == Primitive::edge) return {mesh.edges[index][0], mesh.edges[index][1], mesh.edges[index][1]};
    return {index, index, index};
}

ContactGap gap_of_facets(const model::Model& model, const std::vector<Pose>& poses, int a, int b, const Witness& witness) {
    const bool swapped = !witness.edge_edge && !witness.vertex_on_a;
    ContactGap out;
    out.first = swapped ? b : a;
    out.second = swapped ? a : b;
    const geometry::Mesh &first = model.bodies[out.first].mesh, &second = model.bodies[out.second].mesh;
    ContactPair& pair = out.contact;
    if (witness.edge_edge) {
        pair.type = geometry::PairType::edge_edge;
        const geometry::Edge &ea = first.edges[witness.primitive_a], &eb = second.edges[witness.primitive_b];
        pair.vertex = {ea[0], ea[1], eb[0], eb[1]};
    } else {
        const auto corners =
            corners_of(second, swapped ? witness.kind_a : witness.kind_b, swapped ? witness.primitive_a : witness.primitive_b);
        pair.vertex = {swapped ? witness.primitive_b : witness.primitive_a, corners[0], corners[1], corners[2]};
    }
    for (int i = 0; i < 4; ++i) {
        const int body = i < geometry::first_count(pair.type) ? out.first : out.second;
        pair.x[i] = world_position(poses[body], model.bodies[body].mesh.vertices.col(pair.vertex[i]));
    }
    pair.closest = contact::closest_points(pair.type, pair.x);
    out.gap = contact::gap_of(pair);
    return out;
}

// The two bodies alone, with contact that reaches as far.
model::Model pair_alone(const model::Model& model, int a, int b, double reach) {
    model::Model out;
    for (const int body : {a, b}) {
        out.bodies.push_back(model.bodies[body]);
        out.bodies.back().group = -1;
    }
    out.friction = model.friction;
    out.diagonal = model.diagonal;
    out.dmin = model.dmin;
    out.dhat = std::max(model.dhat, reach - model.dmin);
    out.round_reach = model.round_reach;
    for (const model::FacetSides& sides : model.facet_sides)
        if (sides.a == a && sides.b == b) out.facet_sides.push_back({0, sides.side_a, 1, sides.side_b});
    return out;
}

ContactGap gap_from(const model::Model& model, const std::vector<Pose>& poses, int a, int b, const Witness& witness) {
    ContactGap least = gap_of_facets(model, poses, a, b, witness);
    if (!model.bodies[a].round || !model.bodies[b].round) return least;
    constexpr double beyond = 1.001;  // round surfaces are as near as their facets, or nearer
    const int low = std::min(a, b), high = std::max(a, b);
    const model::Model alone = pair_alone(model, low, high, beyond * least.gap);
    const std::vector<Pose> at{poses[low], poses[high]};
    const contact::ContactSet contacts = contact::find_contacts(alone, ccd::find_candidates(alone, at, 0), at);
    bool found = false;
    for (const contact::BodyPairContacts& list : contacts.pairs)
        for (const ContactPair& pair : list.contacts) {
            if (found && gap_of(pair) >= least.gap) continue;
            found = true;
            least = {list.first == 0 ? low : high, list.second == 0 ? low : high, pair, gap_of(pair)};
        }
    return least;
}

}  // namespace

ContactGap contact_gap(const model::Model& model, const std::vector<Pose>& poses, int a, int b) {
    return gap_from(model, poses, a, b, nearest_facets(model, poses, a, b));
}

std::optional<ContactGap> nearest_contact_gap(const model::Model& model, const std::vector<Pose>& poses, int body,
                                              std::optional<int> other) {
    std::vector<std::pair<int, Witness>> partners;
    for (int i = 0; i < count_of(model.bodies); ++i)
        if ((!other || i == *other) && may_collide(model, body, i)) partners.emplace_back(i, nearest_facets(model, poses, body, i));
    std::stable_sort(partners.begin(), partners.end(), [](const auto& x, const auto& y) { return x.second.distance < y.second.distance; });
    std::optional<ContactGap> least;
    for (const auto& [partner, witness] : partners) {
        if (least && witness.distance - model.round_reach > least->gap) break;
        ContactGap gap = gap_from(model, poses, body, partner, witness);
        if (!least || gap.gap < least->gap) least = std::move(gap);
    }
    return least;
}

}  // namespace fettle::core::clearance
