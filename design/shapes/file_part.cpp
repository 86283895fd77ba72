// SPDX-License-Identifier: MIT
#include "design/shapes/file_part.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "core/files/nearest_word.hpp"
#include "design/shapes/part_library.hpp"

namespace fettle::design::shapes {

using core::part_files::PartDimension;
using core::part_files::PartFile;
using core::parts::DrawnPart;
using core::parts::Facets;

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

constexpr const char* segments_name = "segments";  // how facets are cut is said with the counts

std::optional<Error> segments_fault(const PartOptions& options) {
    using core::part_files::fewest_circle_segments, core::part_files::most_circle_segments;
    const std::string where = std::string("counts/") + segments_name;
    const auto segments = options.counts.find(segments_name);
    if (segments == options.counts.end()) return std::nullopt;
    if (segments->second < fewest_circle_segments || segments->second > most_circle_segments)
        return Error{ErrorCode::out_of_range, where,
                     "segments is " + std::to_string(segments->second) + "; allowed: from " + std::to_string(fewest_circle_segments) +
                         " to " + std::to_string(most_circle_segments)};
    if (options.chord > 0)
        return Error{ErrorCode::inconsistent, where, "`facets` says how far facets may be from what is round; `segments` goes without it"};
    return std::nullopt;
}

Facets facets_of(const PartFile& file, const PartOptions& options) {
    Facets facets = file.facets();
    const auto segments = options.counts.find(segments_name);
    if (segments != options.counts.end()) {
        facets.segments = segments->second;
        facets.chord = 0;
    }
    if (options.chord > 0) facets.chord = options.chord;
    facets.segments *= options.finer;
    facets.chord /= options.finer * options.finer;  // an arc's sagitta goes with the square of its angle
    return facets;
}

}  // namespace

Result<std::shared_ptr<const FilePart>> FilePart::create(const std::string& part, const std::map<std::string, double>& dimensions,
                                                         const PartOptions& options) {
    if (auto fault = segments_fault(options)) return std::move(*fault);
    core::part_files::Counts counts = options.counts;
    counts.erase(segments_name);
    Result<PartFile> file = find_part(part, counts);
    if (!file) return file.errors();
    const Errors errors = unknown_dimensions(*file, dimensions);
    if (!errors.empty()) return errors;
    const std::shared_ptr<FilePart> made(new FilePart(std::move(*file), part, options));
    made->facets_ = facets_of(made->file_, options);
    std::vector<double> values;
    for (const PartDimension& dimension : made->file_.dimensions()) {
        const auto given = dimensions.find(dimension.name);
        values.push_back(given == dimensions.end() ? dimension.value : given->second);
        made->dimensions_.push_back({dimension.name, values.back()});
    }
    Result<DrawnPart> drawn = made->file_.drawn(values, made->facets_, {}, {.jacobian = false});
    if (!drawn) return drawn.errors();
    made->structure_ = std::move(drawn->structure);
    made->drawn_ = std::move(drawn->mesh);
    made->drawn_.deviation = drawn->deviation;
    return std::shared_ptr<const FilePart>(made);
}

Result<description::ShapeInstance> FilePart::at(const std::vector<double>& values) const {
    Result<DrawnPart> drawn = file_.drawn(values, facets_, structure_);
    if (!drawn) return drawn.errors();
    drawn->mesh.deviation = drawn->deviation;
    return description::ShapeInstance{std::move(drawn->mesh), std::move(drawn->jacobian)};
}

Result<description::RecordedShape> FilePart::recorded(const std::vector<double>& values) const {
    Result<DrawnPart> drawn = file_.drawn(values, facets_, structure_, {.jacobian = false, .record = true, .check = false});
    if (!drawn) return drawn.errors();
    return description::RecordedShape{std::move(drawn->recorded.nodes), std::move(drawn->recorded.vertices)};
}

Result<description::RemadeShape> FilePart::remade(const std::vector<double>& values) const {
    Result<DrawnPart> drawn = file_.drawn(values, facets_, structure_, {.jacobian = false, .compare_counts = true});
    if (!drawn) return drawn.errors();
    return description::RemadeShape{std::move(drawn->mesh), std::move(drawn->other_counts)};
}

Result<core::geometry::Mesh> FilePart::mesh(const std::vector<double>& values) const {
    if (values == description::drawn_values(*this)) return drawn_;
    Result<DrawnPart> drawn = file_.drawn(values, facets_, structure_, {.jacobian = false});
    if (!drawn) return drawn.errors();
    drawn->mesh.deviation = drawn->deviation;
    return std::move(drawn->mesh);
}

}  // namespace fettle::design::shapes
