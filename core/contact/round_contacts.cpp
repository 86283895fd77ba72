// SPDX-License-Identifier: MIT
#include "core/contact/round_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/contact/closest_feature.hpp"
#include "core/geometry/round_surfaces.hpp"

namespace fettle::core::contact {
namespace {

using geometry::CornerKind;
using geometry::RoundedSide;
using geometry::RoundSurfaces;

constexpr double same_place = 1e-9;  // of directions, and of lengths over the surfaces' size

// One side of a body in space.
struct Placed {
    const model::Body& body;
    const kinematics::Pose& pose;
    const RoundedSide& side;
    const RoundSurfaces::Side& surface;
    Vector3 axis, across_1, across_2;
    int low;  // the rim that is lower along the other's axis
    std::vector<Vector3> centres;

    Placed(const model::Body& b, const kinematics::Pose& p, int s)
        : body(b),
          pose(p),
          side(b.round->mesh_sides.sides[s]),
          surface(b.round->sides[s]),
          axis(p.rotation * side.axis),
          across_1(p.rotation * surface.across_1),
          across_2(p.rotation * surface.across_2),
          low(0) {}

    // Corners that are asked for, and the first.
    void place(const std::vector<int>& corners) {
        centres.resize(2 * side.corners.size());
        place(0);
        for (const int k : corners) place(k);
    }
    void place(int corner) {
        for (const int e : {0, 1})
            centres[2 * static_cast<std::size_t>(corner) + e] = world_position(pose, body.round->centres.col(centre_index(corner, e)));
    }

