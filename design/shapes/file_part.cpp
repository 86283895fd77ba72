// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/file_part.hpp"

#include <algorithm>
#include <string_view>

#include "fettle/core/files/nearest_word.hpp"

namespace fettle::design::shapes {

using core::part_files::PartDimension;
using core::part_files::PartFile;
using core::parts::DrawnPart;

namespace {

Errors unknown_dimensions(const PartFile& file, const std::map<std::string, double>& given) {
    Errors errors;
    std::vector<std::string_view> known;
    for (const PartDimension& dimension : file.dimensions()) known.emplace_back(dimension.name);
    for (const auto& [name, value] : given) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        errors.push_back({ErrorCode::unknown_key, file.name() + "/" + name,
                          "part '" + file.name() + "' has no dimension '" + name + "'; " + core::files::did_you_mean(name, known)});
    }
    return errors;
}

}  // namespace

Result<std::shared_ptr<const FilePart>> FilePart::create(PartFile file, const std::map<std::string, double>& dimensions,
                                                         const core::parts::Facets& facets) {
    const Errors errors = unknown_dimensions(file, dimensions);
    if (!errors.empty()) return errors;
    const std::shared_ptr<FilePart> part(new FilePart(std::move(file)));
    part->facets_ = facets;
    std::vector<double> values;
    for (const PartDimension& dimension : part->file_.dimensions()) {
        const auto given = dimensions.find(dimension.name);
        values.push_back(given == dimensions.end() ? dimension.value : given->second);
        part->dimensions_.push_back({dimension.name, values.back()});
    }
    Result<DrawnPart> drawn = part->file_.drawn(values, facets, {}, {.jacobian = false});
    if (!drawn) return drawn.errors();
    part->structure_ = std::move(drawn->structure);
    return std::shared_ptr<const FilePart>(part);
}

Result<description::ShapeInstance> FilePart::at(const std::vector<double>& values) const {
    Result<DrawnPart> drawn = file_.drawn(values, facets_, structure_);
    if (!drawn) return drawn.errors();
    drawn->mesh.deviation = drawn->deviation;
    return description::ShapeInstance{std::move(drawn->mesh), std::move(drawn->jacobian)};
}

Result<core::geometry::Mesh> FilePart::mesh(const std::vector<double>& values) const {
    Result<DrawnPart> drawn = file_.drawn(values, facets_, structure_, {.jacobian = false});
    if (!drawn) return drawn.errors();
    drawn->mesh.deviation = drawn->deviation;
    return std::move(drawn->mesh);
}

}  // namespace fettle::design::shapes
