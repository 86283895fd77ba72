// SPDX-License-Identifier: MIT
/// A design whose quantities are functions that the test tells: its parameters are the densities of bodies that float at rest.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "design/problem/design_problem.hpp"
#include "tests/design/linear_numbers.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::tests::design_support {

/// Uniform, of standard deviation 1; made from the bits of u, so that the same design has the same number.
inline double scatter(double u) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &u, sizeof bits);
    std::mt19937_64 random(bits);
    return std::sqrt(3.0) * std::uniform_real_distribution<double>(-1, 1)(random);
}

/// f(u), u = (densities - 1000) / 1000: where the parameters are in their ranges, within [-0.5, 0.5], 0 in the middle.
class OfDensities : public design::description::Quantity {
public:
    using Function = std::function<double(const VectorX& u)>;
    using Gradient = std::function<VectorX(const VectorX& u)>;
    OfDensities(Function f, Gradient gradient) : f_(std::move(f)), gradient_(std::move(gradient)) {}
    Dimension dimension() const override { return Dimension::length; }
    design::description::Measurement value(const design::description::Simulated& s) const override {
        return design::description::computed(f_(shares(s)));
    }
    void add_seeds(const design::description::Simulated& s, const design::description::Measurement&, double scale,
                   design::description::Seeds& seeds) const override {
        const VectorX gradient = gradient_(shares(s));
        for (Eigen::Index k = 0; k < gradient.size(); ++k) seeds.model_bar.bodies[k].density_bar += scale * gradient[k] / 1000;
    }

private:
    static VectorX shares(const design::description::Simulated& s) {
        VectorX u(s.model.bodies.size());
        for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = (s.model.bodies[k].density - 1000) / 1000;
        return u;
    }
    Function f_;
    Gradient gradient_;
};

/// The first function is the objective, the others are constraints without bounds. Tolerances: 1e-4 of the objective (of 1 at least), and
/// 1e-4 of each constraint's unit, 1e-3.
inline design::problem::DesignProblem density_problem(int parameters, const std::vector<std::shared_ptr<OfDensities>>& quantities) {
    design::description::Design design;
    design.scene.timestep = 0.01;
    design.scene.dhat = 1e-4;
    design.steps = 2;
    for (int k = 0; k < parameters; ++k) {
        core::scene::Body body;
        body.name = "body " + std::to_string(k);
        body.mesh = support::box_mesh(Vector3::Constant(-0.01), Vector3::Constant(0.01));
        body.pose.position = Vector3(0.1 * k, 0, 0);
        design.scene.bodies.push_back(std::move(body));
        design.parameters.push_back(
            {.name = "density " + std::to_string(k), .value = 1000, .lower = 500, .upper = 1500, .unit = *find_unit("kg/m^3")});
        design_support::follow(design, design.parameters.back().name, "/bodies/" + std::to_string(k) + "/density");
    }
    design.objective = {{"objective", 1, 1, quantities.front()}};
    for (size_t q = 1; q < quantities.size(); ++q) {
        design::description::Bounds bounds;
        bounds.unit = 1e-3;
        bounds.lower = -1e9;
        design.constraints.push_back({"constraint " + std::to_string(q), bounds, quantities[q]});
    }
    auto problem = design::problem::DesignProblem::create(std::move(design));
    REQUIRE(problem);
    return std::move(problem).value();
}

}  // namespace fettle::tests::design_support
