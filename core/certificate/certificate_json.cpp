// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "core/certificate/certificate.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/hash.hpp"
#include "core/files/json_document.hpp"
#include "core/files/json_keys.hpp"
#include "core/files/json_writer.hpp"

namespace fettle::core::certificate {
namespace {

using base::ErrorCode;
using files::JsonNode;
using files::JsonWriter;

const std::vector<std::string_view> kind_names{"vertex", "edge", "triangle"};  // in the order of Primitive
const std::vector<std::string_view> solids_names{"unproven", "disjoint", "overlap", "not closed", "not verified"};  // of Solids

constexpr std::string_view version_key = "fettle_certificate", old_range_key = "fettle_range_certificate";

enum class Format { current, old_path, old_range };

void write_number(JsonWriter& out, std::string_view name, double value) {
    out.key(name);
    out.number(value);
}

void write_text(JsonWriter& out, const char* name, std::string_view value) {
    out.key(name);
    out.string(value);
}

void write_flag(JsonWriter& out, const char* name, bool value) {
    out.key(name);
    out.text += value ? "true" : "false";
}

void write_point(JsonWriter& out, const char* name, const CertifiedPoint& point) {
    out.key(name);
    out.text += '{';
    write_text(out, "kind", kind_names[static_cast<std::size_t>(point.kind)]);
    write_number(out, "index", point.index);
    out.key("weight");
    out.numbers(point.weight);
    out.text += '}';
}

void write_pieces(JsonWriter& out, const BodyPieces& body) {
    out.text += '{';
    out.key("elements");
    out.numbers(body.elements);
    out.key("cuts");
    out.numbers(body.cuts);
    out.text += '}';
}

void write_export(JsonWriter& out, const ExportedFile& exported) {
    out.text += '{';
    write_text(out, "file", exported.file);
    write_text(out, "hash", exported.hash);
    write_number(out, "rounding", exported.rounding);
    out.text += '}';
}

void write_link(JsonWriter& out, const LinkedBody& body) {
    out.text += '{';
    write_number(out, "parent", body.parent);
    out.key("screws");
    out.list(body.screws.size(), ", ", [&](std::size_t i) {
        const Screw& screw = body.screws[i];
        out.text += '{';
        write_number(out, "coordinate", screw.coordinate);
        out.key("point");
        out.numbers(screw.point);
        out.key("axis");
        out.numbers(screw.axis);
        write_number(out, "turn", screw.turn);
        write_number(out, "slide", screw.slide);
        out.text += '}';
    });
    out.text += '}';
}

void write_box(JsonWriter& out, const BoxProof& proof) {
    out.text += "{\"splits\": \"" + proof.splits + '"';
    std::vector<double> numbers;
    numbers.reserve(3 * proof.normals.size());
    for (const Vector3& n : proof.normals) numbers.insert(numbers.end(), n.begin(), n.end());
    out.key("normals");
    out.numbers(numbers);
    out.text += '}';
}

void write_pair(JsonWriter& out, const PairCertificate& pair) {
    out.text += '{';
    write_number(out, "a", pair.a);
    write_number(out, "b", pair.b);
    write_number(out, "lower", pair.lower);
    write_number(out, "upper", pair.upper);
    write_text(out, "solids", to_string(pair.solids));
    if (pair.minimum) write_number(out, "minimum", *pair.minimum);
    write_number(out, "step", pair.step);
    write_number(out, "segment", pair.segment);
    out.key("at");
    out.numbers(pair.at);
    write_point(out, "point_a", pair.point_a);
    write_point(out, "point_b", pair.point_b);
    out.key("boxes");
    out.list(pair.boxes.size(), ",\n  ", [&](std::size_t i) { write_box(out, pair.boxes[i]); });
    out.text += '}';
}

std::string text_of(const Certificate& certificate) {
    JsonWriter out;
    out.text = "{";
    write_number(out, version_key, certificate.version);
    write_text(out, "geometry_hash", files::hexadecimal(certificate.geometry_hash));
    write_text(out, "path_hash", files::hexadecimal(certificate.path_hash));
    write_number(out, "length_unit", certificate.length_unit);
    write_text(out, "source", certificate.source);
    if (!certificate.scenario.empty()) write_text(out, "scenario", certificate.scenario);
    if (!certificate.process.empty()) write_text(out, "process", certificate.process);
    write_flag(out, "motion", certificate.motion);
    if (certificate.linkage) {
        const Linkage& linkage = *certificate.linkage;
        out.key("coordinates");
        out.list(linkage.coordinates.size(), ",\n ", [&](std::size_t i) { write_coordinate(out, linkage.coordinates[i]); });
        out.key("links");
        out.list(linkage.bodies.size(), ",\n ", [&](std::size_t i) { write_link(out, linkage.bodies[i]); });
    }
    out.key("bodies");
    out.list(certificate.bodies.size(), ",\n ", [&](std::size_t i) { write_pieces(out, certificate.bodies[i]); });
    if (!certificate.exports.empty()) {
        out.key("exports");
        out.list(certificate.exports.size(), ",\n ", [&](std::size_t i) { write_export(out, certificate.exports[i]); });
    }
    if (certificate.toleranced) {
        out.key("tolerances");
        write_toleranced(out, *certificate.toleranced);
    }
    if (certificate.joints) {
        out.key("joints");
        write_joints(out, *certificate.joints);
    }
    if (certificate.is_of_path) write_flag(out, "path_as_stored", true);
    out.key("pairs");
    out.list(certificate.pairs.size(), ",\n ", [&](std::size_t i) { write_pair(out, certificate.pairs[i]); });
    out.text += "}\n";
    return std::move(out.text);
}

double read_number(const JsonNode& node) { return node.number().value_or(0); }
double read_bound(const JsonNode& node) { return node.number(files::not_negative).value_or(0); }
std::string read_text(const JsonNode& node) { return node.string().value_or(""); }
bool read_flag(const JsonNode& node) { return node.boolean().value_or(false); }
int read_index(const JsonNode& node, int least) { return node.integer(least).value_or(least); }
std::vector<double> read_numbers(const JsonNode& node) { return node.numbers().value_or(std::vector<double>{}); }

std::vector<int> read_whole_numbers(const JsonNode& node) {
    std::vector<int> out;
    for (const double x : read_numbers(node)) {
        if (x != std::floor(x) || std::abs(x) > 1e9) {
            node.fail(ErrorCode::out_of_range, "whole numbers are expected");
            return {};
        }
        out.push_back(static_cast<int>(x));
    }
    return out;
}

// Hexadecimal.
std::uint64_t read_hash(const JsonNode& node) {
    const std::string text = node.string().value_or("0");
    std::uint64_t hash = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
    if (code != std::errc() || end != text.data() + text.size()) node.fail(ErrorCode::out_of_range, "a hexadecimal number is expected");
    return hash;
}

Solids read_solids(const JsonNode& node) {
    const std::string solids = node.choice(solids_names).value_or("unproven");
    return static_cast<Solids>(std::find(solids_names.begin(), solids_names.end(), solids) - solids_names.begin());
}

CertifiedPoint read_point(const JsonNode& node) {
    CertifiedPoint point;
    const std::string kind = node.require("kind").choice(kind_names).value_or("vertex");
    point.kind = kind == "vertex" ? Primitive::vertex : kind == "edge" ? Primitive::edge : Primitive::triangle;
    point.index = read_index(node.require("index"), 0);
    const Vector3 weight = node.require("weight").vector3().value_or(Vector3::UnitX());
    point.weight = {weight[0], weight[1], weight[2]};
    return point;
}

LinkedBody read_link(const JsonNode& node) {
    LinkedBody out;
    out.parent = read_index(node.require("parent"), -1);
    for (const JsonNode& screw : node.require("screws").elements())
        out.screws.push_back({read_index(screw.require("coordinate"), 0), screw.require("point").vector3().value_or(Vector3::Zero()),
                              screw.require("axis").vector3().value_or(Vector3::UnitZ()), read_number(screw.require("turn")),
                              read_number(screw.require("slide"))});
    return out;
}

BoxProof read_box(const JsonNode& node, Format format) {
    BoxProof proof;
    proof.splits = read_text(node.require("splits"));
    if (format == Format::old_path) std::replace(proof.splits.begin(), proof.splits.end(), 't', '0');
    const JsonNode normals = node.require(format == Format::old_path ? "planes" : "normals");
    const std::vector<double> numbers = read_numbers(normals);
    if (numbers.size() % 3 != 0) normals.fail(ErrorCode::inconsistent, "three numbers per vector are expected");
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) proof.normals.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return proof;
}

PairCertificate read_pair(const JsonNode& node, Format format) {
    PairCertificate pair;
    pair.a = read_index(node.require("a"), 0);
    pair.b = read_index(node.require("b"), 0);
    pair.lower = read_bound(node.require("lower"));
    pair.upper = read_bound(node.require("upper"));
    pair.solids = read_solids(node.require("solids"));
    pair.minimum = node["minimum"].number(files::not_negative);
    if (format != Format::old_range) {
        pair.step = read_index(node.require("step"), -1);
        pair.segment = read_index(node.require("segment"), 0);
    }
    if (format == Format::old_path)
        pair.at = {node.require("s").number({0, 1}).value_or(0)};
    else
        pair.at = read_numbers(node.require("at"));
    pair.point_a = read_point(node.require("point_a"));
    pair.point_b = read_point(node.require("point_b"));
    if (format == Format::old_range) {
        if (BoxProof proof = read_box(node, format); !proof.splits.empty()) pair.boxes.push_back(std::move(proof));
    } else {
        for (const JsonNode& box : node.require(format == Format::old_path ? "segments" : "boxes").elements())
            pair.boxes.push_back(read_box(box, format));
    }
    return pair;
}

// The node fails where it is none.
Format read_format(const JsonNode& root) {
    if (root[old_range_key].exists()) {
        files::is_version(root[old_range_key], 1);
        return Format::old_range;
    }
    const JsonNode version = root.require(version_key);
    const auto is = [&](double number) { return version.exists() && version.is_number() && version.number() == number; };
    if (is(2)) return Format::old_path;
    if (!is(3)) files::is_version(version, certificate_version);  // one of version 3 is one of 4 that has less in it
    return Format::current;
}

Certificate read_root(const JsonNode& root, Format format) {
    Certificate certificate;
    certificate.geometry_hash = read_hash(root.require("geometry_hash"));
    certificate.path_hash = read_hash(root.require("path_hash"));
    certificate.length_unit = root.require("length_unit").number(files::positive).value_or(1);
    certificate.source = read_text(root["source"]);
    certificate.scenario = read_text(root["scenario"]);
    certificate.process = read_text(root["process"]);
    if (format != Format::old_range) certificate.motion = read_flag(root.require("motion"));
    if (format == Format::old_range || root["coordinates"].exists() || root["links"].exists()) {
        certificate.linkage.emplace();
        for (const JsonNode& node : root.require("coordinates").elements())
            certificate.linkage->coordinates.push_back(read_coordinate(node));
        for (const JsonNode& node : root.require("links").elements()) certificate.linkage->bodies.push_back(read_link(node));
    }
    for (const JsonNode& body : root.require("bodies").elements())
        certificate.bodies.push_back({read_whole_numbers(body.require("elements")), read_whole_numbers(body.require("cuts"))});
    for (const JsonNode& exported : root["exports"].elements())
        certificate.exports.push_back(
            {read_text(exported.require("file")), read_text(exported.require("hash")), read_bound(exported.require("rounding"))});
    if (root["tolerances"].exists()) certificate.toleranced = read_toleranced(root["tolerances"]);
    if (root["joints"].exists()) certificate.joints = read_joints(root["joints"]);
    certificate.is_of_path = read_flag(root["path_as_stored"]);
    for (const JsonNode& pair : root.require("pairs").elements()) certificate.pairs.push_back(read_pair(pair, format));
    return certificate;
}

}  // namespace

