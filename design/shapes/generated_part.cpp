// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/generated_part.hpp"

#include "fettle/core/base/contract.hpp"

namespace fettle::design::shapes {

Result<std::shared_ptr<const GeneratedPart>> GeneratedPart::create(const std::string& generator,
                                                                   const std::map<std::string, double>& dimensions,
                                                                   const ShapeOptions& options) {
    const Result<GeneratedShape> shape = generate(generator, dimensions, options);
    if (!shape) return shape.errors();
    const std::shared_ptr<GeneratedPart> part(new GeneratedPart);
    part->generator_ = generator;
    part->options_ = options;
    for (const GeneratorInfo& info : generator_table()) {
        if (info.name != generator) continue;
        for (const DimensionInfo& dimension : info.dimensions) {
            const auto given = dimensions.find(dimension.name);
            part->dimensions_.push_back({dimension.name, given == dimensions.end() ? dimension.default_value : given->second});
        }
    }
    return std::shared_ptr<const GeneratedPart>(part);
}

Result<description::ShapeInstance> GeneratedPart::at(const std::vector<double>& values) const {
    FETTLE_ASSERT(values.size() == dimensions_.size(), "one value for each dimension");
    std::map<std::string, double> given;
    for (size_t k = 0; k < values.size(); ++k) given[dimensions_[k].name] = values[k];
    Result<GeneratedShape> shape = generate(generator_, given, options_);
    if (!shape) return shape.errors();
    return description::ShapeInstance{std::move(shape->mesh), std::move(shape->jacobian)};
}

}  // namespace fettle::design::shapes
