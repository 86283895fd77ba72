// SPDX-License-Identifier: MIT
#include "core/clearance/toleranced_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/kronecker.hpp"
#include "core/clearance/pair_search.hpp"
#include "core/clearance/piece_bound.hpp"
#include "core/clearance/search_front.hpp"
#include "core/clearance/toleranced_direction.hpp"

namespace fettle::core::clearance {
namespace {

using certificate::Model3;
using certificate::PlacedPair;
using certificate::TaylorModel;
using certificate::TolerancedProver;

constexpr double large_angle = 0.3;  // [rad]

using TolerancedCell = BoxCell<VariableBox>;

// Vertices of every piece, each once.
std::vector<std::vector<int>> piece_vertices(const PieceTree& tree) {
    std::vector<std::vector<int>> out(tree.pieces.size());
    for (std::size_t i = 0; i < tree.pieces.size(); ++i) {
        for (const PieceElement& element : tree.elements_of(tree.pieces[i]))
            for (const int v : element.vertices)
                if (v >= 0) out[i].push_back(v);
        std::sort(out[i].begin(), out[i].end());
        out[i].erase(std::unique(out[i].begin(), out[i].end()), out[i].end());
    }
    return out;
}

Vector3 at_middle(const Model3& x) { return {x[0].center, x[1].center, x[2].center}; }
Vector3 motion_along(const Model3& x, std::size_t k) { return {x[0].slopes[k], x[1].slopes[k], x[2].slopes[k]}; }

Matrix3 at_middle(const certificate::ModelMatrix& m) {
    Matrix3 out;
    for (std::size_t i = 0; i < 3; ++i) out.row(static_cast<Eigen::Index>(i)) = at_middle(m[i]).transpose();
    return out;
}

Corners made_corners(const PieceElement& element, const MadeBodies& made, int body, const Matrix3X& mesh, const kinematics::Pose& pose) {
    Corners out = element.corners;
    for (Eigen::Index i = 0; i < 3; ++i) {
        const auto last = static_cast<Eigen::Index>(out.count) - 1;
        const int v = element.vertices[static_cast<std::size_t>(std::min(i, last))];
        out.x.col(i) = kinematics::world_position(pose, made.vertex(body, mesh, v));
    }
    return out;
}

// Evaluates cells; remembers the nearest pair of elements that it has met.
class TolerancedCells {
public:
    using Box = VariableBox;
    using Encounter = TolerancedEncounter;

    explicit TolerancedCells(const TolerancedBodies& bodies)
        : bodies_(bodies),
          prover_(bodies.prover),
          variables_(bodies.pair.variables()),
          vertices_a_(piece_vertices(bodies.a)),
          vertices_b_(piece_vertices(bodies.b)) {
        for (const auto* line : {&bodies.pair.a, &bodies.pair.b})
            for (const int body : *line)
                for (const certificate::TolerancedScrew& screw : bodies.toleranced.bodies[body].screws) {
                    const auto& list = bodies.pair.coordinates;
                    const auto at = std::lower_bound(list.begin(), list.end(), screw.coordinate);
                    if (at != list.end() && *at == screw.coordinate) turn_rates_[at - list.begin()] += std::abs(screw.turn);
                }
    }

    TolerancedSearchResult result;

    BoxTrees trees() const { return {bodies_.a, bodies_.b, variables_, bodies_.slack}; }
    VariableBox root_box() const { return prover_.box(); }
    void descend();
    auto dependents_at(const VariableBox::Values& at) { return prover_.dependents_at(at); }

    CellProof evaluate(TolerancedCell& cell, double wanted, double tolerance) {
        return evaluate(prover_.placed(cell.box), cell, wanted, tolerance);
    }
    void evaluate_parts(const TolerancedCell& /*whole*/, char /*by*/, std::array<TolerancedCell, 2>& parts, double tolerance) {
        for (TolerancedCell& part : parts) evaluate(prover_.placed(part.box), part, result.upper, tolerance);
    }
    // A vector that turns is bounded as if it were as long as 1; one that stays as it is.
    static bool proves(const CellProof& found, double distance) {
        if (found.normals.size() > 1) return found.lower >= distance;
        const Vector3& n = found.normals.front();
        return found.lower >= geometry::upper(distance * geometry::norm_bound({n[0], n[1], n[2]}));
    }

