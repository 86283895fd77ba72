// SPDX-License-Identifier: MIT
#include "core/clearance/overlap.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "core/base/limits.hpp"
#include "core/base/rounding.hpp"
#include "core/clearance/pair_search.hpp"
#include "core/clearance/touching.hpp"
#include "core/geometry/distance.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/parts/common_part.hpp"

namespace fettle::core::clearance {
namespace {

using parts::CommonPart;
using parts::CutTriangle;

constexpr int most_normals = 200;  // of faces, per body
constexpr std::size_t most_directions = 64;
constexpr int most_moves = 12;         // that are tried
constexpr long most_bounds = 200'000;  // of the distance after a move

// Distance of a point, in the body's frame, to its triangles.
double distance_to_surface(const Vector3& x, const PieceTree& tree) {
    double squared = infinity;
    std::vector<std::pair<double, int>> pending{{0, 0}};
    const auto apart = [&](int i) {
        const Piece& p = tree.pieces[i];
        return ((p.axes.transpose() * (x - p.center)).cwiseAbs() - p.half_extent).cwiseMax(0).squaredNorm();
    };
    while (!pending.empty()) {
        const auto [least, index] = pending.back();
        pending.pop_back();
        if (least >= squared) continue;
        const Piece& piece = tree.pieces[index];
        if (piece.is_element()) {
            const Corners& c = tree.elements[piece.first].corners;
            if (c.count == 3)
                squared = std::min(squared, geometry::point_triangle_closest(x, c.x.col(0), c.x.col(1), c.x.col(2)).distance_squared);
            continue;
        }
        const double left = apart(piece.left), right = apart(piece.right);
        const auto far = left < right ? std::pair{right, piece.right} : std::pair{left, piece.left};
        pending.push_back(far);
        pending.push_back(left < right ? std::pair{left, piece.left} : std::pair{right, piece.right});
    }
    return std::sqrt(squared);
}

// Greater than 0 inside.
double inner_distance(const Vector3& x, const SolidBody& body) {
    const double distance = distance_to_surface(x, body.tree);
    return certificate::is_in_material(x, body.solid) ? distance : -distance;
}

struct Box {
    Vector3 low = Vector3::Constant(infinity), high = Vector3::Constant(-infinity);
    void add(const Vector3& x) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
};

struct Cell {
    Vector3 center, half;
    double key = 0;   // what looking closer may win
    double room = 0;  // >= depth below the surface of both, anywhere in the cell
    bool operator<(const Cell& other) const { return key < other.key; }
};

// Cells in body b's frame.
class OverlapSearch {
public:
    OverlapSearch(const SolidBody& a, const SolidBody& b, const PairSegment& segment, double s)
        : a_(a), b_(b), at_(instant_at(segment, s)), slack_(segment.slack) {
        to_a_ = at_.rotation_a.inverse() * at_.rotation_b;
        shift_a_ = at_.rotation_a.inverse() * at_.offset;
        const double norms = segment.a->base_norm * segment.b->base_norm;
        stretch_ = norms * norms * rounded_up;
    }

    std::optional<Overlap> run(int cells) { return run(common_box(), cells / 2, cells - cells / 2); }

    /// By what the two have in common, whose thickest piece is looked at for the largest ball.
    std::optional<Overlap> run(int cells, const CommonPart& common) {
        std::optional<Overlap> overlap;
        double thickest = 0;
        for (const CommonPart& piece : pieces_of(common)) {
            const double thickness = piece.volume() / piece.area();
            if (!(thickness > thickest)) continue;
            thickest = thickness;
            overlap = run(box_of(piece), 0, cells);
        }
        if (!overlap) return overlap;
        const double volume = common.volume(), rounding = 2 * (slack_ + common.moved) * common.area() + 1e-12 * volume;
        overlap->volume_lower = std::max(0.0, volume - rounding);
        overlap->volume_upper = volume + rounding;
        overlap->depth_upper = std::min(overlap->depth_upper, parting_move(common, overlap->depth_upper));
        return overlap;
    }

