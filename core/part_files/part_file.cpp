// SPDX-License-Identifier: MIT
#include "core/part_files/part_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_keys.hpp"
#include "core/files/nearest_word.hpp"
#include "core/part_files/facet_bound.hpp"

namespace fettle::core::part_files {

using base::ErrorCode;
using files::JsonDocument;
using files::JsonNode;

struct PartFile::Contents {
    std::string name, about;
    std::vector<PartDimension> dimensions;
    std::vector<PartCount> counts;
    std::vector<PartRelation> relations;
    parts::Facets facets;
    PartNumbers numbers{1e-3};
    SolidMaker solid;
    FacetBound facet_bound;
    std::shared_ptr<const std::map<std::string, ProfileMaker>> profiles;
    std::vector<std::shared_ptr<const void>> named;  // what `solid` points to
};

namespace {

constexpr int format_version = 1;

// Keys in the order in which they were written, which is the designer's; the tree of a document sorts them.
std::vector<std::string> keys_as_written(const std::string& text, const char* object) {
    std::vector<std::string> out;
    const auto tree = nlohmann::ordered_json::parse(text, nullptr, false);
    if (!tree.is_object() || !tree.contains(object) || !tree[object].is_object()) return out;
    for (const auto& [key, value] : tree[object].items())
        if (!key.starts_with('#')) out.push_back(key);
    return out;
}

std::string name_of_file(const std::string& path) {
    std::string name = std::filesystem::path(path).filename().string();
    if (name.ends_with(part_file_ending)) name.resize(name.size() - part_file_ending.size());
    return name;
}

PartDimensionKind kind_named(const std::string& name) {
    for (const auto kind : {PartDimensionKind::coordinate, PartDimensionKind::angle, PartDimensionKind::number})
        if (name == name_of(kind)) return kind;
    return PartDimensionKind::length;
}

bool is_new_name(const JsonNode& node, const std::string& name, const PartNumbers& numbers) {
    if (!expression::is_possible_name(name))
        node.fail(ErrorCode::out_of_range, "a name is not empty and has no single quote in it");
    else if (numbers.scope().find(name) != nullptr)
        node.fail(ErrorCode::inconsistent, "another dimension or count is called `" + name + "` already");
    else
        return true;
    return false;
}

// {"value": 5, "about": "..."}, or the value alone.
JsonNode value_in(const JsonNode& node, const std::vector<std::string_view>& keys) {
    if (!node.is_object()) return node;
    node.allow_keys(keys);
    return node.require("value");
}

PartDimension read_dimension(const std::string& name, const JsonNode& node, PartNumbers& numbers) {
    const JsonNode value = value_in(node, {"value", "about", "kind"});
    PartDimension out;
    out.name = name;
    if (node.is_object()) {
        out.about = node["about"].string().value_or("");
        out.kind = kind_named(node["kind"].choice({"length", "coordinate", "angle", "number"}).value_or("length"));
    }
    const base::Dimension dimension = dimension_of(out.kind);
    const files::NumberRange range = out.kind == PartDimensionKind::length ? files::positive : files::any_number;
    out.value = value.quantity(dimension, numbers.scope().plain_unit(dimension), range).value_or(1);
    if (is_new_name(node, name, numbers)) numbers.add_dimension(name, dimension);
    return out;
}

PartCount read_count(const std::string& name, const JsonNode& node, const Counts& given, PartNumbers& numbers) {
    const JsonNode value = value_in(node, {"value", "about", "least", "most"});
    PartCount out;
    out.name = name;
    if (node.is_object()) {
        out.about = node["about"].string().value_or("");
        out.least = node["least"].integer(0, base::most_copies).value_or(0);
        out.most = node["most"].integer(out.least, base::most_copies).value_or(base::most_copies);
    }
    out.value = value.integer(out.least, out.most).value_or(out.least);
    const auto other = given.find(name);
    if (other != given.end()) out.value = other->second;
    if (is_new_name(node, name, numbers)) numbers.add_count(name, out.value);
    return out;
}

parts::Facets read_facets(const JsonNode& node, const PartNumbers& numbers) {
    parts::Facets out;
    node.allow_keys({"segments", "chord", "lean"});
    if (node["segments"].exists() && node["chord"].exists())
        node["segments"].fail(ErrorCode::inconsistent, "`chord` says how far facets may be from what is round; `segments` goes without it");
    out.segments = node["segments"].integer(fewest_circle_segments, most_circle_segments).value_or(out.segments);
    out.chord = node["chord"].length(numbers.length_unit(), files::positive).value_or(0);
    const std::string lean = node["lean"].choice({"cover", "within", "through"}).value_or("cover");
    out.lean = lean == "within" ? parts::Lean::within : lean == "through" ? parts::Lean::through : parts::Lean::cover;
    return out;
}

Errors count_faults(const Counts& given, const std::vector<PartCount>& counts, const std::string& part) {
    Errors errors;
    std::vector<std::string_view> known;
    for (const PartCount& count : counts) known.emplace_back(count.name);
    for (const auto& [name, value] : given) {
        const auto found = std::find_if(counts.begin(), counts.end(), [&, &n = name](const PartCount& count) { return count.name == n; });
        if (found == counts.end()) {
            errors.push_back({ErrorCode::unknown_key, "counts/" + name,
                              "part `" + part + "` has no count `" + name + "`; " + files::did_you_mean(name, known, '`')});
        } else if (value < found->least || value > found->most) {
            errors.push_back({ErrorCode::out_of_range, "counts/" + name,
                              name + " is " + std::to_string(value) + "; allowed: from " + std::to_string(found->least) + " to " +
                                  std::to_string(found->most)});
        }
    }
    return errors;
}

}  // namespace

const char* name_of(PartDimensionKind kind) {
    constexpr const char* names[] = {"length", "coordinate", "angle", "number"};
    return names[static_cast<int>(kind)];
}

base::Dimension dimension_of(PartDimensionKind kind) {
    if (kind == PartDimensionKind::angle) return base::Dimension::angle;
    return kind == PartDimensionKind::number ? base::Dimension::number : base::Dimension::length;
}

Result<PartFile> PartFile::read(const std::string& path, const Counts& counts) {
    const Result<std::string> text = files::read_file(path);
    return text ? parse(*text, path, counts) : Result<PartFile>(text.errors());
}

Result<PartFile> PartFile::parse(const std::string& text, const std::string& name, const Counts& counts) {
    Result<JsonDocument> document = JsonDocument::parse(text, name);
    if (!document) return document.errors();
    const JsonNode root = document->root();
    if (!files::is_format(root, "fettle_part", "part", format_version)) return document->errors();
    root.allow_keys({"$schema", "fettle_part", "about", "units", "facets", "dimensions", "counts", "variables", "relations", "profiles",
                     "solids", "solid"});
    const auto unit = root["units"].choice({"um", "mm", "cm", "m", "in", "ft"});

    auto contents = std::make_shared<Contents>();
    contents->name = name_of_file(name);
    contents->about = root["about"].string().value_or("");
    contents->numbers = PartNumbers(base::metres_per_unit(unit.value_or("mm")).value());
    PartNumbers& numbers = contents->numbers;
    if (root["dimensions"].exists() && !root["dimensions"].is_object()) (void)root["dimensions"].members();
    for (const std::string& key : keys_as_written(text, "dimensions"))
        contents->dimensions.push_back(read_dimension(key, root["dimensions"][key], numbers));
    if (root["counts"].exists() && !root["counts"].is_object()) (void)root["counts"].members();
    for (const std::string& key : keys_as_written(text, "counts"))
        contents->counts.push_back(read_count(key, root["counts"][key], counts, numbers));
    root.require("dimensions");
    contents->facets = read_facets(root["facets"], numbers);
    Errors errors = count_faults(counts, contents->counts, contents->name);
    if (!errors.empty()) return errors;
    numbers.add_variables(root["variables"]);
    for (const JsonNode& relation : root["relations"].objects())
        if (auto read = read_relation(relation, numbers)) contents->relations.push_back(std::move(*read));

    ProfileReader profiles(numbers, root["profiles"]);
    profiles.read_named();
    SolidReader solids(numbers, profiles, root["solids"]);
    solids.read_named();
    contents->solid = solids.read(root.require("solid"), contents->name);
    contents->profiles = profiles.named_makers();
    contents->named = {profiles.named_makers(), solids.named_makers()};
    if (!document->errors().empty()) return document->errors();
    contents->facet_bound = read_facet_bound(numbers, profiles, root["solids"], root["solid"]);
    return PartFile(std::move(contents));
}

const std::string& PartFile::name() const { return contents_->name; }
const std::string& PartFile::about() const { return contents_->about; }
const std::vector<PartDimension>& PartFile::dimensions() const { return contents_->dimensions; }
const std::vector<PartCount>& PartFile::counts() const { return contents_->counts; }
const std::vector<PartRelation>& PartFile::relations() const { return contents_->relations; }
const parts::Facets& PartFile::facets() const { return contents_->facets; }

Errors PartFile::faults(const std::vector<double>& values) const {
    FETTLE_ASSERT(values.size() == dimensions().size(), "one value for each dimension");
    Errors errors;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const PartDimension& dimension = dimensions()[k];
        const std::string where = name() + "/" + dimension.name;
        if (!base::is_usable_number(values[k]))
            errors.push_back({ErrorCode::not_finite, where, dimension.name + " is no number that can be used; give a finite one"});
        else if (dimension.kind == PartDimensionKind::length && !(values[k] > 0))
            errors.push_back(
                {ErrorCode::out_of_range, where, dimension.name + " is " + base::format_length(values[k], "mm") + "; allowed: above 0 mm"});
    }
    if (!errors.empty()) return errors;
    std::vector<double> all;
    for (const Number& number : contents_->numbers.values({values.begin(), values.end()})) all.push_back(number.value);
    for (const PartRelation& relation : relations())
        if (auto error = fault_of(relation, all)) errors.push_back(std::move(*error));
    return errors;
}