    /// The two elements there, in doubles, taken as an upper bound. @return their distance
    double look(const VariableBox::Values& at, int element_a, int element_b) {
        const auto dependents = prover_.dependents_at(at);
        if (!dependents) return infinity;
        const AllValues all = all_values(bodies_.toleranced, bodies_.pair, at, *dependents);
        const MadeBodies made(bodies_.toleranced, all.deviations);
        const int a = bodies_.pair.of_a, b = bodies_.pair.of_b;
        const TolerancedEncounter encounter{
            at, *dependents, element_a, element_b,
            element_pair_distance(
                made_corners(bodies_.a.elements[element_a], made, a, bodies_.a.mesh->vertices, made.pose(a, all.coordinates)),
                made_corners(bodies_.b.elements[element_b], made, b, bodies_.b.mesh->vertices, made.pose(b, all.coordinates)))};
        take_upper(result, encounter, bodies_.slack);
        return encounter.pair.distance;
    }

private:
    CellProof evaluate(const PlacedPair& at, TolerancedCell& cell, double wanted, double tolerance) {
        ++result.bounds;
        const Piece &a = bodies_.a.pieces[cell.a], &b = bodies_.b.pieces[cell.b];
        const bool elements = a.is_element() && b.is_element();
        if (!at.is_known) {  // what drives the loop has to be halved
            cell.loosened = infinity;
            cell.widest = widest_coordinate(cell.box);
            return {-infinity, {Vector3::UnitX()}};
        }
        look_at_motion(at, cell, elements ? 0 : std::max(a.size, b.size));
        CellProof proof;
        proof.normals = {first_direction(at, cell, elements)};
        proof.lower = proven(bound(at, proof.normals[0], cell));
        if (elements && !(proof.lower >= wanted)) improve(at, cell, wanted, tolerance, proof);
        cell.lower = std::max(cell.lower, proof.lower);
        return proof;
    }

    double bound(const PlacedPair& at, const Vector3& n, const TolerancedCell& cell) const {
        return certificate::least_along(at, n, vertices_a_[cell.a], vertices_b_[cell.b]);
    }

    // From b to a where all variables are in the middle, in b's frame.
    Vector3 first_direction(const PlacedPair& at, const TolerancedCell& cell, bool elements) {
        const Piece &a = bodies_.a.pieces[cell.a], &b = bodies_.b.pieces[cell.b];
        const Matrix3 rotation = at_middle(at.rotation);
        const Vector3 place = at_middle(at.place);
        if (!elements)
            return box_separation(rotation * a.center + place - b.center, rotation * a.axes, a.half_extent, b.axes, b.half_extent)
                .direction;
        middle_ = element_pair_distance(middle_corners(at.models->a, bodies_.a.elements[a.first], {rotation, place}),
                                        middle_corners(at.models->b, bodies_.b.elements[b.first], {}));
        return unit_direction(middle_.difference);
    }

    static Corners middle_corners(const std::vector<Model3>& models, const PieceElement& element, const kinematics::Pose& pose) {
        Corners out = element.corners;
        for (Eigen::Index i = 0; i < 3; ++i) {
            const auto last = static_cast<Eigen::Index>(out.count) - 1;
            out.x.col(i) =
                kinematics::world_position(pose, at_middle(models[element.vertices[static_cast<std::size_t>(std::min(i, last))]]));
        }
        return out;
    }

