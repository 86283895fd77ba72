// SPDX-License-Identifier: MIT
#include "fettle/core/certificate/range_certificate.hpp"

#include <algorithm>
#include <set>

#include "fettle/core/certificate/certificate_json.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/files/hash.hpp"
#include "fettle/core/files/json_keys.hpp"

namespace fettle::core::certificate {
namespace {

using base::ErrorCode;
using files::JsonNode;
using files::JsonWriter;

void write_number(JsonWriter& out, const char* name, double value) {
    out.key(name);
    out.number(value);
}

void write_flag(JsonWriter& out, const char* name, bool value) {
    out.key(name);
    out.text += value ? "true" : "false";
}

void write_coordinate(JsonWriter& out, const LinkageCoordinate& coordinate) {
    out.text += '{';
    write_number(out, "start", coordinate.start);
    write_number(out, "low", coordinate.low);
    write_number(out, "high", coordinate.high);
    write_flag(out, "is_whole_turn", coordinate.is_whole_turn);
    out.key("joints");
    out.list(coordinate.joints.size(), ", ", [&](std::size_t i) {
        const JointCoordinate& joint = coordinate.joints[i];
        out.text += '{';
        out.key("joint");
        out.string(joint.joint);
        write_flag(out, "is_angle", joint.is_angle);
        write_number(out, "scale", joint.scale);
        write_number(out, "offset", joint.offset);
        out.text += '}';
    });
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

void write_range_pair(JsonWriter& out, const RangePairCertificate& pair) {
    out.text += '{';
    write_number(out, "a", pair.a);
    write_number(out, "b", pair.b);
    write_number(out, "lower", pair.lower);
    write_number(out, "upper", pair.upper);
    out.key("solids");
    out.string(to_string(pair.solids));
    out.key("at");
    out.numbers(pair.at);
    write_point(out, "point_a", pair.point_a);
    write_point(out, "point_b", pair.point_b);
    out.key("splits");
    out.string(pair.proof.splits);
    std::vector<double> numbers;
    for (const Vector3& n : pair.proof.normals) numbers.insert(numbers.end(), n.begin(), n.end());
    out.key("normals");
    out.numbers(numbers);
    out.text += '}';
}

double read_number(const JsonNode& node) { return node.number().value_or(0); }

LinkageCoordinate read_coordinate(const JsonNode& node) {
    LinkageCoordinate out;
    out.start = read_number(node.require("start"));
    out.low = read_number(node.require("low"));
    out.high = read_number(node.require("high"));
    out.is_whole_turn = node.require("is_whole_turn").boolean().value_or(false);
    for (const JsonNode& joint : node.require("joints").elements())
        out.joints.push_back({joint.require("joint").string().value_or(""), joint.require("is_angle").boolean().value_or(false),
                              read_number(joint.require("scale")), read_number(joint.require("offset"))});
    return out;
}

LinkedBody read_link(const JsonNode& node) {
    LinkedBody out;
    out.parent = node.require("parent").integer(-1).value_or(-1);
    for (const JsonNode& screw : node.require("screws").elements())
        out.screws.push_back({screw.require("coordinate").integer(0).value_or(0),
                              screw.require("point").vector3().value_or(Vector3(Vector3::Zero())),
                              screw.require("axis").vector3().value_or(Vector3(Vector3::UnitZ())), read_number(screw.require("turn")),
                              read_number(screw.require("slide"))});
    return out;
}

RangePairCertificate read_range_pair(const JsonNode& node) {
    RangePairCertificate pair;
    pair.a = node.require("a").integer(0).value_or(0);
    pair.b = node.require("b").integer(0).value_or(0);
    pair.lower = node.require("lower").number(files::not_negative).value_or(0);
    pair.upper = node.require("upper").number(files::not_negative).value_or(0);
    pair.solids = read_solids(node.require("solids"));
    pair.at = node.require("at").numbers().value_or(std::vector<double>{});
    pair.point_a = read_point(node.require("point_a"));
    pair.point_b = read_point(node.require("point_b"));
    pair.proof.splits = node.require("splits").string().value_or("");
    const JsonNode normals = node.require("normals");
    const auto numbers = normals.numbers().value_or(std::vector<double>{});
    if (numbers.size() % 3 != 0) normals.fail(ErrorCode::inconsistent, "three numbers per vector are wanted");
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) pair.proof.normals.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return pair;
}

}  // namespace

std::vector<std::array<int, 2>> uncovered_pairs(const RangeCertificate& certificate, int bodies) {
    std::set<std::array<int, 2>> covered;
    for (const RangePairCertificate& pair : certificate.pairs) covered.insert({std::min(pair.a, pair.b), std::max(pair.a, pair.b)});
    std::vector<std::array<int, 2>> uncovered;
    for (int a = 0; a < bodies; ++a)
        for (int b = a + 1; b < bodies; ++b)
            if (covered.count({a, b}) == 0) uncovered.push_back({a, b});
    return uncovered;
}

base::Errors add_range_certificate(files::FilesTogether& files, const std::filesystem::path& path, const RangeCertificate& certificate) {
    JsonWriter out;
    out.text = "{";
    write_number(out, "fettle_range_certificate", certificate.version);
    out.key("geometry_hash");
    out.string(files::hexadecimal(certificate.geometry_hash));
    out.key("path_hash");
    out.string(files::hexadecimal(certificate.path_hash));
    write_number(out, "length_unit", certificate.length_unit);
    out.key("source");
    out.string(certificate.source);
    const Linkage& linkage = certificate.linkage;
    out.key("coordinates");
    out.list(linkage.coordinates.size(), ",\n ", [&](std::size_t i) { write_coordinate(out, linkage.coordinates[i]); });
    out.key("links");
    out.list(linkage.bodies.size(), ",\n ", [&](std::size_t i) { write_link(out, linkage.bodies[i]); });
    out.key("bodies");
    write_pieces(out, certificate.bodies);
    out.key("pairs");
    out.list(certificate.pairs.size(), ",\n ", [&](std::size_t i) { write_range_pair(out, certificate.pairs[i]); });
    out.text += "}\n";
    return files.add(path, out.text);
}

base::Errors write_range_certificate(const std::filesystem::path& path, const RangeCertificate& certificate) {
    files::FilesTogether file;
    base::Errors errors = add_range_certificate(file, path, certificate);
    return errors.empty() ? file.take_names() : errors;
}

base::Result<RangeCertificate> read_range_certificate(const std::filesystem::path& path) {
    auto document = files::JsonDocument::read(path.string());
    if (!document) return document.errors();
    const JsonNode root = document->root();
    root.allow_keys(
        {"fettle_range_certificate", "geometry_hash", "path_hash", "length_unit", "source", "coordinates", "links", "bodies", "pairs"});
    files::is_version(root.require("fettle_range_certificate"), 1);
    if (!document->errors().empty()) return document->errors();
    RangeCertificate certificate;
    certificate.geometry_hash = read_hash(root.require("geometry_hash"));
    certificate.path_hash = read_hash(root.require("path_hash"));
    certificate.length_unit = root.require("length_unit").number(files::positive).value_or(1);
    certificate.source = root["source"].string().value_or("");
    for (const JsonNode& node : root.require("coordinates").elements()) certificate.linkage.coordinates.push_back(read_coordinate(node));
    for (const JsonNode& node : root.require("links").elements()) certificate.linkage.bodies.push_back(read_link(node));
    certificate.bodies = read_pieces(root.require("bodies"));
    for (const JsonNode& node : root.require("pairs").elements()) certificate.pairs.push_back(read_range_pair(node));
    if (!document->errors().empty()) return document->errors();
    return certificate;
}

bool is_range_certificate_file(const std::filesystem::path& path) { return files::has_top_level_key(path, "fettle_range_certificate"); }

}  // namespace fettle::core::certificate