    /// a's mesh where b's is.
    geometry::Mesh placed_a() const {
        geometry::Mesh mesh = *a_.tree.mesh;
        for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) mesh.vertices.col(i) = in_b(a_.tree.mesh->vertices.col(i));
        return mesh;
    }

private:
    std::optional<Overlap> run(const Box& common, int cells_for_volume, int cells_for_depth) {
        if (!((common.high - common.low).minCoeff() > 0)) return std::nullopt;
        open_ = {};
        deep_.clear();
        within_ = 0;
        Cell root;
        root.center = 0.5 * (common.low + common.high);
        root.half = 0.5 * (common.high - common.low) * rounded_up;
        look_at(root);
        search_volume(cells_for_volume);
        search_depth(cells_for_depth);
        Overlap overlap;
        overlap.depth_lower = best_ > 0 ? 2 * best_ : 0;
        overlap.center = at_.rotation_b * best_at_;
        overlap.depth_upper = depth_along_directions();
        const double stretched = stretch_ * stretch_ * stretch_ * (1 + 1e-12);  // and the rounding of a sum of some thousand volumes
        overlap.volume_lower = within_ / stretched;
        overlap.volume_upper = within_;
        for (; !open_.empty(); open_.pop()) overlap.volume_upper += volume(open_.top());
        overlap.volume_upper *= stretched;
        return overlap;
    }

    static double volume(const Cell& cell) { return 8 * cell.half.prod(); }

    Vector3 in_b(const Vector3& of_a) const { return at_.rotation_b.transpose() * (at_.rotation_a * of_a + at_.offset); }

    Box box_of(const CommonPart& piece) const {
        Box box;
        for (const Vector3& x : piece.points) box.add(x);
        const Vector3 room = Vector3::Constant(slack_);
        return {box.low - room, box.high + room};
    }

    Box common_box() const {
        Box of_a, of_b;
        const Matrix3X& x = a_.tree.mesh->vertices;
        for (Eigen::Index i = 0; i < x.cols(); ++i) of_a.add(in_b(x.col(i)));
        const Matrix3X& y = b_.tree.mesh->vertices;
        for (Eigen::Index i = 0; i < y.cols(); ++i) of_b.add(y.col(i));
        const Vector3 room = Vector3::Constant(slack_);
        return {of_a.low.cwiseMax(of_b.low) - room, of_a.high.cwiseMin(of_b.high) + room};
    }

    // Sorts a cell: outside of one, within both, or still open.
    void look_at(Cell cell) {
        const double reach = cell.half.norm() * stretch_;
        const double in_a = inner_distance(to_a_ * cell.center - shift_a_, a_);
        if (in_a + reach + slack_ < 0) return;
        const double in_b = inner_distance(cell.center, b_);
        if (in_b + reach + slack_ < 0) return;
        const double least = std::min(in_a, in_b);
        const double ball = least / stretch_ - slack_;
        if (ball > best_) {
            best_ = ball;
            best_at_ = cell.center;
        }
        cell.room = least + reach;
        if (least > reach + slack_) {
            within_ += volume(cell);
            deep_.push_back(cell);
            return;
        }
        cell.key = volume(cell);
        open_.push(cell);
    }

    void search_volume(int cells) {
        for (int i = 0; i < cells && !open_.empty(); i += 2) {
            const Cell cell = open_.top();
            open_.pop();
            halve(cell);
        }
    }