    // Better vectors for two elements: one that turns as their nearest points do, and the best that stays.
    void improve(const PlacedPair& at, const TolerancedCell& cell, double wanted, double tolerance, CellProof& proof) {
        if (middle_.intersecting) {
            look_at(cell, {});
            return;
        }
        const Vector3 first = unit_direction(middle_.difference);
        std::vector<Vector3> turning = turning_normals(at, cell, first);
        const double lower =
            proven(certificate::least_turning(at, certificate::turning_vector(turning), vertices_a_[cell.a], vertices_b_[cell.b]));
        if (lower > proof.lower) proof = {lower, std::move(turning)};
        if (proof.lower >= wanted) return;
        DifferenceHull hull(at, vertices_a_[cell.a], vertices_b_[cell.b], variables_);
        const Vector3 n = hull.direction(first, 0.05 * tolerance);
        if (linear_distance(at, cell, hull.corner()).distance < result.upper) look_at(cell, hull.corner());
        if (n == Vector3::Zero()) return;
        const double still = proven(bound(at, n, cell));
        if (still > proof.lower) proof = {still, {n}};
    }

    // The direction between the nearest points, and half of its change along each variable, across it.
    std::vector<Vector3> turning_normals(const PlacedPair& at, const TolerancedCell& cell, const Vector3& first) const {
        std::vector<Vector3> out{first};
        for (std::size_t k = 0; k < static_cast<std::size_t>(variables_); ++k) {
            VariableBox::Values low{}, high{};
            low[k] = -1;
            high[k] = 1;
            const ElementPairDistance at_low = linear_distance(at, cell, low), at_high = linear_distance(at, cell, high);
            Vector3 slope = Vector3::Zero();
            if (!at_low.intersecting && !at_high.intersecting)
                slope = 0.5 * (unit_direction(at_high.difference) - unit_direction(at_low.difference));
            out.push_back(slope - first * first.dot(slope));
        }
        return out;
    }

    // The distance of two elements at t, as far as they are linear in t, in b's frame.
    ElementPairDistance linear_distance(const PlacedPair& at, const TolerancedCell& cell, const VariableBox::Values& t) const {
        const auto vector = [&](const Model3& x) { return Vector3(linear_value(x[0], t), linear_value(x[1], t), linear_value(x[2], t)); };
        kinematics::Pose pose;
        for (std::size_t i = 0; i < 3; ++i) pose.rotation.row(static_cast<Eigen::Index>(i)) = vector(at.rotation[i]).transpose();
        pose.position = vector(at.place);
        const auto corners = [&](const std::vector<Model3>& models, const PieceElement& element, const kinematics::Pose& of) {
            Corners out = element.corners;
            for (Eigen::Index i = 0; i < 3; ++i) {
                const auto last = static_cast<Eigen::Index>(out.count) - 1;
                const int v = element.vertices[static_cast<std::size_t>(std::min(i, last))];
                out.x.col(i) = kinematics::world_position(of, vector(models[v]));
            }
            return out;
        };
        ElementPairDistance found = element_pair_distance(corners(at.models->a, bodies_.a.elements[bodies_.a.pieces[cell.a].first], pose),
                                                          corners(at.models->b, bodies_.b.elements[bodies_.b.pieces[cell.b].first], {}));
        if (found.intersecting) found.distance = 0;
        return found;
    }

    // Where in the cell's box t is.
    void look_at(const TolerancedCell& cell, const VariableBox::Values& t) {
        if (proven(cell.lower) >= result.upper) return;
        VariableBox::Values at{};
        for (std::size_t k = 0; k < static_cast<std::size_t>(variables_); ++k) {
            const double low = cell.box.low[k], high = cell.box.high[k];
            at[k] = std::clamp(0.5 * (low + high) + 0.5 * t[k] * (high - low), low, high);
        }
        look(at, bodies_.a.pieces[cell.a].first, bodies_.b.pieces[cell.b].first);
    }

    // As a share of its range.
    int widest_coordinate(const VariableBox& box) const {
        int out = 0;
        double widest = -1;
        const VariableBox whole = prover_.box();
        for (int k = 0; k < count_of(bodies_.pair.coordinates); ++k) {
            const auto i = static_cast<std::size_t>(k);
            const double share = (box.high[i] - box.low[i]) / std::max(whole.high[i] - whole.low[i], 1e-300);
            if (!(share > widest)) continue;
            widest = share;
            out = k;
        }
        return out;
    }

