// SPDX-License-Identifier: MIT
#include "fettle/design/description/parameter.hpp"

#include <cmath>

namespace fettle::design::description {

bool is_vector(MoveTarget target) {
    switch (target) {
        case MoveTarget::position:
        case MoveTarget::turn:
        case MoveTarget::velocity:
        case MoveTarget::angular_velocity:
        case MoveTarget::force:
        case MoveTarget::torque:
        case MoveTarget::gravity:
        case MoveTarget::point_a:
        case MoveTarget::point_b:
        case MoveTarget::axis_a:
        case MoveTarget::axis_b:
        case MoveTarget::load_point:
        case MoveTarget::load_force:
            return true;
        default:
            return false;
    }
}

bool is_of_scene(MoveTarget target) { return target == MoveTarget::gravity || target == MoveTarget::dmin; }

bool is_of_friction(MoveTarget target) { return target >= MoveTarget::body_mu && target <= MoveTarget::default_mu; }

bool is_of_mechanism(MoveTarget target) { return target >= MoveTarget::point_a; }

VectorX values_of(const std::vector<Parameter>& parameters) {
    VectorX p(static_cast<Eigen::Index>(parameters.size()));
    for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = parameters[static_cast<size_t>(k)].value;
    return p;
}

double from_si(double si, const Unit& unit) {
    const double guess = si / to_si(1, unit);
    if (to_si(guess, unit) == si) return guess;
    double below = guess, above = guess;
    for (int k = 0; k < 4; ++k) {
        below = std::nextafter(below, -INFINITY);
        above = std::nextafter(above, INFINITY);
        if (to_si(below, unit) == si) return below;
        if (to_si(above, unit) == si) return above;
    }
    return guess;
}

double representable(double si, const Unit& unit) { return to_si(from_si(si, unit), unit); }

}  // namespace fettle::design::description