    // The largest ball: only its middle is looked for, the volumes stay as they are.
    void search_depth(int cells) {
        std::priority_queue<Cell> promising;
        const auto add = [&](Cell cell) {
            cell.key = cell.room;
            if (cell.room > best_) promising.push(cell);
        };
        std::vector<Cell> all = deep_;
        for (auto copy = open_; !copy.empty(); copy.pop()) all.push_back(copy.top());
        for (const Cell& cell : all) add(cell);
        for (int i = 0; i < cells && !promising.empty(); ++i) {
            const Cell cell = promising.top();
            promising.pop();
            if (!(cell.room > best_ * (1 + 1e-3))) break;
            for (Cell half : halves(cell)) {
                const double least = std::min(inner_distance(to_a_ * half.center - shift_a_, a_), inner_distance(half.center, b_));
                half.room = least + half.half.norm() * stretch_;
                if (least / stretch_ - slack_ > best_) {
                    best_ = least / stretch_ - slack_;
                    best_at_ = half.center;
                }
                add(half);
            }
        }
    }

    static std::array<Cell, 2> halves(const Cell& cell) {
        Eigen::Index axis = 0;
        cell.half.maxCoeff(&axis);
        std::array<Cell, 2> parts{cell, cell};
        for (Cell& part : parts) part.half[axis] *= 0.5;
        parts[0].center[axis] -= parts[0].half[axis];
        parts[1].center[axis] += parts[1].half[axis];
        return parts;
    }
    void halve(const Cell& cell) {
        for (const Cell& part : halves(cell)) look_at(part);
    }

    // n in world axes: how far a has to go along n, or against it, to be beyond b's hull.
    double depth_along(const Vector3& n) const {
        const Eigen::RowVectorXd of_a = (at_.rotation_a.transpose() * n).transpose() * a_.tree.mesh->vertices;
        const Eigen::RowVectorXd of_b = (at_.rotation_b.transpose() * n).transpose() * b_.tree.mesh->vertices;
        const double along = n.dot(at_.offset);
        const double forth = of_b.maxCoeff() - (of_a.minCoeff() + along), back = of_a.maxCoeff() + along - of_b.minCoeff();
        return std::max(0.0, std::min(forth, back) + 2 * slack_) * rounded_up / std::min(1.0, n.norm());
    }

    double depth_along_directions() const {
        double least = infinity;
        for (const auto& [rotation, tree] : {std::pair{&at_.rotation_a, &a_.tree}, std::pair{&at_.rotation_b, &b_.tree}}) {
            for (int k = 0; k < 3; ++k) least = std::min(least, depth_along(rotation->col(k)));
            const auto& triangles = tree->mesh->triangles;
            const std::size_t stride = triangles.size() / most_normals + 1;
            for (std::size_t t = 0; t < triangles.size(); t += stride) {
                const Matrix3X& x = tree->mesh->vertices;
                const Vector3 u = x.col(triangles[t][1]) - x.col(triangles[t][0]), v = x.col(triangles[t][2]) - x.col(triangles[t][0]);
                const Vector3 n = unit_direction(*rotation * u.cross(v));
                if (n != Vector3::Zero()) least = std::min(least, depth_along(n));
            }
        }
        return least;
    }

    struct Move {
        Vector3 direction;  // of a, in b's frame
        double length = 0;
    };

    // Moves along the normals of the faces of the common part: a leaves b across b's faces, and draws back from its own.
    std::vector<Move> likely_moves(const CommonPart& common) const {
        std::vector<Vector3> directions(1, Vector3::Zero());  // the first is their mean
        for (const CutTriangle& t : common.triangles) {
            const Vector3 area = common.area_of(t);
            const Vector3 out = t.of_a ? Vector3(-area) : area;
            directions.front() += out;
            const Vector3 n = unit_direction(out);
            const bool known = std::any_of(directions.begin() + 1, directions.end(), [&](const Vector3& d) { return d.dot(n) > 1 - 1e-6; });
            if (!known && n != Vector3::Zero() && directions.size() < most_directions) directions.push_back(n);
        }
        directions.front() = unit_direction(directions.front());
        if (directions.front() == Vector3::Zero()) directions.erase(directions.begin());
        const std::vector<CommonPart> pieces = pieces_of(common);
        std::vector<Move> moves;
        for (const Vector3& n : directions) {
            double width = 0;
            for (const CommonPart& piece : pieces) {
                double low = infinity, high = -infinity;
                for (const Vector3& x : piece.points) {
                    low = std::min(low, n.dot(x));
                    high = std::max(high, n.dot(x));
                }
                width = std::max(width, high - low);
            }
            moves.push_back({n, width * (1 + 1e-4) + 64 * slack_});
        }
        std::sort(moves.begin(), moves.end(), [](const Move& x, const Move& y) { return x.length < y.length; });
        return moves;
    }