const char* to_string(Solids solids) { return solids_names[static_cast<std::size_t>(solids)].data(); }

base::Errors write_certificate(const std::filesystem::path& path, const Certificate& certificate) {
    files::FilesTogether files;
    base::Errors errors = add_certificate(files, path, certificate);
    return errors.empty() ? files.take_names() : errors;
}

base::Errors add_certificate(files::FilesTogether& files, const std::filesystem::path& path, const Certificate& certificate) {
    return files.add(path, text_of(certificate));
}

base::Result<Certificate> read_certificate(const std::filesystem::path& path) {
    auto document = files::JsonDocument::read(path.string());
    if (!document) return document.errors();
    const JsonNode root = document->root();
    root.allow_keys({version_key, old_range_key, "geometry_hash", "path_hash", "length_unit", "source", "scenario", "process", "motion",
                     "coordinates", "links", "bodies", "exports", "tolerances", "joints", "path_as_stored", "pairs"});
    const Format format = read_format(root);
    if (!document->errors().empty()) return document->errors();
    Certificate certificate = read_root(root, format);
    if (!document->errors().empty()) return document->errors();
    return certificate;
}

bool is_certificate_file(const std::filesystem::path& path) {
    return files::has_top_level_key(path, version_key) || files::has_top_level_key(path, old_range_key);
}

}  // namespace fettle::core::certificate