std::vector<std::string> PartFile::profile_names() const {
    std::vector<std::string> out;
    for (const auto& [name, maker] : *contents_->profiles) out.push_back(name);
    return out;
}

Errors PartFile::with_profile(const std::string& name, const std::vector<double>& values,
                              const std::function<void(const parts::Profile&)>& use) const {
    Errors errors = faults(values);
    if (!errors.empty()) return errors;
    parts::Drawing drawing;
    std::vector<Number> dimensions;
    for (const double value : values) dimensions.push_back(drawing.dimension(value));
    Sheet sheet{drawing, contents_->numbers.values(std::move(dimensions)), {}, {}, 0};
    const Result<parts::Profile> profile = contents_->profiles->at(name)(sheet);
    if (!profile) return profile.errors();
    use(*profile);
    return {};
}

Result<parts::DrawnPart> PartFile::drawn(const std::vector<double>& values, const std::optional<parts::Facets>& facets,
                                         const parts::Structure& structure, const parts::DrawnOptions& options) const {
    Errors errors = faults(values);
    if (!errors.empty()) return errors;
    const auto sheet_of = [&](parts::Drawing& drawing) {
        std::vector<Number> dimensions;
        for (const double value : values) dimensions.push_back(drawing.dimension(value));
        return Sheet{drawing, contents_->numbers.values(std::move(dimensions)), {}, {}, 0};
    };
    if (structure.decisions.empty()) {  // what was drawn before has as many facets now
        parts::Drawing drawing(facets.value_or(contents_->facets));
        if (const auto bound = contents_->facet_bound(sheet_of(drawing)); !bound) return bound.errors();
    }
    parts::Drawing drawing(facets.value_or(contents_->facets), structure, options.compare_counts);
    Sheet sheet = sheet_of(drawing);
    const Result<parts::Solid> solid = contents_->solid(sheet);
    if (!solid) return solid.errors();
    return located(parts::drawn(drawing, *solid, name(), options), name());
}

}  // namespace fettle::core::part_files
