// SPDX-License-Identifier: MIT
/// A part that a file describes (core/part_files/part_file.hpp) as the Shape that a design moves. Its derivative is exact.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fettle/core/part_files/part_file.hpp"
#include "fettle/design/description/shape.hpp"

namespace fettle::design::shapes {

class FilePart : public description::Shape {
public:
    /// @param dimensions  By name [SI]; those left out are as in the file.
    /// Errors: a dimension that the part does not have (unknown_key, `where`: "part/dimension"), and those of PartFile::drawn.
    static Result<std::shared_ptr<const FilePart>> create(core::part_files::PartFile file, const std::map<std::string, double>& dimensions,
                                                          const core::parts::Facets& facets = {});

    const core::part_files::PartFile& file() const { return file_; }
    const std::vector<description::ShapeDimension>& dimensions() const override { return dimensions_; }
    Result<description::ShapeInstance> at(const std::vector<double>& values) const override;
    Result<core::geometry::Mesh> mesh(const std::vector<double>& values) const override;
    /// Those of the part as drawn are kept while they hold; where a plane face has to be cut into other triangles, it is.
    bool has_fixed_triangles() const override { return false; }
    bool is_always_solid() const override { return true; }  ///< what is drawn is checked

private:
    explicit FilePart(core::part_files::PartFile file) : file_(std::move(file)) {}

    core::part_files::PartFile file_;
    core::parts::Facets facets_;
    core::parts::Structure structure_;  ///< of the part as drawn
    std::vector<description::ShapeDimension> dimensions_;
};

}  // namespace fettle::design::shapes