    // The first of them that is proven to part the two; `known`, if none shorter than that is.
    double parting_move(const CommonPart& common, double known) const {
        int tries = 0;
        for (const Move& move : likely_moves(common)) {
            if (move.length >= known || ++tries > most_moves) break;
            if (are_apart_after(move)) return move.length * rounded_up;
        }
        return known;
    }

    bool are_apart_after(const Move& move) const {
        const Vector3 way = at_.rotation_b * (move.length * move.direction);
        const kinematics::Pose pose_a{at_.rotation_a, at_.offset + way}, pose_b{at_.rotation_b, Vector3::Zero()};
        const PairSegment held = pair_held(pose_a, pose_b, a_.tree.radius(), b_.tree.radius());
        SearchOptions search;
        search.tolerance = search.enough = 4 * held.slack;
        search.refuted = held.slack;
        search.max_evaluations = most_bounds;
        search.exact_witness = false;
        const SearchResult found = search_pair(a_.tree, b_.tree, {held}, search);
        if (found.intersecting || !(found.lower > 2 * held.slack)) return false;
        const auto is_in = [&](const SolidBody& inner, const SolidBody& outer, const kinematics::Pose& of_inner,
                               const kinematics::Pose& of_outer) {
            return std::any_of(inner.solid.samples.begin(), inner.solid.samples.end(), [&](int v) {
                const Vector3 x = kinematics::world_position(of_inner, inner.tree.mesh->vertices.col(v));
                return certificate::is_in_material(of_outer.rotation.transpose() * (x - of_outer.position), outer.solid);
            });
        };
        return !is_in(a_, b_, pose_a, pose_b) && !is_in(b_, a_, pose_b, pose_a);
    }

    const SolidBody &a_, &b_;
    Instant at_;
    double slack_;
    double stretch_ =
        1;  // lengths and distances in one of the frames, over those in the other or in the world: at most, and 1 over it at least
    Matrix3 to_a_;
    Vector3 shift_a_;
    std::priority_queue<Cell> open_;
    std::vector<Cell> deep_;
    double within_ = 0, best_ = 0;
    Vector3 best_at_ = Vector3::Zero();
};

bool is_solid(const SolidBody& body) { return body.solid.is_closed && !body.solid.shells.empty(); }

// The volume of a mesh; infinity if it winds round anything twice.
double volume_of(const geometry::Mesh& mesh) {
    if (!winds_once(mesh)) return infinity;
    return std::abs(geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3)) * (1 + 1e-9);
}

}  // namespace

std::optional<Overlap> overlap_at(const SolidBody& a, const SolidBody& b, const PairSegment& segment, double s, int cells) {
    if (!is_solid(a) || !is_solid(b)) return std::nullopt;
    return OverlapSearch(a, b, segment, s).run(cells);
}

std::optional<Overlap> measured_overlap(const SolidBody& a, const SolidBody& b, const PairSegment& segment, double s, int cells) {
    if (!is_solid(a) || !is_solid(b)) return std::nullopt;
    OverlapSearch search(a, b, segment, s);
    if (const auto common = parts::common_part(search.placed_a(), *b.tree.mesh)) return search.run(cells, *common);
    std::optional<Overlap> overlap = search.run(cells);
    if (overlap) overlap->volume_upper = std::min({overlap->volume_upper, volume_of(*a.tree.mesh), volume_of(*b.tree.mesh)});
    return overlap;
}

}  // namespace fettle::core::clearance
