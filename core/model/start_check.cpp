// SPDX-License-Identifier: MIT
#include "core/model/start_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/stop.hpp"
#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/distance.hpp"
#include "core/geometry/overlapping_boxes.hpp"
#include "core/geometry/predicates.hpp"
#include "core/model/joint_fit.hpp"
#include "core/solids/closure.hpp"
#include "core/solids/mesh_validity.hpp"
#include "core/solids/point_in_solid.hpp"

namespace fettle::core::model {
namespace {

using geometry::HierarchyElement;
using geometry::HierarchyNode;
using Corners = std::array<Vector3, 3>;  ///< of an element; an edge or a point repeats its last vertex

struct CenteredBox {
    Vector3 center, half;
};

/// What is asked of one mesh again and again, and found out when it is wanted first. Bodies that share a hierarchy have one mesh.
/// By several threads, too.
template <class T>
class Fact {
public:
    template <class Find>
    const T& get(const Find& find) {
        std::call_once(found_, [&] { value_ = find(); });
        return value_;
    }

private:
    std::once_flag found_;
    T value_{};
};
struct MeshFacts {
    Fact<bool> bounds_a_solid;
    Fact<std::optional<solids::Closure>> closure;
    Fact<std::vector<int>> samples;
};

struct PlacedBody {
    const Body* body = nullptr;
    MeshFacts* facts = nullptr;
    Matrix3X vertices;  ///< world, rounded: the positions that the verdict is about
    CenteredBox box;    ///< of all of them, with some room
    double slack = 0;   ///< far above the rounding error of a position

