// SPDX-License-Identifier: MIT
#include "fettle/tests/support/intersection_oracle.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "fettle/core/kinematics/path.hpp"

namespace fettle::tests::support {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = Kernel::Triangle_3;
using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, std::vector<Triangle>::const_iterator>;

std::vector<Triangle> exact_triangles(const std::vector<SpaceTriangle>& triangles) {
    std::vector<Triangle> result;
    result.reserve(triangles.size());
    for (const SpaceTriangle& t : triangles) {
        const auto point = [&](int i) { return Kernel::Point_3(t[i].x(), t[i].y(), t[i].z()); };
        result.emplace_back(point(0), point(1), point(2));
    }
    return result;
}

std::vector<Box> boxes_of(const std::vector<Triangle>& triangles) {
    std::vector<Box> boxes;
    boxes.reserve(triangles.size());
    for (auto t = triangles.begin(); t != triangles.end(); ++t) boxes.emplace_back(t->bbox(), t);
    return boxes;
}

/// One body at one instant.
struct Placed {
    std::vector<SpaceTriangle> triangles;
    Eigen::AlignedBox3d box;
};

Placed place(const core::geometry::Mesh& mesh, const core::kinematics::Pose& pose) {
    Placed placed{triangles_in_space(mesh, pose), {}};
    for (const SpaceTriangle& t : placed.triangles) {
        for (const Vector3& corner : t) placed.box.extend(corner);
    }
    return placed;
}

/// The triangles that reach into `box`, and their indices.
std::pair<std::vector<SpaceTriangle>, std::vector<int>> part_within(const std::vector<SpaceTriangle>& triangles,
                                                                    const Eigen::AlignedBox3d& box) {
    std::pair<std::vector<SpaceTriangle>, std::vector<int>> part;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Eigen::AlignedBox3d own(triangles[i][0]);
        own.extend(triangles[i][1]).extend(triangles[i][2]);
        if (!own.intersects(box)) continue;
        part.first.push_back(triangles[i]);
        part.second.push_back(static_cast<int>(i));
    }
    return part;
}

/// All pairs of bodies in one configuration; `where` says which.
void look(const core::model::Model& model, const std::vector<core::kinematics::Pose>& poses, Intersection where, std::size_t max_count,
          IntersectionReport& report) {
    const int bodies = static_cast<int>(model.bodies.size());
    std::vector<Placed> placed;
    for (int i = 0; i < bodies; ++i) placed.push_back(place(model.bodies[i].mesh, poses[i]));
    ++report.instants;
    for (int a = 0; a < bodies; ++a) {
        for (int b = a + 1; b < bodies; ++b) {
            if (!core::model::may_collide(model, a, b) || !placed[a].box.intersects(placed[b].box)) continue;
            ++report.body_pairs;
            const Eigen::AlignedBox3d common = placed[a].box.intersection(placed[b].box);
            const auto [part_a, index_a] = part_within(placed[a].triangles, common);
            const auto [part_b, index_b] = part_within(placed[b].triangles, common);
            for (const auto& [i, j] : intersecting_pairs(part_a, part_b)) {
                if (report.intersections.size() >= max_count) return;
                where.body_a = a, where.body_b = b;
                where.triangle_a = index_a[i], where.triangle_b = index_b[j];
                report.intersections.push_back(where);
            }
        }
    }
}

}  // namespace

std::vector<std::pair<int, int>> intersecting_pairs(const std::vector<SpaceTriangle>& a, const std::vector<SpaceTriangle>& b) {
    const std::vector<Triangle> exact_a = exact_triangles(a), exact_b = exact_triangles(b);
    std::vector<Box> boxes_a = boxes_of(exact_a), boxes_b = boxes_of(exact_b);
    std::vector<std::pair<int, int>> pairs;
    CGAL::box_intersection_d(boxes_a.begin(), boxes_a.end(), boxes_b.begin(), boxes_b.end(), [&](const Box& box_a, const Box& box_b) {
        if (!CGAL::do_intersect(*box_a.handle(), *box_b.handle())) return;
        pairs.emplace_back(static_cast<int>(std::distance(exact_a.begin(), box_a.handle())),
                           static_cast<int>(std::distance(exact_b.begin(), box_b.handle())));
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::vector<SpaceTriangle> triangles_in_space(const core::geometry::Mesh& mesh, const core::kinematics::Pose& pose) {
    std::vector<SpaceTriangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const core::geometry::Triangle& t : mesh.triangles) {
        const auto corner = [&](int i) { return core::kinematics::world_position(pose, mesh.vertices.col(t[i])); };
        triangles.push_back({corner(0), corner(1), corner(2)});
    }
    return triangles;
}

std::string to_string(const Intersection& at, const core::model::Model& model) {
    std::ostringstream text;
    text << "step " << at.step << ", segment " << at.segment << ", s = " << at.s << ": " << model.bodies[at.body_a].name << " triangle "
         << at.triangle_a << " and " << model.bodies[at.body_b].name << " triangle " << at.triangle_b;
    return text.str();
}

void find_intersections_in_step(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int step,
                                int instants_between, std::size_t max_count, IntersectionReport& report) {
    Intersection where;
    where.step = step;
    const int bodies = static_cast<int>(model.bodies.size());
    std::vector<core::kinematics::Pose> poses(bodies);
    look(model, trajectory.poses[step], where, max_count, report);  // as stored; the chart's start is the same up to rounding
    for (where.segment = 0; where.segment < core::stepper::segment_count(trajectory, step); ++where.segment) {
        for (int k = 1; k <= instants_between + 1; ++k) {  // the last one is the node at the segment's end
            where.s = static_cast<double>(k) / (instants_between + 1);
            for (int i = 0; i < bodies; ++i)
                poses[i] = core::kinematics::pose_at(core::stepper::path_segment(trajectory, step, where.segment, i), where.s);
            look(model, poses, where, max_count, report);
        }
    }
}

IntersectionReport find_intersections(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int instants_between,
                                      std::size_t max_count) {
    IntersectionReport report;
    const int steps = static_cast<int>(trajectory.steps.size());
    for (int step = 0; step < steps; ++step) find_intersections_in_step(model, trajectory, step, instants_between, max_count, report);
    Intersection end;
    end.step = steps > 0 ? steps : -1;
    look(model, trajectory.poses.back(), end, max_count, report);
    return report;
}

}  // namespace fettle::tests::support