    int corners() const { return count_of(side.corners); }
    int next(int corner) const { return (corner + 1) % corners(); }
    int before(int corner) const { return (corner + corners() - 1) % corners(); }
    CornerKind kind(int corner) const { return side.corners[corner].kind; }
    int end(int e) const { return low == 0 ? e : 1 - e; }  // e = 0: the lower
    int centre_index(int corner, int e) const { return surface.first_centre + 2 * corner + end(e); }
    double radius(int corner, int e) const { return body.round->radii[centre_index(corner, e)]; }
    const Vector3& centre(int corner, int e) const { return centres[2 * static_cast<std::size_t>(corner) + e]; }
    int rim(int corner, int e) const { return side.corners[corner].rim[end(e)]; }
    Vector3 rim_point(int corner, int e) const { return world_position(pose, body.mesh.vertices.col(rim(corner, e))); }
    Vector2 across(const Vector3& v) const { return {v.dot(across_1), v.dot(across_2)}; }
    Vector3 outward(int rectangle) const {
        const Vector2& n = surface.normals[rectangle];
        return n[0] * across_1 + n[1] * across_2;
    }
    bool has_before(int corner) const { return side.closed || corner > 0; }
    bool has_after(int corner) const { return side.closed || corner + 1 < corners(); }
    // As ContactPair::vertex has it.
    int vertex(int corner, int e) const { return is_round(corner) ? round_vertex(centre_index(corner, e)) : rim(corner, e); }
    bool is_round(int corner) const { return kind(corner) == CornerKind::convex_round || kind(corner) == CornerKind::concave_round; }
    bool is_convex(int corner) const { return kind(corner) == CornerKind::convex_round || kind(corner) == CornerKind::convex_edge; }
    bool is_hollow(int corner) const { return kind(corner) == CornerKind::concave_round; }
    // An edge at the foot of a wall. Above a wall lower than the activation distance there is something to meet it.
    bool is_foot(int corner) const { return kind(corner) == CornerKind::concave_edge && has_before(corner) && has_after(corner); }
    bool is_outer(int corner) const { return is_convex(corner) || is_foot(corner); }
};

double cross(const Vector2& a, const Vector2& b) { return a[0] * b[1] - a[1] * b[0]; }

// Where something lies among what a piece of the surface answers for.
enum class Within { no, at_border, yes };

Within within(double margin, double size) {
    return margin > same_place * size ? Within::yes : margin < -same_place * size ? Within::no : Within::at_border;
}

// Is this direction one of those that a corner's arc, or edge, faces? Those between the normals of the rectangles beside it, which turn to
// the left round a convex corner; at a side's end up to a right angle from the only one. The edge at the foot of a wall faces what has left
// one of its rectangles, and is not over the other one's beginning: beyond the wall's top.
// @param direction  unit, outward from the material
Within faces(const Placed& p, int corner, const Vector3& direction) {
    const Vector2 w = p.across(direction);
    if (p.is_foot(corner)) {
        const Vector2 &before = p.surface.normals[p.before(corner)], &after = p.surface.normals[corner];
        return within(std::max(std::min(cross(before, w), before.dot(w)), std::min(cross(w, after), after.dot(w))), 1);
    }
    const double turn = p.is_convex(corner) ? 1 : -1;
    double margin = 1;
    if (p.has_before(corner)) margin = std::min(margin, turn * cross(p.surface.normals[p.before(corner)], w));
    if (p.has_after(corner)) margin = std::min(margin, turn * cross(w, p.surface.normals[corner]));
    if (!p.has_before(corner)) margin = std::min(margin, p.surface.normals[corner].dot(w));
    if (!p.has_after(corner)) margin = std::min(margin, p.surface.normals[corner - 1].dot(w));
    return within(margin, 1);
}

// Does a corner face a plane as the end of a flat beside it, which the direction is nearly normal to? The flat's other end is nearer then;
// but a flat lies on both. This goes on until the corner is beyond the activation distance, so that no force ends suddenly: where the flat
// is turned from the plane by delta, the corner's circle is L sin(delta) - r (1 - cos(delta)) farther from it, at most sqrt(L^2 + r^2) - r.
// On shorter flats, and the facets of curves, the nearer end alone counts.
bool faces_as_end(const Placed& p, int corner, const Vector3& direction, double activation) {
    const Vector2 w = p.across(direction);
    const double radius = p.radius(corner, 0);
    const auto is_end_of = [&](int rectangle, int other, double turn) {
        const Vector2& n = p.surface.normals[rectangle];
        const double flat = p.surface.lengths[rectangle] - p.surface.tangents[corner] - p.surface.tangents[other];
        return flat * flat > activation * (activation + 2 * radius) && turn * cross(n, w) > 0 &&
               radius * turn * cross(n, w) < flat * n.dot(w);
    };
    return (p.has_after(corner) && is_end_of(corner, p.next(corner), 1)) ||
           (p.has_before(corner) && is_end_of(p.before(corner), p.before(corner), -1));
}

// Is a place on a rectangle, t from its first corner along it, on what its corners' arcs leave plane?
Within on_plane(const Placed& p, int rectangle, double t) {
    const double length = p.surface.lengths[rectangle];
    return within(std::min(t - p.surface.tangents[rectangle], length - p.surface.tangents[p.next(rectangle)] - t), length);
}

class RoundSearch {
public:
    RoundSearch(const NearAt& at, std::vector<ContactPair>& forward, std::vector<ContactPair>& backward)
        : a_(at.model.bodies[at.list.a]),
          b_(at.model.bodies[at.list.b]),
          pose_a_(at.poses[at.list.a]),
          pose_b_(at.poses[at.list.b]),
          activation_(at.model.dmin + at.model.dhat),
          deepest_(at.model.round_reach),
          forward_(forward),
          backward_(backward) {
        for (const ccd::SidePieces& pieces : at.list.sides)
            if (are_met(pieces)) met_.push_back(&pieces);
    }

    double find() {
        for (const ccd::SidePieces* pieces : met_) meet(*pieces);
        return least_;
    }

    std::vector<SidesGap> gaps() {
        std::vector<SidesGap> out;
        for (const ccd::SidePieces* pieces : met_) {
            least_ = std::numeric_limits<double>::infinity();
            meet(*pieces);
            out.push_back({pieces->side_a, pieces->side_b, least_, cover_});
        }
        return out;
    }

