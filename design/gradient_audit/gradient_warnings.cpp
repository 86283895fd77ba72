// SPDX-License-Identifier: MIT
#include "design/gradient_audit/gradient_warnings.hpp"

#include <cmath>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"
#include "design/description/requirement_text.hpp"
#include "design/gradient_audit/design_line.hpp"
#include "design/gradient_audit/roughness.hpp"

namespace fettle::design::gradient_audit {

namespace {

using core::base::formatted;
using description::Constraint;
using description::Design;

constexpr double out_of_reach = 0.1;  // of a violation
constexpr double unmoved = 1e-9;      // of a value, with which rounding passes for a derivative
constexpr double small_move = 1e-3;   // of the ranges: as the noise of a quantity is measured at

double violation_of(const Constraint& constraint, double value) {
    return constraint.bounds.unit * description::violation(constraint.bounds, description::computed(value));
}

bool is_unmoved(double value, double reach) { return reach <= unmoved * std::abs(value); }

// "A joint at its stop (`slide`), ..."
std::string what_hides(const core::scene::Scene& scene) {
    std::vector<std::string> stopped;
    for (const core::scene::Joint& joint : scene.mechanism.joints)
        if (joint.forces.limits) stopped.push_back("`" + joint.name + "`");
    const std::string stop = stopped.empty() ? "" : "a joint at its stop (" + core::base::joined(stopped) + " may reach one), ";
    return "What hides such a dependence: " + stop + "a motor that gives the position, parts that do not meet";
}

// By the parameter of the steepest slope.
std::string steep_text(const Design& design, const std::string& name, const VectorX& moves, double value, double unit,
                       const std::string& unit_name) {
    Eigen::Index most = 0;
    moves.cwiseAbs().maxCoeff(&most);
    const description::Parameter& parameter = design.parameters[most];
    const double step = small_move * parameter_ranges(design)[most];
    const std::string moved = formatted("%.3g %s", description::from_si(step, parameter.unit), std::string(parameter.unit.name).c_str());
    std::string text = name + ": its gradient is too steep to be followed: as `" + parameter.name + "` moves by " + moved +
                       ", a thousandth of its range, it would change by " +
                       description::amount_text(small_move * std::abs(moves[most]), unit, unit_name, 2) + ", and its value is " +
                       description::amount_text(value, unit, unit_name, 4) +
                       ". Such a gradient holds for a much smaller move only (fettle gradient --check measures how far). What would help: ";
    const std::vector<std::string> remedies = motion_remedies(design.scene);
    for (std::size_t k = 0; k < remedies.size(); ++k) text += (k > 0 ? "; " : "") + remedies[k];
    return text;
}

}  // namespace

double gradient_reach(const Design& design, const VectorX& gradient) { return gradient.cwiseAbs().dot(parameter_ranges(design)); }

bool is_out_of_reach(const Design& design, int constraint, double value, const VectorX& gradient) {
    const double violation = violation_of(design.constraints[constraint], value);
    return violation > 0 && gradient_reach(design, gradient) <= out_of_reach * violation;
}

std::string out_of_reach_text(const Design& design, int constraint, double value, const VectorX& gradient) {
    const auto& [name, bounds, quantity] = design.constraints[constraint];
    const std::string unit = description::unit_name(design.constraints[constraint]);
    const double reach = gradient_reach(design, gradient);
    std::string text = "constraint `" + name + "`: it is " + description::amount_text(value, bounds.unit, unit) + ", required " +
                       description::required_text(bounds, unit) + ", and ";
    if (is_unmoved(value, reach))
        text += "no parameter changes it at this design, by its derivatives: a search from here has no way to meet it. ";
    else
        text += "by its derivatives at this design all parameters together change it by " +
                description::amount_text(reach, bounds.unit, unit, 2) +
                " at most over their whole ranges: a search from here is unlikely to meet it. ";
    return text + what_hides(design.scene) + ". What to do: begin at other values (--starts N), or let a parameter move what it depends on";
}

GradientWarnings gradient_warnings(const Design& design, const VectorX& values, const MatrixX& gradients) {
    FETTLE_ASSERT(values.size() == 1 + count_of(design.constraints) && gradients.rows() == values.size(), "objective and constraints");
    GradientWarnings out;
    if (design.parameters.empty()) return out;
    const VectorX ranges = parameter_ranges(design);
    std::vector<std::string> still;
    for (Eigen::Index q = 0; q < values.size(); ++q) {
        const VectorX gradient = gradients.row(q).transpose(), moves = gradient.cwiseProduct(ranges);
        const auto i = static_cast<int>(q) - 1;
        if (i >= 0 && is_out_of_reach(design, i, values[q], gradient)) {
            out.warnings.push_back(out_of_reach_text(design, i, values[q], gradient));
        } else if (is_unmoved(values[q], gradient_reach(design, gradient))) {
            still.push_back(i < 0 ? "the objective" : "constraint `" + design.constraints[i].name + "`");
        } else if (const double unit = i < 0 ? 1 : design.constraints[i].bounds.unit;
                   small_move * moves.cwiseAbs().maxCoeff() > std::max(std::abs(values[q]), unit)) {
            const std::string name = i < 0 ? "objective" : "constraint `" + design.constraints[i].name + "`";
            out.warnings.push_back(
                steep_text(design, name, moves, values[q], unit, i < 0 ? "" : description::unit_name(design.constraints[i])));
        }
    }
    if (!still.empty()) out.notes.push_back("no parameter changes " + core::base::joined(still) + " at this design, by the derivatives");
    return out;
}

}  // namespace fettle::design::gradient_audit
