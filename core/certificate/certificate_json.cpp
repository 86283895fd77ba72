// SPDX-License-Identifier: MIT
#include "fettle/core/certificate/certificate_json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/files/hash.hpp"
#include "fettle/core/files/json_keys.hpp"

namespace fettle::core::certificate {
namespace {

using base::ErrorCode;
using files::JsonNode;
using files::JsonWriter;

const std::vector<std::string_view> kind_names{"vertex", "edge", "triangle"};  // in the order of Primitive
const std::vector<std::string_view> solids_names{"unproven", "disjoint", "overlap", "not closed", "not verified"};  // of Solids

std::vector<int> whole_numbers(const JsonNode& node) {
    std::vector<int> out;
    for (const double x : node.numbers().value_or(std::vector<double>{})) {
        if (x != std::floor(x) || std::abs(x) > 1e9) {
            node.fail(ErrorCode::out_of_range, "whole numbers are wanted");
            return {};
        }
        out.push_back(static_cast<int>(x));
    }
    return out;
}

}  // namespace

const char* to_string(Solids solids) { return solids_names[static_cast<std::size_t>(solids)].data(); }

void write_point(JsonWriter& out, const char* name, const CertifiedPoint& point) {
    out.key(name);
    out.text += '{';
    out.key("kind");
    out.string(kind_names[static_cast<std::size_t>(point.kind)]);
    out.key("index");
    out.number(point.index);
    out.key("weight");
    out.numbers(point.weight);
    out.text += '}';
}

CertifiedPoint read_point(const JsonNode& node) {
    CertifiedPoint point;
    const std::string kind = node.require("kind").choice(kind_names).value_or("vertex");
    point.kind = kind == "vertex" ? Primitive::vertex : kind == "edge" ? Primitive::edge : Primitive::triangle;
    point.index = node.require("index").integer(0).value_or(0);
    const Vector3 weight = node.require("weight").vector3().value_or(Vector3::UnitX());
    point.weight = {weight[0], weight[1], weight[2]};
    return point;
}

void write_pieces(JsonWriter& out, const std::vector<BodyPieces>& bodies) {
    out.list(bodies.size(), ",\n ", [&](std::size_t i) {
        out.text += '{';
        out.key("elements");
        out.numbers(bodies[i].elements);
        out.key("cuts");
        out.numbers(bodies[i].cuts);
        out.text += '}';
    });
}

std::vector<BodyPieces> read_pieces(const JsonNode& node) {
    std::vector<BodyPieces> out;
    for (const JsonNode& body : node.elements())
        out.push_back({whole_numbers(body.require("elements")), whole_numbers(body.require("cuts"))});
    return out;
}

Solids read_solids(const JsonNode& node) {
    const std::string solids = node.choice(solids_names).value_or("unproven");
    return static_cast<Solids>(std::find(solids_names.begin(), solids_names.end(), solids) - solids_names.begin());
}

std::uint64_t read_hash(const JsonNode& node) {
    const std::string text = node.string().value_or("0");
    std::uint64_t hash = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
    if (code != std::errc() || end != text.data() + text.size()) node.fail(ErrorCode::out_of_range, "a hexadecimal number is wanted");
    return hash;
}

namespace {

void write_segment(JsonWriter& out, const SegmentProof& proof) {
    std::string splits = proof.splits;
    std::vector<double> numbers;
    std::size_t leaf = 0;
    for (char& kind : splits) {
        if (kind != '.' || leaf >= proof.planes.size()) continue;
        const LeafPlane& plane = proof.planes[leaf++];
        numbers.insert(numbers.end(), plane.n0.begin(), plane.n0.end());
        if (plane.n0 == plane.n1) continue;
        kind = ':';
        numbers.insert(numbers.end(), plane.n1.begin(), plane.n1.end());
    }
    out.text += "{\"splits\": \"" + splits + '"';
    out.key("planes");
    out.numbers(numbers);
    out.text += '}';
}

void write_export(JsonWriter& out, const ExportedFile& exported) {
    out.text += '{';
    out.key("file");
    out.string(exported.file);
    out.key("hash");
    out.string(exported.hash);
    out.key("rounding");
    out.number(exported.rounding);
    out.text += '}';
}

void write_pair(JsonWriter& out, const PairCertificate& pair) {
    out.text += "{\"a\": " + std::to_string(pair.a) + ", \"b\": " + std::to_string(pair.b);
    for (const auto& [name, value] : {std::pair<const char*, double>{"lower", pair.lower},
                                      {"upper", pair.upper},
                                      {"step", pair.step},
                                      {"segment", pair.segment},
                                      {"s", pair.s}}) {
        out.key(name);
        out.number(value);
    }
    out.key("solids");
    out.string(to_string(pair.solids));
    write_point(out, "point_a", pair.point_a);
    write_point(out, "point_b", pair.point_b);
    out.key("segments");
    out.list(pair.segments.size(), ",\n  ", [&](std::size_t i) { write_segment(out, pair.segments[i]); });
    out.text += '}';
}

SegmentProof read_segment(const JsonNode& node) {
    SegmentProof proof;
    proof.splits = node.require("splits").string().value_or("");
    const JsonNode planes = node.require("planes");
    const auto numbers = planes.numbers().value_or(std::vector<double>{});
    std::size_t taken = 0;
    for (char& kind : proof.splits) {
        if (kind != '.' && kind != ':') continue;
        const std::size_t first = taken, second = kind == ':' ? taken + 3 : taken;
        kind = '.';
        taken = second + 3;
        if (taken > numbers.size()) break;
        proof.planes.push_back(
            {{numbers[first], numbers[first + 1], numbers[first + 2]}, {numbers[second], numbers[second + 1], numbers[second + 2]}});
    }
    if (taken != numbers.size()) planes.fail(ErrorCode::inconsistent, "three numbers per `.` and six per `:` are wanted");
    return proof;
}

PairCertificate read_pair(const JsonNode& node) {
    PairCertificate pair;
    pair.a = node.require("a").integer(0).value_or(0);
    pair.b = node.require("b").integer(0).value_or(0);
    pair.lower = node.require("lower").number(files::not_negative).value_or(0);
    pair.upper = node.require("upper").number(files::not_negative).value_or(0);
    pair.solids = read_solids(node.require("solids"));
    pair.step = node.require("step").integer(-1).value_or(-1);
    pair.segment = node.require("segment").integer(0).value_or(0);
    pair.s = node.require("s").number({0, 1}).value_or(0);
    pair.point_a = read_point(node.require("point_a"));
    pair.point_b = read_point(node.require("point_b"));
    for (const JsonNode& segment : node.require("segments").elements()) pair.segments.push_back(read_segment(segment));
    return pair;
}

}  // namespace

base::Errors add_certificate(files::FilesTogether& files, const std::filesystem::path& path, const Certificate& certificate) {
    JsonWriter out;
    out.text = "{";
    out.key("fettle_certificate");
    out.number(certificate.version);
    out.key("geometry_hash");
    out.string(files::hexadecimal(certificate.geometry_hash));
    out.key("path_hash");
    out.string(files::hexadecimal(certificate.path_hash));
    out.key("length_unit");
    out.number(certificate.length_unit);
    out.key("source");
    out.string(certificate.source);
    out.key("motion");
    out.text += certificate.motion ? "true" : "false";
    out.key("bodies");
    write_pieces(out, certificate.bodies);
    if (!certificate.exports.empty()) {
        out.key("exports");
        out.list(certificate.exports.size(), ",\n ", [&](std::size_t i) { write_export(out, certificate.exports[i]); });
    }
    if (certificate.joints) {
        out.key("joints");
        write_joints(out, *certificate.joints);
    }
    if (certificate.is_of_path) {
        out.key("path_as_stored");
        out.text += "true";
    }
    out.key("pairs");
    out.list(certificate.pairs.size(), ",\n ", [&](std::size_t i) { write_pair(out, certificate.pairs[i]); });
    out.text += "}\n";
    return files.add(path, out.text);
}

base::Errors write_certificate(const std::filesystem::path& path, const Certificate& certificate) {
    files::FilesTogether file;
    base::Errors errors = add_certificate(file, path, certificate);
    return errors.empty() ? file.take_names() : errors;
}

base::Result<Certificate> read_certificate(const std::filesystem::path& path) {
    auto document = files::JsonDocument::read(path.string());
    if (!document) return document.errors();
    const JsonNode root = document->root();
    root.allow_keys({"fettle_certificate", "geometry_hash", "path_hash", "length_unit", "source", "motion", "bodies", "exports", "joints",
                     "path_as_stored", "pairs"});
    files::is_version(root.require("fettle_certificate"), 2);
    if (!document->errors().empty()) return document->errors();
    Certificate certificate;
    certificate.geometry_hash = read_hash(root.require("geometry_hash"));
    certificate.path_hash = read_hash(root.require("path_hash"));
    certificate.length_unit = root.require("length_unit").number(files::positive).value_or(1);
    certificate.source = root["source"].string().value_or("");
    certificate.motion = root.require("motion").boolean().value_or(false);
    certificate.bodies = read_pieces(root.require("bodies"));
    for (const JsonNode& exported : root["exports"].elements())
        certificate.exports.push_back({exported.require("file").string().value_or(""), exported.require("hash").string().value_or(""),
                                       exported.require("rounding").number(files::not_negative).value_or(0)});
    if (root["joints"].exists()) certificate.joints = read_joints(root["joints"]);
    certificate.is_of_path = root["path_as_stored"].boolean().value_or(false);
    for (const JsonNode& pair : root.require("pairs").elements()) certificate.pairs.push_back(read_pair(pair));
    if (!document->errors().empty()) return document->errors();
    return certificate;
}

bool is_certificate_file(const std::filesystem::path& path) { return files::has_top_level_key(path, "fettle_certificate"); }

}  // namespace fettle::core::certificate
