// SPDX-License-Identifier: MIT
/// One drawing of a part at given dimensions: the tape, how curves become polygons, and the decisions that make the connectivity. A part is
/// a function that draws:
///     Result<Solid> washer(Drawing& drawing, const Number& bore, const Number& wall, const Number& height) {
///         const Result<Profile> ring = with_hole(*filled(circle({}, bore + wall, "rim")), circle({}, bore, "bore"));
///         return ring ? extruded(drawing, *ring, 0, height) : Result<Solid>(ring.errors());
///     }
///     Drawing drawing;
///     const Number bore = drawing.dimension(5e-3), wall = drawing.dimension(2e-3), height = drawing.dimension(1e-3);
///     const Result<DrawnPart> part = drawn(drawing, *washer(drawing, bore, wall, height), "washer");
/// A later trial hands in the structure of an earlier one: what still holds of it is kept, so that vertices and triangles correspond.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/expression/tape.hpp"
#include "core/parts/facets.hpp"

namespace fettle::core::parts {

using expression::Number;

/// What was decided while a part was drawn, in order: numbers of segments, triangulations of caps, how solids cut each other. Plain data.
struct Decision {
    std::string what;  ///< "segments of `rim`", "cap of `plate`"; unique with its place in the order
    std::vector<int> numbers;
};
struct Structure {
    std::vector<Decision> decisions;
};

class Drawing {
public:
    explicit Drawing(const Facets& facets = {}, Structure kept = {}, bool compares_counts = false);
    Drawing(const Drawing&) = delete;  // numbers point to the tape
    Drawing& operator=(const Drawing&) = delete;

    /// The next dimension; derivatives are with respect to these, in their order.
    Number dimension(double value) {
        dimensions_.push_back(value);
        return tape_.input(value);
    }
    int dimension_count() const { return tape_.input_count(); }
    const std::vector<double>& dimensions() const { return dimensions_; }
    expression::Tape& tape() { return tape_; }
    const expression::Tape& tape() const { return tape_; }

    /// The facets of all that is drawn from here on and has none of its own. What is cut away is drawn with `opposite` lean.
    Facets facets;

    /// What something is made of, without a choice: a change if it was kept and is another.
    void note(const std::string& what, const std::vector<int>& numbers) {
        decision(
            what, [&](const std::vector<int>& before) { return before == numbers; }, [&] { return numbers; });
    }

    /// For operations that decide: the kept decision, if there is one for this and it `holds`; else what `decide` returns, which is noted
    /// as a change if something else was kept.
    std::vector<int> decision(const std::string& what, const std::function<bool(const std::vector<int>&)>& holds,
                              const std::function<std::vector<int>()>& decide);

    /// The number of facets that something is made of: as many as were kept, whatever the dimensions have become since, else what `choose`
    /// returns. Where counts are compared, a choice that is another than what was kept is told: other_counts().
    int count(const std::string& what, const std::function<int()>& choose);

    const Structure& structure() const { return made_; }
    const Structure& kept() const { return kept_; }
    /// A sentence for each thing that could not be kept: the triangles are not those of the drawing whose structure was handed in. Empty
    /// where none was.
    const std::vector<std::string>& changes() const { return changes_; }
    /// Kept counts of facets that a drawing without a structure would choose otherwise: "segments of `ball`: 21, not 20". Empty where they
    /// are not compared.
    const std::vector<std::string>& other_counts() const { return other_counts_; }

private:
    const Decision* kept_decision(const std::string& what) const;

    expression::Tape tape_;
    std::vector<double> dimensions_;
    Structure kept_, made_;
    bool compares_counts_;
    std::vector<std::string> changes_, other_counts_;
};

}  // namespace fettle::core::parts
