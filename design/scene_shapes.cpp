// SPDX-License-Identifier: MIT
#include "fettle/design/scene_shapes.hpp"

namespace fettle::design {

Result<shapes::GeneratedShape> generate_shape(const core::scene::ShapeSpec& spec) {
    shapes::ShapeOptions options;
    for (const auto& [name, value] : spec.counts) {
        if (name != "segments") {
            return Error{ErrorCode::unknown_key, "counts/" + name, "unknown count \"" + name + "\"; the only one is \"segments\""};
        }
        options.segments = value;
    }
    return shapes::generate(spec.generator, spec.dimensions, options);
}

core::scene::ReadOptions scene_read_options(const std::vector<std::string>& mesh_dirs) {
    core::scene::ReadOptions options;
    options.mesh_dirs = mesh_dirs;
    options.shape_generator = [](const core::scene::ShapeSpec& spec) -> Result<core::geometry::Mesh> {
        Result<shapes::GeneratedShape> shape = generate_shape(spec);
        if (!shape) return shape.errors();
        return std::move(shape->mesh);
    };
    return options;
}

}  // namespace fettle::design
