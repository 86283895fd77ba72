// SPDX-License-Identifier: MIT
#include "fettle/design/reading/scene_shapes.hpp"

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

core::scene::ReadOptions scene_read_options(const std::vector<std::string>& mesh_dirs) {
    core::scene::ReadOptions options;
    options.mesh_dirs = mesh_dirs;
    options.shape_generator = [](const core::scene::ShapeSpec& spec) -> Result<core::geometry::Mesh> {
        const auto part = generated_part(spec);
        if (!part) return part.errors();
        Result<description::ShapeInstance> drawn = description::as_drawn(**part);
        if (!drawn) return drawn.errors();
        return std::move(drawn->mesh);
    };
    return options;
}

}  // namespace fettle::design::reading
