// SPDX-License-Identifier: MIT
#include "core/features/joint_proposals.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"

namespace fettle::core::features {

namespace {

constexpr double parallel = 0.0349;  // two degrees [rad]: what a play allows a short pin
constexpr int unreached = -1;

// Fits of parts that sit on one line.
struct Line {
    Vector3 point, axis;
    std::vector<int> fits, bodies;  // bodies: ascending
};

// What two parts have in common: lines, and centres of balls.
struct Shared {
    std::vector<int> lines, balls;  // indices of lines and of fits
};

double size_of(const geometry::Mesh& mesh) { return geometry::box_sides(mesh.vertices).norm(); }

double box_volume(const geometry::Mesh& mesh) { return mesh.vertices.cols() == 0 ? 0 : geometry::box_sides(mesh.vertices).prod(); }

double from_line(const Vector3& x, const Vector3& point, const Vector3& axis) { return axis.cross(x - point).norm(); }

// What hangs together.
class Groups {
public:
    explicit Groups(std::size_t count) : group_(count) { std::iota(group_.begin(), group_.end(), 0); }
    void join(int x, int y) {
        const int from = group_[x], to = group_[y];
        std::replace(group_.begin(), group_.end(), from, to);
    }
    int of(int x) const { return group_[x]; }
    bool are_one(int x, int y) const { return group_[x] == group_[y]; }

private:
    std::vector<int> group_;
};

class Proposals {
public:
    Proposals(const std::vector<geometry::Mesh>& placed, const std::vector<Features>& parts, const std::vector<Fit>& fits)
        : placed_(placed), parts_(parts), fits_(fits), depth_(parts.size(), unreached) {
        find_lines();
        find_guides();
    }

    std::vector<ProposedJoint> run(int ground) {
        reach_from(ground);
        for (int next = next_ground(); next >= 0; next = next_ground()) reach_from(next);
        std::map<std::pair<int, int>, Shared> shared;
        for (int l = 0; l < count_of(lines_); ++l) {
            const int root = root_of(lines_[l].bodies);
            for (const int body : lines_[l].bodies)
                if (body != root) shared[{root, body}].lines.push_back(l);
        }
        for (int k = 0; k < count_of(fits_); ++k) {
            if (!is_ball(fits_[k])) continue;
            const int root = root_of({fits_[k].pin.body, fits_[k].hole.body});
            shared[{root, fits_[k].pin.body + fits_[k].hole.body - root}].balls.push_back(k);
        }
        std::vector<ProposedJoint> joints;
        for (const auto& [pair, what] : shared) joints.push_back(joint_of(pair.first, pair.second, what));
        for (const auto& [x, y] : guides_) {
            const int root = root_of({x, y});
            if (std::optional<ProposedJoint> joint = guided(root, x + y - root)) joints.push_back(std::move(*joint));
        }
        drop_within_rigid(joints);
        std::sort(joints.begin(), joints.end(), [&](const ProposedJoint& x, const ProposedJoint& y) {
            return std::tuple(depth_[x.b], x.b, x.a) < std::tuple(depth_[y.b], y.b, y.a);
        });
        return joints;
    }

private:
    // A rod through two brackets that are screwed to one plate joins them no more.
    void drop_within_rigid(std::vector<ProposedJoint>& joints) const {
        Groups rigid(parts_.size());
        for (const ProposedJoint& joint : joints)
            if (joint.kind == JointKind::fixed) rigid.join(joint.a, joint.b);
        std::erase_if(joints,
                      [&](const ProposedJoint& joint) { return joint.kind != JointKind::fixed && rigid.are_one(joint.a, joint.b); });
    }

    const Feature& feature(const FeatureOf& of) const { return parts_[of.body].features[of.feature]; }
    bool is_ball(const Fit& fit) const { return feature(fit.pin).surface.kind == SurfaceKind::sphere; }

