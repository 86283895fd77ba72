// SPDX-License-Identifier: MIT
/// A generator's part (shape_generator.hpp) as the Shape that a design moves.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fettle/design/description/shape.hpp"
#include "fettle/design/shapes/shape_generator.hpp"

namespace fettle::design::shapes {

class GeneratedPart : public description::Shape {
public:
    /// @param dimensions  By name [m]; those left out take their defaults.
    /// Errors: as generate.
    static Result<std::shared_ptr<const GeneratedPart>> create(const std::string& generator,
                                                               const std::map<std::string, double>& dimensions,
                                                               const ShapeOptions& options = {});

    const std::string& generator() const { return generator_; }
    const ShapeOptions& options() const { return options_; }
    const std::vector<description::ShapeDimension>& dimensions() const override { return dimensions_; }
    Result<description::ShapeInstance> at(const std::vector<double>& values) const override;
    bool is_always_solid() const override { return true; }

private:
    GeneratedPart() = default;

    std::string generator_;
    ShapeOptions options_;
    std::vector<description::ShapeDimension> dimensions_;  ///< in the order of generator_table()
};

}  // namespace fettle::design::shapes