    // How far the box moves the pieces, and along which variable most in curves.
    void look_at_motion(const PlacedPair& at, TolerancedCell& cell, double size) const {
        const auto n = static_cast<std::size_t>(variables_);
        const Model3 &x = at.models->a[vertices_a_[cell.a].front()], &z = at.models->b[vertices_b_[cell.b].front()];
        const Model3 y = times(at.rotation, x) + at.place;
        std::array<double, certificate::most_variables> turn{}, way{};
        double rest = 0, turns = 0, ways = 0;
        for (std::size_t i = 0; i < 3; ++i) rest += x[i].rest + z[i].rest;
        for (std::size_t k = 0; k < n; ++k) {
            double squares = 0;
            for (std::size_t i = 0; i < 3; ++i) squares += motion_along(at.rotation[i], k).squaredNorm();
            turn[k] = std::sqrt(0.5 * squares);
            way[k] = (motion_along(y, k) - motion_along(z, k)).norm() + turn[k] * size;
            const double angle = 0.5 * (cell.box.high[k] - cell.box.low[k]) * turn_rates_[k];
            if (angle > large_angle) {  // of which models know the range alone, and no slope
                turn[k] = std::max(turn[k], angle);
                way[k] = std::max(way[k], angle * (bodies_.a.radius() + bodies_.b.radius() + at_middle(at.place).norm()));
            }
            turns += turn[k];
            ways += way[k];
        }
        double most = -1;
        cell.loosened = 0;
        const auto coordinates = static_cast<std::size_t>(count_of(bodies_.pair.coordinates));
        for (std::size_t k = 0; k < n; ++k) {
            double bend = 0.5 * (turn[k] * ways + turns * way[k]) + (ways > 0 ? rest * way[k] / ways : 0) + 1e-9 * way[k];
            if (size > 0 && k < coordinates) bend = std::max(bend, 0.5 * way[k]);
            cell.loosened += bend;
            if (!(bend > most)) continue;
            most = bend;
            cell.widest = static_cast<int>(k);
        }
    }

    const TolerancedBodies& bodies_;
    TolerancedProver& prover_;
    int variables_;
    std::vector<std::vector<int>> vertices_a_, vertices_b_;         // of the pieces
    std::array<double, certificate::most_variables> turn_rates_{};  // of all screws of a coordinate [rad] per unit
    ElementPairDistance middle_;
};

// From the base, samples of the coordinates and downhill: along each variable to and fro, with steps that shrink, as long as two elements
// stay the nearest.
class TolerancedDescent {
public:
    TolerancedDescent(const TolerancedBodies& bodies, TolerancedCells& cells) : bodies_(bodies), cells_(cells), box_(cells.root_box()) {}

    void run() {
        const auto coordinates = static_cast<std::size_t>(count_of(bodies_.pair.coordinates));
        const auto variables = static_cast<std::size_t>(bodies_.pair.variables());
        VariableBox::Values at = start();
        sample(at);
        static const base::Kronecker spread(certificate::most_coordinates);
        for (int i = 1; coordinates > 0 && i <= 8 + 8 * static_cast<int>(coordinates); ++i) {
            for (std::size_t k = 0; k < coordinates; ++k)
                at[k] = std::clamp(box_.low[k] + spread.at(i, k) * (box_.high[k] - box_.low[k]), box_.low[k], box_.high[k]);
            sample(at);
        }
        for (double step = 0.5; step > 1e-4; step *= 0.5)
            for (std::size_t k = 0; k < variables; ++k)
                for (const double sign : {-1.0, 1.0}) {
                    const TolerancedEncounter nearest = cells_.result.nearest;
                    if (nearest.element_a < 0 || cells_.result.intersecting) return;
                    VariableBox::Values moved = nearest.at;
                    moved[k] = std::clamp(moved[k] + sign * step * (box_.high[k] - box_.low[k]), box_.low[k], box_.high[k]);
                    if (moved[k] != nearest.at[k]) cells_.look(moved, nearest.element_a, nearest.element_b);
                }
    }

private:
    VariableBox::Values start() const {
        VariableBox::Values at{};
        std::size_t k = 0;
        for (const int c : bodies_.pair.coordinates) at[k++] = bodies_.toleranced.coordinates[c].start;
        for (const int d : bodies_.pair.deviations) at[k++] = bodies_.toleranced.deviations[d].base;
        return at;
    }

