// SPDX-License-Identifier: MIT
#include "tests/support/intersection_oracle.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <sstream>

#include "core/kinematics/path.hpp"
#include "tests/support/passage_oracle.hpp"

namespace fettle::tests::support {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using core::geometry::PairType;
using core::geometry::PairVertices;
using core::kinematics::Pose;

/// Bodies that move further than this share of their elements' size in a segment are culled anew for each instant.
constexpr double far_motion = 0.25;

using Corners = std::array<Vector3, 3>;  ///< the first vertex_count are an element's

Kernel::Point_3 exact(const Vector3& x) { return {x.x(), x.y(), x.z()}; }
Kernel::Triangle_3 exact_triangle(const Corners& x) { return {exact(x[0]), exact(x[1]), exact(x[2])}; }
Kernel::Segment_3 exact_segment(const Corners& x) { return {exact(x[0]), exact(x[1])}; }

Eigen::AlignedBox3d box_of(const Corners& x, int count) {
    Eigen::AlignedBox3d box(x[0]);
    for (int i = 1; i < count; ++i) box.extend(x[i]);
    return box;
}

bool triangles_intersect(const Corners& a, const Corners& b) { return CGAL::do_intersect(exact_triangle(a), exact_triangle(b)); }
bool edge_and_triangle_intersect(const Corners& edge, const Corners& triangle) {
    return CGAL::do_intersect(exact_segment(edge), exact_triangle(triangle));
}

/// Do two elements intersect in one configuration? Those that meet at single instants only are find_passage's.
bool elements_intersect(ElementKind kind_a, const Corners& a, ElementKind kind_b, const Corners& b) {
    if (kind_a == ElementKind::triangle && kind_b == ElementKind::triangle) return triangles_intersect(a, b);
    if (kind_a == ElementKind::edge && kind_b == ElementKind::triangle) return edge_and_triangle_intersect(a, b);
    if (kind_a == ElementKind::triangle && kind_b == ElementKind::edge) return edge_and_triangle_intersect(b, a);
    return false;
}

Corners corners(const core::geometry::Mesh& mesh, const Element& element, const Pose& pose) {
    Corners x;
    for (int k = 0; k < vertex_count(element); ++k) x[k] = core::kinematics::world_position(pose, mesh.vertices.col(element.vertices[k]));
    return x;
}

/// A body along one segment: poses at the instants, and the path between them.
struct MovingBody {
    std::vector<Pose> poses;
    core::kinematics::PathSegment path;
};

/// Two bodies along one segment. Instants first .. last of `times`.
class PairSearch {
public:
    PairSearch(const core::model::Model& model, const std::vector<ElementTree>& trees, Intersection where, std::size_t max_count,
               IntersectionReport& report)
        : mesh_a_(model.bodies[where.body_a].mesh),
          mesh_b_(model.bodies[where.body_b].mesh),
          tree_a_(trees[where.body_a]),
          tree_b_(trees[where.body_b]),
          where_(where),
          max_count_(max_count),
          report_(report) {}

    /// @param judge_first  false: the first instant is the last one of the segment before
    void search(const MovingBody& a, const MovingBody& b, const std::vector<double>& times, bool judge_first) {
        const std::size_t last = times.size() - 1;
        const Spread spread_a = spread_of(a.path, 0.5), spread_b = spread_of(b.path, 0.5);
        const double motion = spread_a.q + spread_a.r * tree_a_.nodes()[0].radius + spread_b.q + spread_b.r * tree_b_.nodes()[0].radius;
        if (last == 0 || motion <= far_motion * std::min(tree_a_.element_size(), tree_b_.element_size())) {
            search_block(a, b, times, 0, last, judge_first);
        } else if (tree_a_.has_loose_elements() || tree_b_.has_loose_elements()) {  // passages: what is between instants matters
            for (std::size_t i = 0; i < last; ++i) search_block(a, b, times, i, i + 1, i == 0 && judge_first);
        } else {
            for (std::size_t i = judge_first ? 0 : 1; i <= last; ++i) search_block(a, b, times, i, i, true);
        }
    }

private:
    void search_block(const MovingBody& a, const MovingBody& b, const std::vector<double>& times, std::size_t first, std::size_t last,
                      bool judge_first) {
        const std::size_t middle = (first + last) / 2;
        const double duration = std::max(times[middle] - times[first], times[last] - times[middle]);
        const auto pairs =
            near_elements({tree_a_, a.poses[middle], spread_of(a.path, duration)}, {tree_b_, b.poses[middle], spread_of(b.path, duration)});
        for (const auto& [i, j] : pairs) {
            const Element &element_a = tree_a_.elements()[i], &element_b = tree_b_.elements()[j];
            for (std::size_t k = first + (judge_first ? 0 : 1); k <= last; ++k)
                judge(element_a, a.poses[k], element_b, b.poses[k], times[k]);
            if (element_a.kind == ElementKind::triangle && element_b.kind == ElementKind::triangle) continue;
            for (std::size_t k = first; k < last; ++k) judge_passage(element_a, a.path, element_b, b.path, times[k], times[k + 1]);
        }
    }