    void take_over(NearPairs& near) const {
        if (met_.empty()) return;
        std::erase_if(near.on_second, [&](const ContactPair& p) {
            return is_of_sides({p.vertex[0], -1, -1}, closest_feature(p), p, true);
        });
        std::erase_if(near.on_first, [&](const ContactPair& p) {
            return is_of_sides(closest_feature(p), {p.vertex[0], -1, -1}, p, false);
        });
        std::erase_if(near.edges, [&](const ContactPair& p) {
            return is_of_sides({p.vertex[0], p.vertex[1], -1}, {p.vertex[2], p.vertex[3], -1}, p, true);
        });
    }

private:
    // Along one direction, and both there somewhere along it.
    bool are_met(const ccd::SidePieces& pieces) const {
        const RoundedSide &side_a = a_.round->mesh_sides.sides[pieces.side_a], &side_b = b_.round->mesh_sides.sides[pieces.side_b];
        const Vector3 axis = pose_a_.rotation * side_a.axis;
        if (!(axis.cross(pose_b_.rotation * side_b.axis).norm() < largest_slant)) return false;
        const auto ends = [&](const model::Body& body, const kinematics::Pose& pose, const RoundedSide& side) {
            const double x = axis.dot(world_position(pose, body.mesh.vertices.col(side.corners[0].rim[0])));
            const double y = axis.dot(world_position(pose, body.mesh.vertices.col(side.corners[0].rim[1])));
            return std::pair(std::min(x, y), std::max(x, y));
        };
        const auto [low_a, high_a] = ends(a_, pose_a_, side_a);
        const auto [low_b, high_b] = ends(b_, pose_b_, side_b);
        return low_a < high_b && low_b < high_a;
    }

    static bool is_on(const model::Body& body, int side, const Feature& feature) {
        const auto& of_vertex = body.round->mesh_sides.of_vertex;
        return std::all_of(feature.begin(), feature.end(), [&](int v) {
            return v < 0 || std::any_of(of_vertex[v].begin(), of_vertex[v].end(), [&](const auto& place) { return place.side == side; });
        });
    }

    // Is the point, so far from the body, beside a side of it, not beyond its ends? Across another direction it may be beyond a little.
    static bool is_beside(const model::Body& body, const kinematics::Pose& pose, int side, const Vector3& point, double distance) {
        const RoundedSide& of = body.round->mesh_sides.sides[side];
        const double along = of.axis.dot(pose.rotation.transpose() * (point - pose.position));
        const double slack = same_place * body.radius + largest_slant * distance;
        return along >= of.ends[0] - slack && along <= of.ends[1] + slack;
    }

    // Do these vertices belong to sides that meet, and is one closest point beside the other's side?
    bool is_of_sides(const Feature& of_a, const Feature& of_b, const ContactPair& p, bool is_a_first) const {
        std::array<Vector3, 2> at{Vector3::Zero(), Vector3::Zero()};  // of the first body and the second
        for (int i = 0; i < 4; ++i) {
            const bool on_first = i < geometry::first_count(p.type);
            at[on_first ? 0 : 1] += (on_first ? 1 : -1) * p.closest.weight[i] * p.x[i];
        }
        const Vector3 &at_a = at[is_a_first ? 0 : 1], &at_b = at[is_a_first ? 1 : 0];
        const double d = std::sqrt(p.closest.distance_squared);
        return std::any_of(met_.begin(), met_.end(), [&](const ccd::SidePieces* pieces) {
            return is_on(a_, pieces->side_a, of_a) && is_on(b_, pieces->side_b, of_b) &&
                   (is_beside(b_, pose_b_, pieces->side_b, at_a, d) || is_beside(a_, pose_a_, pieces->side_a, at_b, d));
        });
    }

