// SPDX-License-Identifier: MIT
#include "fettle/design/reading/scene_shapes.hpp"

#include "fettle/design/shapes/generated_part.hpp"
#include "fettle/design/shapes/mesh_program.hpp"

namespace fettle::design::reading {

namespace {

using MadeShape = Result<std::shared_ptr<const description::Shape>>;

template <class Part>
MadeShape as_shape(const Result<std::shared_ptr<const Part>>& part) {
    if (!part) return part.errors();
    return std::shared_ptr<const description::Shape>(*part);
}

MadeShape shape_of_spec(const core::scene::ShapeSpec& spec, Programs programs) {
    if (!spec.program) {
        shapes::ShapeOptions options;
        for (const auto& [name, value] : spec.counts) {
            if (name != "segments")
                return Error{ErrorCode::unknown_key, "counts/" + name, "unknown count \"" + name + "\"; the only one is \"segments\""};
            options.segments = value;
        }
        return as_shape(shapes::GeneratedPart::create(spec.generator, spec.dimensions, options));
    }
    if (programs == Programs::refused) {
        const std::string name = spec.program->command.empty() ? "" : spec.program->command.front();
        return Error{ErrorCode::unsupported, "program",
                     "this part is made by running `" + name + "`; programs run only where they are allowed: --allow-programs"};
    }
    std::vector<description::ShapeDimension> dimensions;
    for (const auto& [name, value] : spec.dimensions) dimensions.push_back({name, value});
    return as_shape(shapes::ProgramPart::create(*spec.program, std::move(dimensions)));
}

}  // namespace

core::scene::ReadOptions scene_read_options(const std::vector<std::string>& mesh_dirs, Programs programs,
                                            const std::shared_ptr<std::vector<MadePart>>& made) {
    core::scene::ReadOptions options;
    options.mesh_dirs = mesh_dirs;
    options.shape_generator = [programs, made](const core::scene::ShapeSpec& spec) -> Result<core::geometry::Mesh> {
        for (const MadePart& part : *made)
            if (part.spec == spec) return part.mesh;
        const auto shape = shape_of_spec(spec, programs);
        if (!shape) return shape.errors();
        Result<core::geometry::Mesh> mesh = description::drawn_mesh(**shape);
        if (mesh) made->push_back({spec, *shape, *mesh});
        return mesh;
    };
    return options;
}

}  // namespace fettle::design::reading