    void judge(const Element& a, const Pose& pose_a, const Element& b, const Pose& pose_b, double s) {
        const Corners x = corners(mesh_a_, a, pose_a), y = corners(mesh_b_, b, pose_b);
        if (!box_of(x, vertex_count(a)).intersects(box_of(y, vertex_count(b)))) return;
        ++report_.element_pairs;
        if (elements_intersect(a.kind, x, b.kind, y)) add(a, b, s);
    }

    void judge_passage(const Element& a, const core::kinematics::PathSegment& path_a, const Element& b,
                       const core::kinematics::PathSegment& path_b, double s0, double s1) {
        const bool edges = a.kind == ElementKind::edge && b.kind == ElementKind::edge;
        const bool point_a = a.kind == ElementKind::point && b.kind == ElementKind::triangle;
        const bool point_b = b.kind == ElementKind::point && a.kind == ElementKind::triangle;
        if (!edges && !point_a && !point_b) return;
        const auto vertices = [&](double s) -> PairVertices {
            const Corners x = corners(mesh_a_, a, pose_at(path_a, s)), y = corners(mesh_b_, b, pose_at(path_b, s));
            if (edges) return {x[0], x[1], y[0], y[1]};
            return point_a ? PairVertices{x[0], y[0], y[1], y[2]} : PairVertices{y[0], x[0], x[1], x[2]};
        };
        ++report_.element_pairs;
        const double curvature = (path_a.rotation_vector_step.squaredNorm() * tree_a_.nodes()[0].radius +
                                  path_b.rotation_vector_step.squaredNorm() * tree_b_.nodes()[0].radius) /
                                 8;
        const double s = find_passage(edges ? PairType::edge_edge : PairType::point_triangle, vertices, s0, s1, curvature);
        if (s >= 0) add(a, b, s);
    }

    void add(const Element& a, const Element& b, double s) {
        if (report_.intersections.size() >= max_count_) return;
        where_.element_a = a, where_.element_b = b, where_.s = s;
        report_.intersections.push_back(where_);
    }

    const core::geometry::Mesh &mesh_a_, &mesh_b_;
    const ElementTree &tree_a_, &tree_b_;
    Intersection where_;
    std::size_t max_count_;
    IntersectionReport& report_;
};

/// Bounds of a body over a segment, in the world: boxes at the instants, and how far it gets from the nearest of them.
Eigen::AlignedBox3d swept_box(const ElementTree& tree, const MovingBody& body, double spacing) {
    const ElementTree::Node& root = tree.nodes()[0];
    Eigen::AlignedBox3d box;
    for (const Pose& pose : body.poses) {
        const Vector3 center = core::kinematics::world_position(pose, root.center), half = pose.rotation.cwiseAbs() * root.half;
        box.extend(Vector3(center - half)).extend(Vector3(center + half));
    }
    const Spread spread = spread_of(body.path, spacing / 2);
    const Vector3 margin = Vector3::Constant(spread.q + spread.r * root.radius);
    return {box.min() - margin, box.max() + margin};
}

void search_all(const core::model::Model& model, const std::vector<ElementTree>& trees, const std::vector<MovingBody>& bodies,
                const std::vector<double>& times, Intersection where, bool judge_first, std::size_t max_count, IntersectionReport& report) {
    std::vector<Eigen::AlignedBox3d> boxes;
    const double spacing = times.size() > 1 ? times[1] - times[0] : 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) boxes.push_back(swept_box(trees[i], bodies[i], spacing));
    const int count = count_of(bodies);
    for (where.body_a = 0; where.body_a < count; ++where.body_a)
        for (where.body_b = where.body_a + 1; where.body_b < count; ++where.body_b) {
            if (!boxes[where.body_a].intersects(boxes[where.body_b])) continue;
            if (!core::model::may_collide(model, where.body_a, where.body_b)) continue;
            if (report.intersections.size() >= max_count) return;
            PairSearch(model, trees, where, max_count, report).search(bodies[where.body_a], bodies[where.body_b], times, judge_first);
        }
}

}  // namespace