    void meet(const ccd::SidePieces& pieces) {
        Placed a(a_, pose_a_, pieces.side_a), b(b_, pose_b_, pieces.side_b);
        b.low = a.axis.dot(b.axis) >= 0 ? 0 : 1;
        a.place(pieces.corners_a);
        b.place(pieces.corners_b);
        cover_ = a.surface.cover + b.surface.cover;
        along_ = a.axis + (b.low == 0 ? 1 : -1) * b.axis;
        for (int e = 0; e < 2; ++e) {
            if (a.surface.is_circle && b.surface.is_circle) {
                circles(a, pieces.corners_a, b, pieces.corners_b, e);
                keep();
                continue;
            }
            for (const int i : pieces.corners_a) {
                for (const int j : pieces.corners_b) arcs(a, i, b, j, e);
                for (const int k : pieces.rectangles_b) arc_and_plane(a, i, b, k, e);
            }
            for (const int j : pieces.corners_b)
                for (const int k : pieces.rectangles_a) arc_and_plane(b, j, a, k, e);
            keep();
        }
    }

    // Which of the two ends of lines is within the other: the point that the contact is at? Half-way between the two directions, so that
    // the distance is the same either way where the answer changes.
    bool ends_within(const Vector3& end, const Vector3& other_end, int e) const {
        const double beyond = along_.dot(end - other_end);
        return e == 0 ? beyond >= 0 : beyond <= 0;
    }

    // The same of the end of an arc's centre line and a plane's border, both seen along the border, where neither distance changes.
    bool ends_within_border(const Placed& arc, int corner, const Placed& plane, int rectangle, const Vector3& from_plane, int e) const {
        const Vector3 border = (plane.rim_point(plane.next(rectangle), e) - plane.rim_point(rectangle, e)).normalized();
        const auto seen = [&](const Vector3& v) { return Vector3(v - v.dot(border) * border); };
        const Vector3 along = seen(arc.centre(corner, 1) - arc.centre(corner, 0)).normalized() +
                              seen(plane.rim_point(rectangle, 1) - plane.rim_point(rectangle, 0)).normalized();
        const double beyond = along.dot(seen(from_plane));
        return e == 0 ? beyond >= 0 : beyond <= 0;
    }

    // Two corners' centre lines where a contact at this end would be: the end of one that lies within the other, and that one's line.
    struct Lines {
        bool at_b;       // the end is b's
        Vector3 r;       // from the line to the end
        double d, t;     // |r|; where on the line
        Vector3 from_b;  // unit, from b's line to a's
    };
    Lines lines(const Placed& a, int i, const Placed& b, int j, int e) const {
        Lines out;
        out.at_b = ends_within(b.centre(j, e), a.centre(i, e), e);
        const Placed &point = out.at_b ? b : a, &line = out.at_b ? a : b;
        const int point_corner = out.at_b ? j : i, line_corner = out.at_b ? i : j;
        const Vector3& from = line.centre(line_corner, 0);
        const Vector3 along = line.centre(line_corner, 1) - from, to_point = point.centre(point_corner, e) - from;
        out.t = along.dot(to_point) / along.squaredNorm();
        out.r = to_point - out.t * along;
        out.d = out.r.norm();
        const bool is_one = out.d <= same_place * (a.radius(i, e) + b.radius(j, e));  // its direction is rounding
        out.from_b = is_one ? a.across_1 : Vector3((out.at_b ? -1 : 1) / out.d * out.r);
        return out;
    }

    // Outward from the two materials: apart outside, both the same way inside.
    static std::array<Vector3, 2> outward(bool hollow_a, bool hollow_b, const Vector3& from_b) {
        const double inside = hollow_a || hollow_b ? 1 : -1;
        return {hollow_a ? from_b : Vector3(inside * from_b), hollow_b ? Vector3(-from_b) : Vector3(-inside * from_b)};
    }

