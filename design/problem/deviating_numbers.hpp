// SPDX-License-Identifier: MIT
/// The numbers of a design's scene as formulas of the deviations of its tolerances, recorded on one tape: what clearances within tolerances
/// are made from (toleranced_bodies.hpp).
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/certificate/toleranced.hpp"
#include "core/expression/tape.hpp"
#include "core/geometry/range.hpp"
#include "core/scene/place.hpp"
#include "core/scene_files/scene_formulas.hpp"
#include "design/description/design.hpp"
#include "design/description/tolerance.hpp"

namespace fettle::design::problem {

using core::expression::Number;
using core::scene_files::Number3;
using NumberMatrix = std::array<Number3, 3>;  ///< rows

Number3 constant_vector(const Vector3& x);
NumberMatrix constant_matrix(const Matrix3& m);
Number3 sum(const Number3& a, const Number3& b);
Number3 difference(const Number3& a, const Number3& b);
Number3 product(const NumberMatrix& m, const Number3& x);
Number dot(const Vector3& a, const Number3& b);
Vector3 value_of(const Number3& x);
bool varies(const Number3& x);
bool varies(const std::vector<Number>& numbers);

class DeviatingNumbers {
public:
    /// @param scene  The scene of the design, at the base.
    DeviatingNumbers(const description::Design& design, const std::vector<description::Tolerance>& tolerances, const VectorX& base,
                     core::scene::Scene scene);
    DeviatingNumbers(const DeviatingNumbers&) = delete;
    DeviatingNumbers& operator=(const DeviatingNumbers&) = delete;

    const core::scene::Scene& scene() const { return scene_; }
    const std::vector<core::certificate::Deviation>& deviations() const { return deviations_; }
    const core::expression::Nodes& nodes() const { return tape_.nodes(); }

    /// The number at a pointer (core/scene/place.hpp), whose value at the base is known.
    Number number(const std::string& pointer, double value) const;
    Number3 vector(const std::string& pointer, const Vector3& value) const;

    /// What deviations move.
    struct Moved {
        core::scene::Place place;
        Number number;
    };
    const std::vector<Moved>& moved() const { return moved_; }

    /// Which tolerances these follow from: "`a` and `b` move", "`a` moves".
    std::string movers_of(const std::vector<Number>& numbers) const;
    std::string names_of(const std::vector<Number>& numbers) const;
    /// The same by their numbers.
    std::set<int> deviations_of(const std::vector<Number>& numbers) const;

    /// The node that holds a number; constants have one each.
    int node_of(const Number& x);
    core::certificate::NodePoint nodes_of(const Number3& x) { return {node_of(x[0]), node_of(x[1]), node_of(x[2])}; }

    /// Is it at most `allowed`, whatever deviates (vanishing_number.hpp)?
    bool is_none(const Number& x, double allowed) const;

private:
    std::vector<std::string> tolerances_of(const std::vector<Number>& numbers) const;

    core::scene::Scene scene_;
    core::expression::Tape tape_;
    std::vector<core::certificate::Deviation> deviations_;
    std::vector<core::geometry::Range> ranges_;
    std::map<std::string, Number> numbers_;  // by pointer
    std::vector<Moved> moved_;
    std::map<double, int> constants_;  // nodes
};

}  // namespace fettle::design::problem
