// SPDX-License-Identifier: MIT
/// Random trees of bodies (random_trees.hpp) whose vertices and frames deviate by formulas, and where they are for given deviations and
/// joint coordinates: in extended precision, sharing nothing with Taylor models.
#pragma once

#include "core/certificate/toleranced.hpp"
#include "core/expression/tape.hpp"
#include "tests/core/clearance/random_trees.hpp"

namespace fettle::tests::tolerances {

using clearance::Real;
using clearance::Real3;
using clearance::Real33;
using core::certificate::NodePoint;
using core::certificate::Toleranced;
using core::expression::Number;

struct TolerancedTree {
    trees::Tree tree;
    Toleranced toleranced;
    int a = 0, b = 0;
};

class TreeRecorder {
public:
    TreeRecorder(std::mt19937& random, trees::Tree tree, double largest) : random_(random) {
        out_.tree = std::move(tree);
        out_.a = out_.tree.a;
        out_.b = out_.tree.b;
        const auto& linkage = out_.tree.ranges.linkage;
        out_.toleranced.coordinates = linkage.coordinates;
        const int count = 2 + static_cast<int>(random_() % 5);
        std::uniform_real_distribution<double> u(0, 1);
        for (int k = 0; k < count; ++k) {
            const double lower = -largest * u(random_), upper = largest * u(random_);
            out_.toleranced.deviations.push_back({"d" + std::to_string(k), lower, upper, 0});
            deviations_.push_back(tape_.input(0));
        }
        for (int i = 0; i < count_of(linkage.bodies); ++i) record(i);
        out_.toleranced.nodes = tape_.nodes();
    }
    TolerancedTree take() { return std::move(out_); }

private:
    using Numbers = std::array<Number, 3>;

    Number deviation() { return deviations_[random_() % deviations_.size()]; }
    NodePoint nodes(const Numbers& x) { return {tape_.node_of(x[0]), tape_.node_of(x[1]), tape_.node_of(x[2])}; }
    static Numbers constant(const Vector3& x) { return {Number(x[0]), Number(x[1]), Number(x[2])}; }
    static Numbers moved(const Numbers& x, const Number& d, const Vector3& by) {
        return {x[0] + d * Number(by[0]), x[1] + d * Number(by[1]), x[2] + d * Number(by[2])};
    }

    void record(int i) {
        const auto& linkage = out_.tree.ranges.linkage;
        const auto& model = out_.tree.model;
        auto& body = out_.toleranced.bodies.emplace_back();
        body.parent = linkage.bodies[i].parent;
        const core::kinematics::Pose own = model.bodies[i].pose_start,
                                     of = body.parent < 0 ? core::kinematics::Pose{} : model.bodies[body.parent].pose_start;
        const Matrix3 back = of.rotation.transpose();
        Numbers place = constant(back * (own.position - of.position));
        const bool shifts = random_() % 2 == 0;
        const Number d = deviation();
        const Vector3 way = clearance::random_vector(random_, 1);
        if (shifts) place = moved(place, d, way);
        for (const auto& screw : linkage.bodies[i].screws) {
            Numbers point = constant(back * (screw.point - of.position));
            if (shifts) point = moved(point, d, way);
            body.screws.push_back({screw.coordinate, nodes(point), nodes(constant(back * screw.axis)), screw.turn, screw.slide});
        }
        body.place = nodes(place);
        record_rotation(back * own.rotation, body);
        if (random_() % 2 == 0) record_vertices(model.bodies[i].mesh.vertices, body);
    }

    // Turned by some angle about the z axis of the parent's frame.
    void record_rotation(const Matrix3& rotation, core::certificate::TolerancedBody& body) {
        Numbers rows[3];
        for (int r = 0; r < 3; ++r) rows[r] = constant(rotation.row(r).transpose());
        if (random_() % 3 == 0) {
            const Number angle = Number(5.0) * deviation(), c = cos(angle), s = sin(angle);
            Numbers x, y;
            for (std::size_t k = 0; k < 3; ++k) {
                x[k] = c * rows[0][k] - s * rows[1][k];
                y[k] = s * rows[0][k] + c * rows[1][k];
            }
            rows[0] = x;
            rows[1] = y;
        }
        for (std::size_t r = 0; r < 3; ++r) body.rotation[r] = nodes(rows[r]);
    }

    void record_vertices(const Matrix3X& vertices, core::certificate::TolerancedBody& body) {
        const Number stretch = Number(1.0) + Number(20.0) * deviation(), bulge = sqrt(Number(1.0) + Number(30.0) * deviation());
        for (Eigen::Index v = 0; v < vertices.cols(); ++v) {
            const Vector3 x = vertices.col(v);
            body.vertices.push_back(nodes({bulge * Number(x[0]), stretch * Number(x[1]), stretch * bulge * Number(x[2])}));
        }
    }

    std::mt19937& random_;
    core::expression::Tape tape_;
    std::vector<Number> deviations_;
    TolerancedTree out_;
};

/// @param largest  deviation, of bodies of some 0.1 [m]
inline TolerancedTree random_toleranced_tree(std::mt19937& random, double largest) {
    return TreeRecorder(random, trees::random_tree(random), largest).take();
}

/// Everything at one set of deviations.
class RealBodies {
public:
    RealBodies(const TolerancedTree& of, const std::vector<double>& deviations) : of_(of) {
        const std::vector<Real> inputs(deviations.begin(), deviations.end());
        values_ = core::expression::values<Real>(of.toleranced.nodes, inputs);
    }

    clearance::RealVertices placed(int body, const std::vector<double>& u) const {
        const Matrix3X& mesh = of_.tree.model.bodies[body].mesh.vertices;
        clearance::RealVertices x = mesh.cast<Real>();
        const auto& nodes = of_.toleranced.bodies[body].vertices;
        for (std::size_t v = 0; v < nodes.size(); ++v) x.col(static_cast<Eigen::Index>(v)) = point(nodes[v]);
        for (int at = body; at >= 0; at = of_.toleranced.bodies[at].parent) {
            const auto& from = of_.toleranced.bodies[at];
            Real33 rotation;
            for (int r = 0; r < 3; ++r) rotation.row(r) = point(from.rotation[static_cast<std::size_t>(r)]).transpose();
            x = (rotation * x).colwise() + point(from.place);
            for (auto screw = from.screws.rbegin(); screw != from.screws.rend(); ++screw) {
                const Real d = static_cast<Real>(u[screw->coordinate]) - of_.toleranced.coordinates[screw->coordinate].start;
                const Real3 p = point(screw->point), z = point(screw->axis);
                x = (clearance::oracle_rotation(screw->turn * d * z) * (x.colwise() - p)).colwise() + (p + screw->slide * d * z);
            }
        }
        return x;
    }
    Real distance(const std::vector<double>& u) const {
        return clearance::oracle_distance(of_.tree.model.bodies[of_.a].mesh, placed(of_.a, u), of_.tree.model.bodies[of_.b].mesh,
                                          placed(of_.b, u));
    }

private:
    Real3 point(const NodePoint& nodes) const { return {values_[nodes[0]], values_[nodes[1]], values_[nodes[2]]}; }
    const TolerancedTree& of_;
    std::vector<Real> values_;
};

}  // namespace fettle::tests::tolerances
