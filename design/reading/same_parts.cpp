// SPDX-License-Identifier: MIT
#include "design/reading/same_parts.hpp"

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "design/reading/same_formula.hpp"

namespace fettle::design::reading {

namespace {

using core::scene::Body;
using core::scene::BoundNumber;
using core::scene::Scene;

bool begins_with_one_of(std::string_view text, std::initializer_list<std::string_view> beginnings) {
    return std::any_of(beginnings.begin(), beginnings.end(), [&](std::string_view each) { return text.starts_with(each); });
}

std::vector<const BoundNumber*> numbers_of_parts(const Scene& scene) {
    std::vector<const BoundNumber*> numbers;
    for (const BoundNumber& number : scene.numbers)
        if (!leaves_parts(number.place)) numbers.push_back(&number);
    return numbers;
}

bool is_same_body(const Body& a, const Body& b) {
    const bool same_inertial =
        a.inertial && b.inertial
            ? a.inertial->mass == b.inertial->mass && a.inertial->centre == b.inertial->centre && a.inertial->inertia == b.inertial->inertia
            : !a.inertial && !b.inertial;
    return a.mesh.vertices.cols() == b.mesh.vertices.cols() && a.mesh.vertices == b.mesh.vertices && a.mesh.triangles == b.mesh.triangles &&
           a.mesh.edges == b.mesh.edges && a.mesh.codimensional_points == b.mesh.codimensional_points && a.shape == b.shape &&
           a.density == b.density && a.mass_kind == b.mass_kind && same_inertial && a.pose.position == b.pose.position &&
           a.pose.rotation == b.pose.rotation;
}

}  // namespace

bool leaves_parts(std::string_view pointer) {
    constexpr std::string_view bodies = "/bodies/";
    if (!pointer.starts_with(bodies))
        return begins_with_one_of(pointer, {"/gravity", "/timestep", "/end_time", "/integrator", "/contact", "/friction", "/springs",
                                            "/dampers", "/motors", "/loads"});
    const std::size_t key = std::min(pointer.find('/', bodies.size()), pointer.size());
    return begins_with_one_of(pointer.substr(key),
                              {"/prescribed", "/fixed", "/linear_velocity", "/angular_velocity", "/force", "/torque", "/damping", "/mu"});
}

bool have_same_parts(const Scene& a, const Scene& b) {
    const std::vector<const BoundNumber*> of_a = numbers_of_parts(a), of_b = numbers_of_parts(b);
    const auto is_same_number = [](const BoundNumber* x, const BoundNumber* y) {
        return x->place == y->place && is_same_formula(x->formula, y->formula);
    };
    return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), is_same_number) &&
           std::equal(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), b.bodies.end(), is_same_body);
}

}  // namespace fettle::design::reading
