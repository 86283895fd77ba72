// SPDX-License-Identifier: MIT
#include "fettle/design/reading/scene_shapes.hpp"

#include "fettle/design/shapes/mesh_program.hpp"

namespace fettle::design::reading {

Result<std::shared_ptr<const shapes::GeneratedPart>> generated_part(const core::scene::ShapeSpec& spec) {
    shapes::ShapeOptions options;
    for (const auto& [name, value] : spec.counts) {
        if (name != "segments") {
            return Error{ErrorCode::unknown_key, "counts/" + name, "unknown count \"" + name + "\"; the only one is \"segments\""};
        }
        options.segments = value;
    }
    return shapes::GeneratedPart::create(spec.generator, spec.dimensions, options);
}

Result<std::shared_ptr<const description::Shape>> shape_of_spec(const core::scene::ShapeSpec& spec, Programs programs) {
    if (!spec.program) {
        const auto part = generated_part(spec);
        if (!part) return part.errors();
        return std::shared_ptr<const description::Shape>(*part);
    }
    if (programs == Programs::refused) {
        const std::string name = spec.program->command.empty() ? "" : spec.program->command.front();
        return Error{ErrorCode::unsupported, "program",
                     "this part is made by running `" + name + "`; programs run only where they are allowed: --allow-programs"};
    }
    std::vector<description::ShapeDimension> dimensions;
    for (const auto& [name, value] : spec.dimensions) dimensions.push_back({name, value});
    const auto part = shapes::ProgramPart::create(*spec.program, std::move(dimensions));
    if (!part) return part.errors();
    return std::shared_ptr<const description::Shape>(*part);
}

core::scene::ReadOptions scene_read_options(const std::vector<std::string>& mesh_dirs, Programs programs) {
    core::scene::ReadOptions options;
    options.mesh_dirs = mesh_dirs;
    options.shape_generator = [programs](const core::scene::ShapeSpec& spec) -> Result<core::geometry::Mesh> {
        const auto part = shape_of_spec(spec, programs);
        if (!part) return part.errors();
        return description::drawn_mesh(**part);
    };
    return options;
}

}  // namespace fettle::design::reading