    CenteredBox placed(const HierarchyNode& node) const {
        const Matrix3& rotation = body->pose_start.rotation;
        return {rotation * node.center + body->pose_start.position, rotation.cwiseAbs() * node.half_extent + Vector3::Constant(slack)};
    }
    Corners corners(const HierarchyElement& element) const {
        Corners out;
        for (int k = 0; k < 3; ++k) out[k] = vertices.col(element.vertices[std::min(k, element.vertex_count - 1)]);
        return out;
    }
};

PlacedBody place(const Body& body, MeshFacts& facts) {
    PlacedBody out;
    out.body = &body;
    out.facts = &facts;
    out.vertices = (body.pose_start.rotation * body.mesh.vertices).colwise() + body.pose_start.position;
    out.slack = 1e-14 * (body.radius + body.pose_start.position.cwiseAbs().maxCoeff());
    out.box = out.placed(body.hierarchy->nodes().front());
    return out;
}

double gap_squared(const CenteredBox& a, const CenteredBox& b) {
    return ((a.center - b.center).cwiseAbs() - a.half - b.half).cwiseMax(0).squaredNorm();
}

bool elements_intersect(const Corners& a, int a_count, const Corners& b, int b_count) {
    if (a_count == 3 && b_count == 3) return solids::triangles_intersect(a, b);
    if (a_count == 3) return geometry::segment_intersects_triangle(b[0], b[1], a);
    return geometry::segment_intersects_triangle(a[0], a[1], b);
}

bool bounds_a_solid(const PlacedBody& placed) {
    return placed.facts->bounds_a_solid.get([&] { return solids::bounds_a_solid(placed.body->mesh); });
}

/// The closure of an open mesh that may be meant as a solid: what it bounds if it is closed, in the body's frame.
const std::optional<solids::Closure>& closure(const PlacedBody& placed) {
    static const std::optional<solids::Closure> none;
    if (is_sheet(*placed.body)) return none;
    return placed.facts->closure.get([&] { return solids::closure_of(placed.body->mesh); });
}

const std::vector<int>& samples(const PlacedBody& placed) {
    return placed.facts->samples.get([&] { return solids::samples_of(placed.body->mesh); });
}

struct Approach {
    double distance_squared = std::numeric_limits<double>::infinity();
    Vector3 place = Vector3::Zero();  ///< a point of the first element that attains it
};

Approach element_distance(const Corners& a, const Corners& b) {
    Approach best;
    const auto offer = [&](const geometry::ClosestPoints& closest, const Vector3& point) {
        if (closest.distance_squared < best.distance_squared) best = {closest.distance_squared, point};
    };
    for (int i = 0; i < 3; ++i) {
        offer(geometry::point_triangle_closest(a[i], b[0], b[1], b[2]), a[i]);
        offer(geometry::point_triangle_closest(b[i], a[0], a[1], a[2]), b[i]);
        for (int j = 0; j < 3; ++j) {
            const auto closest = geometry::edge_edge_closest(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
            offer(closest, closest.weight[0] * a[i] + closest.weight[1] * a[(i + 1) % 3]);
        }
    }
    return best;
}

/// A point (up to rounding) where an edge of one crosses the other; nothing when they only lie in one plane.
std::optional<Vector3> crossing(const Corners& edges, const Corners& triangle) {
    for (int i = 0; i < 3; ++i) {
        const Vector3 &p = edges[i], &q = edges[(i + 1) % 3];
        if (!geometry::segment_intersects_triangle(p, q, triangle)) continue;
        const Vector3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
        const double along = normal.dot(q - p);
        if (along == 0) continue;
        return p + std::clamp(normal.dot(triangle[0] - p) / along, 0.0, 1.0) * (q - p);
    }
    return std::nullopt;
}

struct Fault {
    bool intersects = false;
    double distance = 0;
    const HierarchyElement *a = nullptr, *b = nullptr;
    Vector3 place = Vector3::Zero();
};

/// Descends two hierarchies at once; stops at the first intersection, otherwise keeps the closest pair within the minimum separation.
class PairSearch {
public:
    PairSearch(const PlacedBody& a, const PlacedBody& b, double dmin) : a_(a), b_(b), dmin_(dmin), reach_squared_(dmin * dmin) {}

    std::optional<Fault> run() {
        std::vector<std::pair<int, int>> open{{0, 0}};
        const auto &a_nodes = a_.body->hierarchy->nodes(), &b_nodes = b_.body->hierarchy->nodes();
        while (!open.empty() && !(fault_ && fault_->intersects)) {
            base::stop_if_asked();
            const auto [i, j] = open.back();
            open.pop_back();
            const HierarchyNode &a = a_nodes[i], &b = b_nodes[j];
            if (gap_squared(a_.placed(a), b_.placed(b)) > reach_squared_) continue;
            if (a.is_leaf() && b.is_leaf()) {
                compare_leaves(a, b);
            } else if (b.is_leaf() || (!a.is_leaf() && a.half_extent.maxCoeff() > b.half_extent.maxCoeff())) {
                open.emplace_back(a.left, j);
                open.emplace_back(a.right, j);
            } else {
                open.emplace_back(i, b.left);
                open.emplace_back(i, b.right);
            }
        }
        return fault_;
    }

private:
    void compare_leaves(const HierarchyNode& a, const HierarchyNode& b) {
        for (int i = a.first; i < a.first + a.count; ++i) {
            for (int j = b.first; j < b.first + b.count; ++j) {
                compare(a_.body->hierarchy->elements()[i], b_.body->hierarchy->elements()[j]);
                if (fault_ && fault_->intersects) return;
            }
        }
    }

    void compare(const HierarchyElement& a, const HierarchyElement& b) {
        const Corners first = a_.corners(a), second = b_.corners(b);
        if (elements_intersect(first, a.vertex_count, second, b.vertex_count)) {
            auto place = crossing(first, second);
            if (!place) place = crossing(second, first);
            fault_ = Fault{true, 0, &a, &b, place.value_or(element_distance(first, second).place)};
            return;
        }
        if (dmin_ == 0) return;
        const Approach found = element_distance(first, second);
        if (found.distance_squared > reach_squared_ || (fault_ && found.distance_squared >= reach_squared_)) return;
        reach_squared_ = found.distance_squared;
        fault_ = Fault{false, std::sqrt(found.distance_squared), &a, &b, found.place};
    }

    const PlacedBody &a_, &b_;
    double dmin_, reach_squared_;
    std::optional<Fault> fault_;
};

/// A point of `inner` in the material of `outer`, if there is one. Contract: their surfaces do not cross; `outer` bounds a solid.
std::optional<Vector3> point_inside(const PlacedBody& inner, const PlacedBody& outer) {
    for (const int v : samples(inner)) {
        const Vector3 point = inner.vertices.col(v);
        if (((point - outer.box.center).cwiseAbs() - outer.box.half).maxCoeff() > 0) continue;
        if (solids::point_in_solid(point, outer.vertices, outer.body->mesh.triangles)) return point;
    }
    return std::nullopt;
}

std::string shown(const HierarchyElement& element) {
    if (element.vertex_count == 3) return "triangle " + std::to_string(element.triangle);
    if (element.vertex_count == 1) return "vertex " + std::to_string(element.vertices[0]);
    return "edge " + std::to_string(element.vertices[0]) + "-" + std::to_string(element.vertices[1]);
}

class Messages {
public:
    explicit Messages(const Model& model) {
        for (const char* name : {"um", "mm", "cm", "in", "ft"}) {
            if (base::metres_per_unit(name).value() == model.length_unit) unit_ = name;
        }
    }

    base::Error error(const Body& a, const Body& b, const std::string& what, const Vector3& place) const {
        std::string near;
        for (int k = 0; k < 3; ++k) near += (k ? ", " : "") + length(place[k]);
        return {base::ErrorCode::bodies_intersect, "bodies `" + a.name + "` and `" + b.name + "`",
                "`" + a.name + "` and `" + b.name + "` " + what + ", near (" + near +
                    ") in the world; move or shape them apart, or, if they are not meant to meet, list \"" + a.name + ":" + b.name +
                    "\" in the scene's `ignore`"};
    }
    std::string volume(double cubic_metres) const {
        const double unit = base::metres_per_unit(unit_).value();
        return base::formatted("%.3g ", cubic_metres / (unit * unit * unit)) + unit_ + "^3";
    }
    std::string length(double metres) const { return base::format_length(metres, unit_); }

private:
    std::string unit_ = "m";
};

std::optional<base::Error> check_pair(const PlacedBody& a, const PlacedBody& b, double dmin, const Messages& messages) {
    if (gap_squared(a.box, b.box) > dmin * dmin) return std::nullopt;
    if (const auto fault = PairSearch(a, b, dmin).run()) {
        const std::string elements = shown(*fault->a) + " of `" + a.body->name + "` and " + shown(*fault->b) + " of `" + b.body->name + "`";
        const std::string what = fault->intersects
                                     ? "intersect or touch at the start: " + elements
                                     : "are " + messages.length(fault->distance) + " apart at the start, the minimum separation is " +
                                           messages.length(dmin) + ": " + elements;
        return messages.error(*a.body, *b.body, what, fault->place);
    }
    for (const auto& [inner, outer] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
        // Whether a mesh is closed is worth finding out only when something lies within its box.
        if (outer->body->mesh.triangles.empty() || !bounds_a_solid(*outer)) continue;
        if (const auto point = point_inside(*inner, *outer)) {
            return messages.error(*inner->body, *outer->body, "overlap at the start: material of the first lies inside the second", *point);
        }
    }
    return std::nullopt;
}

/// Might one lie inside the other, where "inside" is not defined? As certificate/disjoint_solids.hpp decides it of a motion.
std::optional<std::string> containment_doubt(const PlacedBody& a, const PlacedBody& b) {
    if (gap_squared(a.box, b.box) > 0) return std::nullopt;
    for (const bool swapped : {false, true}) {
        const PlacedBody &inner = swapped ? b : a, &outer = swapped ? a : b;
        if (outer.body->mesh.triangles.empty()) continue;
        const auto in_box = [&](int v) { return ((inner.vertices.col(v) - outer.box.center).cwiseAbs() - outer.box.half).maxCoeff() <= 0; };
        const std::vector<int>& tried = samples(inner);
        if (std::none_of(tried.begin(), tried.end(), in_box) || bounds_a_solid(outer) || !closure(outer)) continue;
        const kinematics::Pose& pose = outer.body->pose_start;
        const auto is_within = [&](int v) {
            const Vector3 x = pose.rotation.transpose() * (inner.vertices.col(v) - pose.position);
            return solids::is_within(x, *closure(outer));
        };
        if (std::none_of(tried.begin(), tried.end(), is_within)) continue;
        return "whether `" + inner.body->name + "` lies inside `" + outer.body->name + "` at the start cannot be verified: the mesh of `" +
               outer.body->name + "` is not closed; close it, or say \"mass_per\": \"area\" if it is meant as a sheet";
    }
    return std::nullopt;
}

/// Pairs of bodies whose boxes come as close as the minimum separation, in order: all others are at peace.
std::vector<std::pair<int, int>> close_bodies(const std::vector<PlacedBody>& bodies, double dmin) {
    std::vector<geometry::Box> boxes;
    for (const PlacedBody& placed : bodies) {
        // Half of it on each side, and room for the rounding of these sums.
        const Vector3 half = (placed.box.half.array() + 0.5 * dmin).matrix() * (1 + 1e-12);
        const Vector3 room = 1e-12 * (placed.box.center.cwiseAbs() + half);
        FETTLE_ASSERT(half.allFinite() && room.allFinite(), "body " + placed.body->name + " has no finite place");
        boxes.push_back({placed.box.center - half - room, placed.box.center + half + room});
    }
    std::vector<std::pair<int, int>> pairs;
    geometry::visit_overlapping_pairs(boxes, [&](int i, int j) {
        pairs.emplace_back(i, j);
        return true;
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// The overlap of two bodies that a joint joins, if no joint between them explains it.
std::optional<std::string> unexplained_overlap(const Model& model, int a, int b, const Messages& messages) {
    const base::Result<JoinedOverlap> found = joined_overlap(model, a, b);
    if (!found || found->explained) return std::nullopt;
    const std::string name_a = "`" + model.bodies[a].name + "`", name_b = "`" + model.bodies[b].name + "`";
    return name_a + " and " + name_b + " share " + messages.volume(found->volume) + " of material at the start, which " +
           base::joined(joints_between(model, a, b)) + " between them does not explain (no pin in its bore); contact never acts between " +
           "them; shape them apart, or list \"" + model.bodies[a].name + ":" + model.bodies[b].name + "\" in the scene's `ignore`";
}

/// Adds to the report what there is to say of two bodies.
void report_pair(const Model& model, std::pair<int, int> pair, const std::vector<PlacedBody>& bodies, const Messages& messages,
                 StartReport& report) {
    const auto [i, j] = pair;
    const PlacedBody &a = bodies[i], &b = bodies[j];
    const NoContact why = why_no_contact(model, i, j);
    if (why == NoContact::ignored || why == NoContact::one_group) return;  // they may overlap
    auto error = check_pair(a, b, why == NoContact::none ? model.dmin : 0, messages);
    if (why == NoContact::none) {
        const auto doubt = error ? std::nullopt : containment_doubt(a, b);
        if (doubt) report.warnings.push_back(*doubt);
        if (!error) return;
        report.errors.push_back(std::move(*error));
        report.overlapping.push_back(pair);
    } else if (error && why == NoContact::joined) {
        auto overlap = unexplained_overlap(model, i, j, messages);
        if (!overlap) return;
        report.warnings.push_back(std::move(*overlap));
        report.overlapping.push_back(pair);
    } else if (error) {
        report.warnings.push_back(error->message + " (contact never acts between them: neither is dynamic)");
    }
}

}  // namespace

std::optional<base::Error> check_start_pair(const Model& model, int a, int b) {
    std::array<MeshFacts, 2> facts;
    return check_pair(place(model.bodies[a], facts[0]), place(model.bodies[b], facts[1]), model.dmin, Messages(model));
}

StartReport report_start(const Model& model) {
    std::map<const geometry::BodyHierarchy*, MeshFacts> facts;
    for (const Body& body : model.bodies) facts[body.hierarchy.get()];
    const int count = count_of(model.bodies);
    std::vector<PlacedBody> bodies(model.bodies.size());
    base::parallel_for(count, 1, [&](int i) {
        const Body& body = model.bodies[i];
        bodies[i] = place(body, facts.at(body.hierarchy.get()));
    });
    const Messages messages(model);
    const std::vector<std::pair<int, int>> pairs = close_bodies(bodies, model.dmin);
    std::vector<StartReport> of_pairs(pairs.size());
    base::parallel_for(count_of(pairs), 1, [&](int k) { report_pair(model, pairs[k], bodies, messages, of_pairs[k]); });
    StartReport report;
    for (StartReport& of_pair : of_pairs) {
        std::move(of_pair.errors.begin(), of_pair.errors.end(), std::back_inserter(report.errors));
        std::move(of_pair.warnings.begin(), of_pair.warnings.end(), std::back_inserter(report.warnings));
        std::move(of_pair.overlapping.begin(), of_pair.overlapping.end(), std::back_inserter(report.overlapping));
    }
    constexpr std::size_t most = 20;
    if (const std::size_t all = report.warnings.size(); all > most) {
        report.warnings.resize(most);
        report.warnings.push_back("and " + std::to_string(all - most) + " more pairs of bodies as these");
    }
    return report;
}

base::Errors check_start(const Model& model) { return report_start(model).errors; }

}  // namespace fettle::core::model
