// SPDX-License-Identifier: MIT
/// A part that a file describes (core/part_files/part_file.hpp), one of the library's or of one's own, as the Shape that a design moves.
/// Its derivative is exact.
///     FilePart::create("box", {{"size_x", 0.02}, {"size_y", 0.01}})
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/part_files/part_file.hpp"
#include "design/description/shape.hpp"

namespace fettle::design::shapes {

/// What is chosen of a part besides its dimensions.
struct PartOptions {
    core::part_files::Counts counts = {};  ///< the part's own, and `segments`, of a full circle: from 8 to 720
    double chord = 0;                      ///< how far facets may be from what is round [m]; 0: as `segments` says, or the file
    int finer = 1;                         ///< so many times as many facets along what is round
};

class FilePart : public description::Shape {
public:
    /// @param part        A part of the library, a file, or the text of one (part_library.hpp).
    /// @param dimensions  By name [SI]; dimensions left out are as in the file.
    /// Errors: those of find_part; `segments` out of its range, or beside `chord` (`where`: "counts/segments"); a dimension that the part
    /// does not have (unknown_key, "part/dimension"); errors of PartFile::drawn.
    static Result<std::shared_ptr<const FilePart>> create(const std::string& part, const std::map<std::string, double>& dimensions = {},
                                                          const PartOptions& options = {});

    const core::part_files::PartFile& file() const { return file_; }
    const std::string& part() const { return part_; }        ///< as given
    const PartOptions& options() const { return options_; }  ///< as given
    const std::vector<description::ShapeDimension>& dimensions() const override { return dimensions_; }
    Result<description::ShapeInstance> at(const std::vector<double>& values) const override;
    Result<core::geometry::Mesh> mesh(const std::vector<double>& values) const override;
    Result<description::RecordedShape> recorded(const std::vector<double>& values) const override;
    Result<description::RemadeShape> remade(const std::vector<double>& values) const override;
    /// Those of the part as drawn are kept while they hold; where a plane face has to be cut into other triangles, it is.
    bool has_fixed_triangles() const override { return false; }
    bool is_always_solid() const override { return true; }  ///< what is drawn is checked

private:
    FilePart(core::part_files::PartFile file, std::string part, PartOptions options)
        : file_(std::move(file)), part_(std::move(part)), options_(std::move(options)) {}

    core::part_files::PartFile file_;
    std::string part_;
    PartOptions options_;
    core::parts::Facets facets_;
    core::parts::Structure structure_;  ///< of the part as drawn
    core::geometry::Mesh drawn_;        ///< its mesh, which is asked for at once
    std::vector<description::ShapeDimension> dimensions_;
};

}  // namespace fettle::design::shapes