    // The arcs of a circle are all about one line: one direction says which two meet. Each for itself would see another one by rounding,
    // which near concentric circles is any.
    void circles(const Placed& a, const std::vector<int>& corners_a, const Placed& b, const std::vector<int>& corners_b, int e) {
        const auto [out_a, out_b] = outward(a.is_hollow(0), b.is_hollow(0), lines(a, 0, b, 0, e).from_b);
        const auto first_that_faces = [](const Placed& p, const std::vector<int>& corners, const Vector3& out) {
            return std::find_if(corners.begin(), corners.end(), [&](int k) { return faces(p, k, out) != Within::no; });
        };
        const auto i = first_that_faces(a, corners_a, out_a), j = first_that_faces(b, corners_b, out_b);
        if (i != corners_a.end() && j != corners_b.end()) arcs(a, *i, b, *j, e, Within::yes);
    }

    // @param known  whether the two face each other, where that is known already
    void arcs(const Placed& a, int i, const Placed& b, int j, int e, std::optional<Within> known = {}) {
        const bool hollow_a = a.is_hollow(i), hollow_b = b.is_hollow(j), inside = hollow_a || hollow_b;
        if (!(a.is_convex(i) && (b.is_outer(j) || hollow_b)) && !(b.is_convex(j) && (a.is_outer(i) || hollow_a))) return;
        const int sign_a = hollow_a || !inside ? 1 : -1, sign_b = hollow_b || !inside ? 1 : -1;
        const int side = inside ? -1 : 1;
        const double radius = sign_a * a.radius(i, e) + sign_b * b.radius(j, e) + side * cover_;
        if (inside && !(radius > 0)) return;
        const Lines at = lines(a, i, b, j, e);
        const double distance = side * (at.d - radius);
        if (!is_near(distance)) return;
        const auto [out_a, out_b] = outward(hollow_a, hollow_b, at.from_b);
        const Within facing = known ? *known : std::min(faces(a, i, out_a), faces(b, j, out_b));
        if (facing == Within::no) return;
        ContactPair pair;
        pair.round.side = static_cast<signed char>(side);
        pair.round.has_far = inside && a.surface.is_circle && b.surface.is_circle;
        pair.type = geometry::PairType::point_triangle;
        const Placed &point = at.at_b ? b : a, &line = at.at_b ? a : b;
        const int point_corner = at.at_b ? j : i, line_corner = at.at_b ? i : j;
        const int upper = line.vertex(line_corner, 1);
        pair.x = {point.centre(point_corner, e), line.centre(line_corner, 0), line.centre(line_corner, 1), line.centre(line_corner, 1)};
        pair.vertex = {point.vertex(point_corner, e), line.vertex(line_corner, 0), upper, upper};
        pair.closest.weight = {1, at.t - 1, -at.t, 0};
        pair.closest.free_count = 1;
        pair.closest.free_weight[0] = {0, 1, -1, 0};
        pair.closest.difference = at.r;
        pair.closest.distance_squared = at.d * at.d;
        set_part(pair.round, 0, point, point_corner, e, at.at_b ? sign_b : sign_a);
        set_part(pair.round, 1, line, line_corner, e, at.at_b ? sign_a : sign_b);
        add(point, std::move(pair), distance, facing);
    }

    // A convex arc, or an edge, and what the arcs beside it leave plane of a rectangle.
    void arc_and_plane(const Placed& arc, int corner, const Placed& plane, int rectangle, int e) {
        if (!arc.is_outer(corner)) return;
        const double length = plane.surface.lengths[rectangle];
        const double flat = length - plane.surface.tangents[rectangle] - plane.surface.tangents[plane.next(rectangle)];
        if (flat < same_place * length) return;  // the arcs meet
        const Vector3 outward = plane.outward(rectangle), from_plane = arc.centre(corner, e) - plane.rim_point(rectangle, e);
        const double height = outward.dot(from_plane);
        if (height <= 0 || !is_near(height - arc.radius(corner, e) - cover_)) return;
        Within facing = faces(arc, corner, -outward);
        if (facing == Within::no && faces_as_end(arc, corner, -outward, activation_)) facing = Within::yes;
        if (facing == Within::no) return;
        if (ends_within_border(arc, corner, plane, rectangle, from_plane, e))
            end_on_plane(arc, corner, plane, rectangle, e, facing);
        else
            border_on_line(arc, corner, plane, rectangle, e, facing);
    }

