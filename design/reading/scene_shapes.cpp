// SPDX-License-Identifier: MIT
#include "design/reading/scene_shapes.hpp"

#include <map>
#include <optional>
#include <string>

#include "design/shapes/file_part.hpp"
#include "design/shapes/handled_part.hpp"
#include "design/shapes/mesh_program.hpp"
#include "design/shapes/part_library.hpp"

namespace fettle::design::reading {

namespace {

using MadeShape = Result<std::shared_ptr<const description::Shape>>;

template <class Part>
MadeShape as_shape(const Result<std::shared_ptr<const Part>>& part) {
    if (!part) return part.errors();
    return std::shared_ptr<const description::Shape>(*part);
}

Result<std::map<std::string, core::base::Dimension>> dimensions_of_part(const core::scene::ShapeSpec& spec) {
    if (spec.handled) return shapes::dimensions_of_handles(*spec.handled);
    core::part_files::Counts counts = spec.counts;
    counts.erase("segments");
    const auto file = shapes::find_part(spec.part, counts);
    if (!file) return file.errors();
    std::map<std::string, core::base::Dimension> out;
    for (const core::part_files::PartDimension& dimension : file->dimensions())
        out[dimension.name] = core::part_files::dimension_of(dimension.kind);
    return out;
}

MadeShape shape_of_spec(const core::scene::ShapeSpec& spec, Programs programs, int finer_facets) {
    if (spec.handled) return as_shape(shapes::HandledPart::create(*spec.handled, spec.dimensions));
    if (!spec.program) return as_shape(shapes::FilePart::create(spec.part, spec.dimensions, {spec.counts, spec.chord, finer_facets}));
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
                                            const std::shared_ptr<std::vector<MadePart>>& made, int finer_facets) {
    core::scene::ReadOptions options;
    options.mesh_dirs = mesh_dirs;
    options.part_dimensions = dimensions_of_part;
    options.shape_maker = [programs, made, finer_facets](const core::scene::ShapeSpec& spec) -> Result<core::geometry::Mesh> {
        for (const MadePart& part : *made) {
            if (!(part.spec == spec)) continue;
            core::base::ReadRecord::tell(part.files);
            return part.mesh;
        }
        const core::base::ReadRecord record;
        const auto shape = shape_of_spec(spec, programs, finer_facets);
        if (!shape) return shape.errors();
        Result<core::geometry::Mesh> mesh = description::drawn_mesh(**shape);
        if (mesh) made->push_back({spec, *shape, *mesh, record.files()});
        return mesh;
    };
    return options;
}

}  // namespace fettle::design::reading