std::vector<std::pair<int, int>> intersecting_pairs(const std::vector<SpaceTriangle>& a, const std::vector<SpaceTriangle>& b) {
    std::vector<std::pair<int, int>> pairs;
    const auto mesh_of = [](const std::vector<SpaceTriangle>& triangles) {
        core::geometry::Mesh mesh;
        mesh.vertices.resize(3, 3 * triangles.size());
        for (int i = 0; i < count_of(triangles); ++i) {
            for (int k = 0; k < 3; ++k) mesh.vertices.col(3 * i + k) = triangles[i][k];
            mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        return mesh;
    };
    if (a.empty() || b.empty()) return pairs;
    const ElementTree tree_a(mesh_of(a)), tree_b(mesh_of(b));
    const SpreadBody still_a{tree_a, Pose(), spread_of({}, 0)}, still_b{tree_b, Pose(), spread_of({}, 0)};
    for (const auto& [i, j] : near_elements(still_a, still_b)) {
        const int first = tree_a.elements()[i].index, second = tree_b.elements()[j].index;
        if (box_of(a[first], 3).intersects(box_of(b[second], 3)) && triangles_intersect(a[first], b[second]))
            pairs.emplace_back(first, second);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::vector<SpaceTriangle> triangles_in_space(const core::geometry::Mesh& mesh, const Pose& pose) {
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
    text << "step " << at.step << ", segment " << at.segment << ", s = " << at.s << ": " << model.bodies[at.body_a].name << " "
         << to_string(at.element_a.kind) << " " << at.element_a.index << " and " << model.bodies[at.body_b].name << " "
         << to_string(at.element_b.kind) << " " << at.element_b.index;
    return text.str();
}

IntersectionOracle::IntersectionOracle(const core::model::Model& model) : model_(model) {
    for (const core::model::Body& body : model.bodies) trees_.emplace_back(body.mesh);
}

void IntersectionOracle::look_at(const std::vector<Pose>& poses, const Intersection& where, std::size_t max_count,
                                 IntersectionReport& report) const {
    std::vector<MovingBody> bodies;
    for (const Pose& pose : poses)
        bodies.push_back({{pose}, {pose.rotation, Vector3::Zero(), Vector3::Zero(), pose.position, Vector3::Zero()}});
    ++report.instants;
    search_all(model_, trees_, bodies, {where.s}, where, true, max_count, report);
}

void IntersectionOracle::look_at_step(const core::stepper::Trajectory& trajectory, int step, int instants_between, std::size_t max_count,
                                      IntersectionReport& report) const {
    std::vector<double> times;
    for (int k = 0; k <= instants_between + 1; ++k) times.push_back(static_cast<double>(k) / (instants_between + 1));
    Intersection where;
    where.step = step;
    std::vector<MovingBody> bodies(model_.bodies.size());
    ++report.instants;
    for (where.segment = 0; where.segment < core::stepper::segment_count(trajectory, step); ++where.segment) {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            bodies[i].path = core::stepper::path_segment(trajectory, step, where.segment, static_cast<int>(i));
            bodies[i].poses.clear();
            for (const double s : times) bodies[i].poses.push_back(pose_at(bodies[i].path, s));
            // As stored; the chart's start is the same up to rounding.
            if (where.segment == 0) bodies[i].poses[0] = trajectory.poses[step][i];
        }
        report.instants += instants_between + 1;
        search_all(model_, trees_, bodies, times, where, where.segment == 0, max_count, report);
    }
}

IntersectionReport find_intersections(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int instants_between,
                                      std::size_t max_count) {
    IntersectionReport report;
    const IntersectionOracle oracle(model);
    const int steps = count_of(trajectory.steps);
    for (int step = 0; step < steps; ++step) oracle.look_at_step(trajectory, step, instants_between, max_count, report);
    Intersection end;
    end.step = steps > 0 ? steps : -1;
    oracle.look_at(trajectory.poses.back(), end, max_count, report);
    return report;
}

}  // namespace fettle::tests::support