    // The end of the arc's centre line against the plane p0 + s e1 + t e2.
    void end_on_plane(const Placed& arc, int corner, const Placed& plane, int rectangle, int e, Within facing) {
        const int next = plane.next(rectangle);
        ContactPair pair;
        pair.type = geometry::PairType::point_triangle;
        pair.x = {arc.centre(corner, e), plane.rim_point(rectangle, e), plane.rim_point(next, e), plane.rim_point(next, 1 - e)};
        pair.vertex = {arc.vertex(corner, e), plane.rim(rectangle, e), plane.rim(next, e), plane.rim(next, 1 - e)};
        const Vector3 e1 = pair.x[2] - pair.x[1], e2 = pair.x[3] - pair.x[2], from = pair.x[0] - pair.x[1];
        Matrix2 k;
        k << e1.dot(e1), e1.dot(e2), e1.dot(e2), e2.dot(e2);
        const Vector2 st = k.inverse() * Vector2(e1.dot(from), e2.dot(from));
        pair.closest.weight = {1, st[0] - 1, st[1] - st[0], -st[1]};
        pair.closest.free_count = 2;
        pair.closest.free_weight = {{{0, 1, -1, 0}, {0, 0, 1, -1}}};
        pair.closest.difference = from - st[0] * e1 - st[1] * e2;
        add_arc_on_plane(std::move(pair), arc, corner, plane, e,
                         std::min(facing, on_plane(plane, rectangle, st[0] * plane.surface.lengths[rectangle])));
    }

    // The plane's border p0 + s e1 against the arc's centre line c0 + t e2.
    void border_on_line(const Placed& arc, int corner, const Placed& plane, int rectangle, int e, Within facing) {
        const int next = plane.next(rectangle);
        const Vector3 p0 = plane.rim_point(rectangle, e), p1 = plane.rim_point(next, e);
        const Vector3 &c0 = arc.centre(corner, 0), &c1 = arc.centre(corner, 1), e1 = p1 - p0, e2 = c1 - c0;
        Matrix2 k;
        k << e1.dot(e1), -e1.dot(e2), -e1.dot(e2), e2.dot(e2);
        const Vector2 st = k.inverse() * Vector2(-e1.dot(p0 - c0), e2.dot(p0 - c0));
        const Vector3 r = p0 + st[0] * e1 - c0 - st[1] * e2;
        const bool is_plane_first = &plane.body == &a_;  // the first edge is on body a
        const std::array<double, 2> first{1 - st[is_plane_first ? 0 : 1], st[is_plane_first ? 0 : 1]},
            second{st[is_plane_first ? 1 : 0] - 1, -st[is_plane_first ? 1 : 0]};
        ContactPair pair;
        pair.type = geometry::PairType::edge_edge;
        pair.closest.weight = {first[0], first[1], second[0], second[1]};
        pair.closest.free_count = 2;
        pair.closest.free_weight = {{{-1, 1, 0, 0}, {0, 0, 1, -1}}};
        const int v0 = plane.rim(rectangle, e), v1 = plane.rim(next, e), w0 = arc.vertex(corner, 0), w1 = arc.vertex(corner, 1);
        if (is_plane_first) {
            pair.x = {p0, p1, c0, c1};
            pair.vertex = {v0, v1, w0, w1};
            pair.closest.difference = r;
        } else {
            pair.x = {c0, c1, p0, p1};
            pair.vertex = {w0, w1, v0, v1};
            pair.closest.difference = -r;
        }
        add_arc_on_plane(std::move(pair), arc, corner, plane, e,
                         std::min(facing, on_plane(plane, rectangle, st[0] * plane.surface.lengths[rectangle])));
    }

