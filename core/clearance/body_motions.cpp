// SPDX-License-Identifier: MIT
#include "core/clearance/body_motions.hpp"

#include <algorithm>
#include <unordered_map>

#include "core/base/parallel.hpp"
#include "core/geometry/body_hierarchy.hpp"

namespace fettle::core::clearance {

std::vector<PathPlace> path_places(const stepper::Trajectory& trajectory, bool motion) {
    if (!motion || trajectory.steps.empty()) return {{}};
    return path_places(trajectory, 0, count_of(trajectory.steps));
}

std::vector<PathPlace> path_places(const stepper::Trajectory& trajectory, int first, int last) {
    std::vector<PathPlace> places;
    for (int t = first; t < last; ++t)
        for (int k = 0; k < stepper::segment_count(trajectory, t); ++k) places.push_back({t, k});
    return places;
}

kinematics::PathSegment segment_at(const stepper::Trajectory& trajectory, const PathPlace& place, int body) {
    if (place.step >= 0) return stepper::path_segment(trajectory, place.step, place.segment, body);
    const kinematics::Pose& pose = trajectory.poses.front()[body];
    kinematics::PathSegment held;
    held.base = pose.rotation;
    held.position_t0 = pose.position;
    return held;
}

std::vector<char> have_usable_numbers(const model::Model& model, const stepper::Trajectory& trajectory,
                                      const std::vector<PathPlace>& places) {
    const auto is_usable = [](const auto& x) { return (x.array().abs() < 1e30).all(); };  // false of what is no number
    const auto are_usable = [&](const PathPlace& place, std::size_t body) {
        const kinematics::Pose& pose = trajectory.poses[std::max(place.step, 0)][body];
        if (!is_usable(pose.rotation) || !is_usable(pose.position)) return false;
        if (place.step < 0) return true;
        const auto& nodes = trajectory.steps[place.step].nodes;
        const auto is_good = [&](const kinematics::ChartPoint& p) { return is_usable(p.position) && is_usable(p.rotation_vector); };
        return is_good(nodes[place.segment][body]) && is_good(nodes[place.segment + 1][body]);
    };
    const std::size_t count = model.bodies.size();
    std::vector<char> usable(count, 1);
    parallel_for(static_cast<int>((count + bodies_at_once - 1) / bodies_at_once), 1, [&](int block) {
        const std::size_t first = static_cast<std::size_t>(block) * bodies_at_once, last = std::min(count, first + bodies_at_once);
        for (std::size_t i = first; i < last; ++i) usable[i] = is_usable(model.bodies[i].mesh.vertices) ? 1 : 0;
        for (const PathPlace& place : places)
            for (std::size_t i = first; i < last; ++i)
                if (usable[i] != 0 && !are_usable(place, i)) usable[i] = 0;
    });
    return usable;
}

std::vector<BodyShape> body_shapes(const model::Model& model, const std::vector<int>& bodies) {
    std::vector<BodyShape> shapes(model.bodies.size());
    std::unordered_map<const geometry::BodyHierarchy*, std::size_t> known;  // copies of a part share it
    std::vector<std::size_t> first;  // of each of `bodies`: the first of them that is a copy of the same part
    first.reserve(bodies.size());
    for (const int body : bodies) first.push_back(known.try_emplace(model.bodies[body].hierarchy.get(), first.size()).first->second);
    parallel_for(count_of(bodies), 1, [&](int i) {
        const model::Body& body = model.bodies[bodies[i]];
        const model::Body& earlier = model.bodies[bodies[first[i]]];
        const bool is_copy =
            first[i] != static_cast<std::size_t>(i) && is_sheet(earlier) == is_sheet(body) && have_same_shape(earlier.mesh, body.mesh);
        if (is_copy) return;
        first[i] = static_cast<std::size_t>(i);
        shapes[bodies[i]].tree = std::make_shared<const PieceTree>(make_piece_tree(body.mesh, *body.hierarchy));
        shapes[bodies[i]].solid = std::make_shared<const certificate::SolidMesh>(certificate::solid_of(body));
    });
    for (std::size_t i = 0; i < bodies.size(); ++i) shapes[bodies[i]] = shapes[bodies[first[i]]];
    return shapes;
}

std::vector<int> bodies_of(const std::vector<PairRequest>& pairs, int count) {
    std::vector<int> bodies;
    for (const PairRequest& pair : pairs) {
        FETTLE_ASSERT(pair.a >= 0 && pair.a < count && pair.b >= 0 && pair.b < count && pair.a != pair.b,
                      "a pair of two bodies of the model");
        bodies.push_back(pair.a);
        bodies.push_back(pair.b);
    }
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    return bodies;
}

}  // namespace fettle::core::clearance
