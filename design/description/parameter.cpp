// SPDX-License-Identifier: MIT
#include "design/description/parameter.hpp"

#include <cmath>
#include <cstdio>

namespace fettle::design::description {

std::vector<std::string> names_of(const std::vector<Parameter>& parameters) {
    std::vector<std::string> names;
    for (const Parameter& parameter : parameters) names.push_back(parameter.name);
    return names;
}

core::expression::Scope scope_of(const std::vector<Parameter>& parameters) {
    core::expression::Scope scope;
    scope.what = "parameter";
    for (const Parameter& parameter : parameters)
        scope.names.push_back({parameter.name, core::expression::powers_of(parameter.unit.dimension)});
    return scope;
}

VectorX values_of(const std::vector<Parameter>& parameters) {
    VectorX p(parameters.size());
    for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = parameters[k].value;
    return p;
}

VectorX references_of(const std::vector<Parameter>& parameters) {
    VectorX p(parameters.size());
    for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = parameters[k].reference.value_or(parameters[k].value);
    return p;
}

Errors at_reference(Errors errors) {
    for (Error& error : errors)
        if (error.code == ErrorCode::mesh_invalid || error.code == ErrorCode::out_of_range)
            error.message = "at the parameters' `reference` values: " + error.message + "; leave these out, and `value` takes their place";
    return errors;
}

namespace {

std::string told(double si, const Unit& unit) {
    char text[40];
    std::snprintf(text, sizeof text, "%g", from_si(si, unit));
    return text + (unit.name.empty() ? "" : " " + std::string(unit.name));
}

}  // namespace

Errors check_values(const std::vector<Parameter>& parameters, const VectorX& p) {
    if (p.size() != static_cast<Eigen::Index>(parameters.size()))
        return {{ErrorCode::inconsistent, "p",
                 "one value for each of the design's parameters is expected: " + std::to_string(parameters.size()) + ", found " +
                     std::to_string(p.size())}};
    Errors errors;
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        const Parameter& of = parameters[k];
        const double range = of.upper - of.lower;
        if (!std::isfinite(p[k])) {
            errors.push_back({ErrorCode::not_finite, "p/" + of.name, "it is not a finite number"});
        } else if (p[k] < of.lower - range || p[k] > of.upper + range) {
            errors.push_back({ErrorCode::out_of_range, "p/" + of.name,
                              told(p[k], of.unit) + " is far outside its bounds, " + told(of.lower, of.unit) + " to " +
                                  told(of.upper, of.unit) +
                                  ": farther than they are apart. Is it in SI units (m, rad, kg)? If it is meant, " + "widen the bounds"});
        }
    }
    return errors;
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