    // Its distance, reach and bodies, if it is one.
    void add_arc_on_plane(ContactPair&& pair, const Placed& arc, int corner, const Placed& plane, int e, Within facing) {
        if (facing == Within::no) return;
        const bool is_plane_first = pair.type == geometry::PairType::edge_edge && &plane.body == &a_;
        pair.round.side = 1;
        set_part(pair.round, is_plane_first ? 1 : 0, arc, corner, e, 1);
        set_part(pair.round, is_plane_first ? 0 : 1, plane, -1, e, 0);
        pair.closest.distance_squared = pair.closest.difference.squaredNorm();
        const double distance = gap_of(pair);
        if (is_near(distance)) add(pair.type == geometry::PairType::edge_edge ? on_a(arc, plane) : arc, std::move(pair), distance, facing);
    }
    const Placed& on_a(const Placed& p, const Placed& q) const { return &p.body == &a_ ? p : q; }

    // @param k  0 for the pair's first body, 1 for its second  @param corner  -1: a plane  @param sign  of its radius in R
    static void set_part(RoundGap& gap, std::size_t k, const Placed& of, int corner, int e, int sign) {
        gap.cover[k] = of.surface.cover_corner < 0 ? -1 : of.surface.first_centre + 2 * of.surface.cover_corner;
        const bool is_round = corner >= 0 && of.is_round(corner);
        gap.centre[k] = is_round ? of.centre_index(corner, e) : -1;
        gap.sign[k] = static_cast<signed char>(is_round ? sign : 0);
        gap.reach[k] = gap.sign[k] * (is_round ? of.radius(corner, e) : 0) + gap.side * of.surface.cover;
    }

    bool is_near(double distance) const { return distance < activation_ && distance > -deepest_; }

    struct Found {
        ContactPair pair;
        bool on_a;  // the first primitive
        bool at_border;
        Vector3 place;  // between the surfaces
    };

    void add(const Placed& first, ContactPair&& pair, double distance, Within facing) {
        least_ = least_of(least_, distance);
        const double d = std::sqrt(pair.closest.distance_squared);
        const Vector3 n = d > 0 ? Vector3(pair.closest.difference / d) : Vector3::Zero();
        Vector3 place = Vector3::Zero();
        for (int i = 0; i < geometry::first_count(pair.type); ++i) place += pair.closest.weight[i] * pair.x[i];
        place -= (pair.round.reach[0] + 0.5 * distance) * n;
        found_.push_back({std::move(pair), &first.body == &a_, facing == Within::at_border, place});
    }

    // Where pieces of a surface meet, the contact is with either: with one that is not at its border, or the first.
    void keep() {
        for (std::size_t k = 0; k < found_.size(); ++k) {
            bool is_known = false;
            for (std::size_t other = 0; found_[k].at_border && other < found_.size() && !is_known; ++other)
                is_known =
                    (!found_[other].at_border || other < k) && (found_[other].place - found_[k].place).norm() < 10 * same_place * a_.radius;
            if (!is_known) (found_[k].on_a ? forward_ : backward_).push_back(found_[k].pair);
        }
        found_.clear();
    }

    const model::Body &a_, &b_;
    const kinematics::Pose &pose_a_, &pose_b_;
    double activation_, deepest_, cover_ = 0;
    Vector3 along_ = Vector3::Zero();  // from the lower ends to the upper
    std::vector<ContactPair>&forward_, &backward_;
    std::vector<const ccd::SidePieces*> met_;
    std::vector<Found> found_;
    double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

double find_round_contacts(const NearAt& at, NearPairs& near, std::vector<ContactPair>& forward, std::vector<ContactPair>& backward) {
    if (at.list.sides.empty()) return std::numeric_limits<double>::infinity();
    RoundSearch search(at, forward, backward);
    const double least = search.find();
    search.take_over(near);
    return least;
}

std::vector<SidesGap> gaps_of_sides(const NearAt& at) {
    std::vector<ContactPair> forward, backward;
    return RoundSearch(at, forward, backward).gaps();
}

}  // namespace fettle::core::contact