    void find_lines() {
        Groups one_line(fits_.size());
        for (int i = 0; i < count_of(fits_); ++i)
            for (int j = 0; j < i; ++j)
                if (fits_[i].is_held && fits_[j].is_held && share_a_body(fits_[i], fits_[j]) && are_on_one_line(fits_[i], fits_[j]))
                    one_line.join(i, j);
        std::map<int, int> line_of;
        for (int k = 0; k < count_of(fits_); ++k) {
            if (is_ball(fits_[k]) || !fits_[k].is_held) continue;
            const auto [at, is_new] = line_of.emplace(one_line.of(k), count_of(lines_));
            if (is_new) lines_.emplace_back();
            lines_[at->second].fits.push_back(k);
        }
        for (Line& line : lines_) settle(line);
    }

    static bool share_a_body(const Fit& x, const Fit& y) {
        return x.pin.body == y.pin.body || x.pin.body == y.hole.body || x.hole.body == y.pin.body || x.hole.body == y.hole.body;
    }

    bool are_on_one_line(const Fit& x, const Fit& y) const {
        if (is_ball(x) || is_ball(y)) return false;
        const Surface &a = feature(x.pin).surface, &b = feature(y.pin).surface;
        if (a.axis.cross(b.axis).norm() > parallel) return false;
        const double near = std::max(x.play, 0.0) + std::max(y.play, 0.0) + known(x) + known(y);
        return from_line(feature(y.hole).surface.point, a.point, a.axis) <= near &&
               from_line(feature(x.hole).surface.point, b.point, b.axis) <= near;
    }

    // How well the numbers of a fit are known.
    double known(const Fit& fit) const {
        return std::max(parts_[fit.pin.body].tolerance, parts_[fit.hole.body].tolerance) +
               2 * (feature(fit.pin).residual + feature(fit.hole).residual);
    }

    // Along the longest fit's pin; through the middle of the holes.
    void settle(Line& line) const {
        const auto longer = [&](int i, int j) { return fits_[i].overlap < fits_[j].overlap; };
        const Surface& pin = feature(fits_[*std::max_element(line.fits.begin(), line.fits.end(), longer)].pin).surface;
        line.axis = pin.axis;
        double along = 0;
        for (const int k : line.fits) {
            along += pin.axis.dot(feature(fits_[k].hole).surface.point - pin.point) / static_cast<double>(line.fits.size());
            for (const int body : {fits_[k].pin.body, fits_[k].hole.body}) line.bodies.push_back(body);
        }
        line.point = pin.point + along * pin.axis;
        std::sort(line.bodies.begin(), line.bodies.end());
        line.bodies.erase(std::unique(line.bodies.begin(), line.bodies.end()), line.bodies.end());
    }

    // Breadth first, over all that shares a line or a ball.
    void reach_from(int ground) {
        std::vector<int> front{ground};
        depth_[ground] = 0;
        for (int depth = 1; !front.empty(); ++depth) {
            std::vector<int> next;
            const auto reach = [&](int body) {
                if (depth_[body] != unreached) return;
                depth_[body] = depth;
                next.push_back(body);
            };
            for (const int body : front) {
                for (const Line& line : lines_)
                    if (std::binary_search(line.bodies.begin(), line.bodies.end(), body))
                        std::for_each(line.bodies.begin(), line.bodies.end(), reach);
                for (const Fit& fit : fits_)
                    if (is_ball(fit) && (fit.pin.body == body || fit.hole.body == body)) reach(fit.pin.body + fit.hole.body - body);
                for (const auto& [x, y] : guides_)
                    if (x == body || y == body) reach(x + y - body);
            }
            front = std::move(next);
        }
    }

    // The largest of the parts that are not reached yet: another ground.
    int next_ground() const {
        int best = -1;
        for (int body = 0; body < count_of(depth_); ++body)
            if (depth_[body] == unreached && (best < 0 || box_volume(placed_[body]) > box_volume(placed_[best]))) best = body;
        return best;
    }