    // The elements that are nearest in the meshes at hand.
    void sample(const VariableBox::Values& at) {
        VariableBox::Values of_base = at;
        std::size_t next = bodies_.pair.coordinates.size();
        for (const int d : bodies_.pair.deviations) of_base[next++] = bodies_.toleranced.deviations[d].base;
        const auto dependents = cells_.dependents_at(of_base);
        if (!dependents) return;
        const AllValues all = all_values(bodies_.toleranced, bodies_.pair, of_base, *dependents);
        const MadeBodies made(bodies_.toleranced, base_deviations(bodies_.toleranced));
        kinematics::PathSegment held[2];
        for (const std::size_t i : {0U, 1U}) {
            const kinematics::Pose pose = made.pose(i == 0 ? bodies_.pair.of_a : bodies_.pair.of_b, all.coordinates);
            held[i].base = pose.rotation;
            held[i].position_t0 = pose.position;
        }
        SearchOptions search;
        search.max_evaluations = 200'000;
        const double known = cells_.result.upper;
        search.tolerance = std::isfinite(known) ? 1e-6 * known + bodies_.slack : 1e-6 * (bodies_.a.radius() + bodies_.b.radius());
        search.seek_intersection = !(known > 64 * bodies_.slack);
        const SearchResult found =
            search_pair(bodies_.a, bodies_.b, {pair_segment(held[0], held[1], bodies_.a.radius(), bodies_.b.radius())}, search);
        if (found.nearest.segment >= 0) cells_.look(at, found.nearest.element_a, found.nearest.element_b);
    }

    const TolerancedBodies& bodies_;
    TolerancedCells& cells_;
    VariableBox box_;
};

void TolerancedCells::descend() { TolerancedDescent(bodies_, *this).run(); }

}  // namespace

TolerancedBodies toleranced_bodies(const certificate::Toleranced& toleranced, const certificate::TolerancedPair& pair,
                                   TolerancedProver& prover, const PieceTree& a, const PieceTree& b) {
    TolerancedBodies out{toleranced, pair, prover, a, b};
    const MadeBodies made(toleranced, base_deviations(toleranced));
    const std::vector<double> start = start_coordinates(toleranced);
    double reach = prover.size();
    for (const int body : {pair.of_a, pair.of_b}) reach += made.pose(body, start).position.norm();
    double angle = 0;
    for (const auto* line : {&pair.a, &pair.b})
        for (const int body : *line) {
            reach += made.pose(body, start).position.norm();
            for (const certificate::TolerancedScrew& screw : toleranced.bodies[body].screws) {
                const double way = certificate::farthest(toleranced, screw);
                reach += std::abs(screw.slide) * way;
                angle = std::max(angle, std::abs(screw.turn) * way);
            }
        }
    const auto links = static_cast<double>(pair.a.size() + pair.b.size());
    out.slack = 0x1p-46 * (4 + links) * (1 + angle) * reach;
    return out;
}

AllValues all_values(const certificate::Toleranced& toleranced, const certificate::TolerancedPair& pair, const VariableBox::Values& at,
                     const std::vector<double>& dependents) {
    AllValues out{start_coordinates(toleranced), base_deviations(toleranced)};
    std::size_t k = 0;
    for (const int c : pair.coordinates) out.coordinates[c] = at[k++];
    for (const int d : pair.deviations) out.deviations[d] = at[k++];
    for (std::size_t i = 0; i < pair.dependents.size(); ++i) out.coordinates[pair.dependents[i]] = dependents[i];
    return out;
}

TolerancedSearchResult search_toleranced(const TolerancedBodies& bodies, const BoxSearchOptions& options) {
    return BoxSearch(TolerancedCells(bodies), options).run();
}

certificate::BoxProof prove_toleranced(const TolerancedBodies& bodies, double distance, const BoxSearchOptions& options) {
    return prove_box(TolerancedCells(bodies), distance, options);
}

}  // namespace fettle::core::clearance
