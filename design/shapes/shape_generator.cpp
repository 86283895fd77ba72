// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/shape_generator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "fettle/core/files/nearest_word.hpp"
#include "fettle/design/shapes/cam_parts.hpp"
#include "fettle/design/shapes/engine_parts.hpp"
#include "fettle/design/shapes/linkage_parts.hpp"
#include "fettle/design/shapes/simple_shapes.hpp"

namespace fettle::design::shapes {
namespace {

std::vector<ShapeDefinition> definitions() {
    return {crank_definition(), rod_definition(),     piston_definition(),          block_definition(),
            box_definition(),   pin_definition(),     plate_with_hole_definition(), base_plate_definition(),
            arm_definition(),   coupler_definition(), eccentric_definition(),       follower_definition()};
}

std::string in_millimetres(double metres) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g mm", metres * 1e3);
    return text;
}

void check_names(const GeneratorInfo& info, const std::map<std::string, double>& given, Errors& errors) {
    std::vector<std::string_view> known;
    for (const auto& dimension : info.dimensions) known.push_back(dimension.name);
    for (const auto& [name, value] : given) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        errors.push_back({ErrorCode::unknown_key, info.name + "/" + name,
                          "generator '" + info.name + "' has no dimension '" + name + "'; " + core::files::did_you_mean(name, known)});
    }
}

Dimensions read_dimensions(const GeneratorInfo& info, const std::map<std::string, double>& given, Errors& errors) {
    Dimensions dimensions;
    const int count = count_of(info.dimensions);
    for (int k = 0; k < count; ++k) {
        const DimensionInfo& dimension = info.dimensions[k];
        const auto found = given.find(dimension.name);
        const double value = found == given.end() ? dimension.default_value : found->second;
        const std::string where = info.name + "/" + dimension.name;
        if (!std::isfinite(value)) {
            errors.push_back({ErrorCode::not_finite, where, dimension.name + " is not a finite number; give a length"});
        } else if (dimension.kind == DimensionKind::length && value <= 0) {
            errors.push_back({ErrorCode::out_of_range, where, dimension.name + " is " + in_millimetres(value) + "; allowed: above 0 mm"});
        }
        dimensions[dimension.name] = DimensionDual::variable(value, k, count);
    }
    return dimensions;
}

void check_relations(const ShapeDefinition& definition, const Dimensions& dimensions, int segments, Errors& errors) {
    for (const Relation& relation : definition.relations(dimensions, segments)) {
        if (relation.value < relation.limit) continue;
        errors.push_back({ErrorCode::out_of_range, definition.info.name + "/" + relation.dimension,
                          relation.dimension + " is " + in_millimetres(relation.value) + "; allowed: below " +
                              in_millimetres(relation.limit) + " (" + relation.reason + ")"});
    }
}

GeneratedShape shape_of(const GeneratorInfo& info, const ShapeBuilder& builder) {
    const auto count = static_cast<Eigen::Index>(builder.vertices().size());
    GeneratedShape shape;
    Matrix3X vertices(3, count);
    for (const auto& dimension : info.dimensions) {
        shape.dimensions.push_back(dimension.name);
        shape.jacobian.emplace_back(Matrix3X::Zero(3, count));
    }
    for (Eigen::Index i = 0; i < count; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const DimensionDual& x = builder.vertices()[i][axis];
            vertices(axis, i) = x.value;
            for (std::size_t k = 0; k < shape.jacobian.size(); ++k) shape.jacobian[k](axis, i) = x.derivative(static_cast<int>(k));
        }
    }
    shape.mesh = core::geometry::make_mesh(info.name, std::move(vertices), builder.triangles());
    return shape;
}

Result<ShapeDefinition> find_definition(const std::string& generator) {
    const std::vector<ShapeDefinition> all = definitions();
    std::vector<std::string_view> known;
    for (const ShapeDefinition& definition : all) {
        if (definition.info.name == generator) return definition;
        known.push_back(definition.info.name);
    }
    return Error{ErrorCode::unknown_key, generator,
                 "there is no generator '" + generator + "'; " + core::files::did_you_mean(generator, known)};
}

}  // namespace

std::vector<GeneratorInfo> generator_table() {
    std::vector<GeneratorInfo> table;
    for (const ShapeDefinition& definition : definitions()) table.push_back(definition.info);
    return table;
}

std::vector<DimensionLimit> dimension_limits(const std::string& generator, const ShapeOptions& options) {
    const Result<ShapeDefinition> definition = find_definition(generator);
    std::vector<DimensionLimit> limits;
    if (!definition) return limits;
    Errors none;
    const Dimensions values = read_dimensions(definition->info, {}, none);
    for (const Relation& relation : definition->relations(values, options.segments))
        limits.push_back({relation.dimension, relation.value, relation.limit, relation.reason});
    return limits;
}

Result<GeneratedShape> generate(const std::string& generator, const std::map<std::string, double>& dimensions,
                                const ShapeOptions& options) {
    const Result<ShapeDefinition> definition = find_definition(generator);
    if (!definition) return definition.errors();
    Errors errors;
    if (options.segments < 8 || options.segments > 720 || options.segments % 4 != 0) {
        errors.push_back({ErrorCode::out_of_range, generator + "/segments",
                          "segments is " + std::to_string(options.segments) + "; allowed: a multiple of 4 from 8 to 720"});
    }
    check_names(definition->info, dimensions, errors);
    const Dimensions values = read_dimensions(definition->info, dimensions, errors);
    if (errors.empty()) check_relations(*definition, values, options.segments, errors);
    if (!errors.empty()) return errors;

    ShapeBuilder builder(options.segments);
    definition->build(values, builder);
    return shape_of(definition->info, builder);
}

}  // namespace fettle::design::shapes