    int root_of(const std::vector<int>& bodies) const {
        return *std::min_element(bodies.begin(), bodies.end(),
                                 [&](int x, int y) { return std::pair(depth_[x], x) < std::pair(depth_[y], y); });
    }

    const std::vector<Facing>& facing(int a, int b, double most) {
        auto known = facing_.find({a, b});
        if (known == facing_.end() || known->second.first < most)
            known =
                facing_.insert_or_assign({a, b}, std::pair(most, facing_planes(placed_[a], parts_[a], placed_[b], parts_[b], most))).first;
        return known->second.second;
    }

    ProposedJoint joint_of(int a, int b, const Shared& shared) {
        ProposedJoint joint;
        joint.a = a;
        joint.b = b;
        for (const int l : shared.lines)
            for (const int k : lines_[l].fits) joint.fits.push_back(k);
        joint.fits.insert(joint.fits.end(), shared.balls.begin(), shared.balls.end());
        if (shared.lines.empty()) {
            on_balls(shared.balls, joint);
        } else {
            on_lines(shared, joint);
        }
        return joint;
    }

    void on_balls(const std::vector<int>& balls, ProposedJoint& joint) const {
        const auto centre = [&](std::size_t k) { return feature(fits_[balls[k]].hole).surface.point; };
        joint.point = centre(0);
        joint.kind = balls.size() == 1 ? JointKind::ball : balls.size() == 2 ? JointKind::revolute : JointKind::fixed;
        if (balls.size() == 2) joint.axis = (centre(1) - centre(0)).normalized();
    }

    void on_lines(const Shared& shared, ProposedJoint& joint) {
        const Line& first = lines_[shared.lines.front()];
        joint.point = first.point;
        joint.axis = first.axis;
        bool is_along = true, is_about = true;  // does a slide remain, a turn?
        for (const int l : shared.lines) {
            if (first.axis.cross(lines_[l].axis).norm() > parallel) is_along = false;
            if (l != shared.lines.front()) is_about = false;
        }
        for (const int k : shared.balls) {
            is_along = false;
            is_about =
                is_about && from_line(feature(fits_[k].hole).surface.point, first.point, first.axis) <= known(fits_[k]) + fits_[k].play;
        }
        joint.is_pressed = is_pressed(joint.b, shared);
        for (const int l : shared.lines) stop_along(lines_[l], joint);
        if (joint.stops[0] && joint.stops[1]) is_along = false;
        joint.kind = joint.is_pressed       ? JointKind::fixed
                     : is_along && is_about ? JointKind::cylindrical
                     : is_along             ? JointKind::prismatic
                     : is_about             ? JointKind::revolute
                                            : JointKind::fixed;
    }

    // Larger than its holes, or in smaller ones, wherever it sits?
    bool is_pressed(int body, const Shared& shared) const {
        bool any = false;
        for (const int l : shared.lines)
            for (const int k : lines_[l].fits) {
                const Fit& fit = fits_[k];
                if (fit.pin.body != body && fit.hole.body != body) continue;
                if (fit.play >= -known(fit)) return false;
                any = true;
            }
        return any;
    }

    // Flat faces of the others on the line that are near enough to count as what holds the part along it.
    void stop_along(const Line& line, ProposedJoint& joint) {
        double most = 0;
        for (const int k : line.fits)
            if (fits_[k].pin.body == joint.b || fits_[k].hole.body == joint.b)
                most = std::max({most, 4 * fits_[k].play, fits_[k].overlap / 4});
        for (const int other : line.bodies) {
            if (other == joint.b) continue;
            for (const Facing& face : facing(other, joint.b, most)) {
                const double along = face.normal.dot(joint.axis);
                if (face.gap > most || std::abs(along) < 1 - parallel * parallel) continue;
                std::optional<Stop>& stop = joint.stops[along < 0 ? 1 : 0];
                if (!stop || face.gap < stop->gap) stop = Stop{{joint.b, face.of_b}, {other, face.of_a}, face.gap};
            }
        }
    }

    // Flat faces hold parts that hang together by nothing else.
    void find_guides() {
        Groups groups(parts_.size());
        for (const Line& line : lines_)
            for (const int body : line.bodies) groups.join(body, line.bodies.front());
        for (const Fit& fit : fits_)
            if (is_ball(fit)) groups.join(fit.pin.body, fit.hole.body);
        for (int x = 0; x < count_of(parts_); ++x)
            for (int y = x + 1; y < count_of(parts_); ++y) {
                if (groups.are_one(x, y) || !guided(x, y)) continue;
                guides_.emplace_back(x, y);
                groups.join(x, y);
            }
    }

    std::optional<ProposedJoint> guided(int a, int b) {
        constexpr double share = 0.08;
        struct Between {
            Vector3 direction;
            Stop low, high;
        };
        std::vector<Between> held;
        const std::vector<Facing>& faces = facing(a, b, share * std::min(size_of(placed_[a]), size_of(placed_[b])));
        for (const Facing& x : faces)
            for (const Facing& y : faces) {
                if (!(x.normal.dot(y.normal) < -1 + parallel * parallel)) continue;
                if (std::any_of(held.begin(), held.end(), [&](const Between& h) { return h.direction.cross(x.normal).norm() < 0.5; }))
                    continue;
                held.push_back({x.normal, {{b, x.of_b}, {a, x.of_a}, x.gap}, {{b, y.of_b}, {a, y.of_a}, y.gap}});
            }
        if (held.size() < 2) return std::nullopt;
        ProposedJoint joint;
        joint.a = a;
        joint.b = b;
        joint.kind = held.size() == 2 ? JointKind::prismatic : JointKind::fixed;
        joint.axis = held[0].direction.cross(held[1].direction).normalized();
        Eigen::Index largest = 0;
        joint.axis.cwiseAbs().maxCoeff(&largest);
        if (joint.axis[largest] < 0) joint.axis = -joint.axis;
        joint.point = feature(held[0].low.of_b).centre;
        for (const Between& h : held)
            for (const Stop& stop : {h.low, h.high}) joint.guides.push_back(stop);
        return joint;
    }

    const std::vector<geometry::Mesh>& placed_;
    const std::vector<Features>& parts_;
    const std::vector<Fit>& fits_;
    std::vector<Line> lines_;
    std::vector<std::pair<int, int>> guides_;
    std::vector<int> depth_;  // by body: how far from its ground
    std::map<std::pair<int, int>, std::pair<double, std::vector<Facing>>> facing_;
};

}  // namespace

const char* to_string(JointKind kind) {
    switch (kind) {
        case JointKind::revolute:
            return "revolute";
        case JointKind::cylindrical:
            return "cylindrical";
        case JointKind::prismatic:
            return "prismatic";
        case JointKind::ball:
            return "ball";
        case JointKind::fixed:
            return "fixed";
    }
    return "?";
}

int proposed_ground(const std::vector<geometry::Mesh>& placed) {
    FETTLE_ASSERT(!placed.empty(), "an assembly without parts has no ground");
    const auto lesser = [](const geometry::Mesh& x, const geometry::Mesh& y) { return box_volume(x) < box_volume(y); };
    return static_cast<int>(std::max_element(placed.begin(), placed.end(), lesser) - placed.begin());
}

std::vector<ProposedJoint> propose_joints(const std::vector<geometry::Mesh>& placed, const std::vector<Features>& parts,
                                          const std::vector<Fit>& fits, int ground) {
    FETTLE_ASSERT(placed.size() == parts.size() && ground >= 0 && ground < count_of(parts), "features of each part, and one that stands");
    return Proposals(placed, parts, fits).run(ground);
}

}  // namespace fettle::core::features
