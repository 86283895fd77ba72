// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/certificate.hpp"

#include <charconv>
#include <cmath>

#include "fettle/core/base/atomic_file.hpp"
#include "fettle/core/base/contract.hpp"
#include "fettle/core/scene/json_document.hpp"
#include "fettle/core/scene/json_keys.hpp"

namespace fettle::core::clearance {
namespace {

using base::ErrorCode;
using scene::JsonNode;

const std::vector<std::string_view> kind_names{"vertex", "edge", "triangle"};  // in the order of Primitive

/// Appends JSON to a string. Only what this file needs.
class Writer {
public:
    std::string text;

    void number(double x) {
        FETTLE_ASSERT(std::isfinite(x), "a certificate with a number that is not finite");
        char buffer[32];
        const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, x);
        FETTLE_ASSERT(code == std::errc(), "a number longer than its buffer");
        const std::string_view digits(buffer, static_cast<std::size_t>(end - buffer));
        text += digits == "-0" ? "-0.0" : digits;  // readers take "-0" for a whole number, which has no sign
    }
    void key(const char* name) {
        if (text.back() != '{') text += ",\n ";
        text += '"';
        text += name;
        text += "\": ";
    }
    template <class Values>
    void list(const Values& values) {
        text += '[';
        for (const auto& value : values) {
            if (text.back() != '[') text += ',';
            number(static_cast<double>(value));
        }
        text += ']';
    }
};

void write_point(Writer& out, const char* name, const CertifiedPoint& point) {
    out.key(name);
    out.text += "{\"kind\": \"";
    out.text += kind_names[static_cast<std::size_t>(point.kind)];
    out.text += '"';
    out.key("index");
    out.number(point.index);
    out.key("weight");
    out.list(point.weight);
    out.text += '}';
}

void write_segment(Writer& out, const SegmentProof& proof) {
    out.text += "{\"splits\": \"" + proof.splits + '"';
    out.key("planes");
    std::vector<double> numbers;
    for (const LeafPlane& plane : proof.planes)
        for (const Vector3* n : {&plane.n0, &plane.n1}) numbers.insert(numbers.end(), n->begin(), n->end());
    out.list(numbers);
    out.text += '}';
}

void write_pair(Writer& out, const PairCertificate& pair) {
    out.text += "{\"a\": " + std::to_string(pair.a) + ", \"b\": " + std::to_string(pair.b);
    for (const auto& [name, value] : {std::pair<const char*, double>{"lower", pair.lower},
                                      {"upper", pair.upper},
                                      {"step", pair.step},
                                      {"segment", pair.segment},
                                      {"s", pair.s}}) {
        out.key(name);
        out.number(value);
    }
    write_point(out, "point_a", pair.point_a);
    write_point(out, "point_b", pair.point_b);
    out.key("segments");
    out.text += '[';
    for (const SegmentProof& proof : pair.segments) {
        if (out.text.back() != '[') out.text += ",\n  ";
        write_segment(out, proof);
    }
    out.text += "]}";
}

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

CertifiedPoint read_point(const JsonNode& node) {
    CertifiedPoint point;
    const std::string kind = node.require("kind").choice(kind_names).value_or("vertex");
    point.kind = kind == "vertex" ? Primitive::vertex : kind == "edge" ? Primitive::edge : Primitive::triangle;
    point.index = node.require("index").integer(0).value_or(0);
    const Vector3 weight = node.require("weight").vector3().value_or(Vector3::UnitX());
    point.weight = {weight[0], weight[1], weight[2]};
    return point;
}

SegmentProof read_segment(const JsonNode& node) {
    SegmentProof proof;
    proof.splits = node.require("splits").string().value_or("");
    const JsonNode planes = node.require("planes");
    const auto numbers = planes.numbers().value_or(std::vector<double>{});
    if (numbers.size() % 6 != 0) planes.fail(ErrorCode::inconsistent, "six numbers per leaf are wanted: n0 and n1");
    for (std::size_t i = 0; i + 6 <= numbers.size(); i += 6)
        proof.planes.push_back({{numbers[i], numbers[i + 1], numbers[i + 2]}, {numbers[i + 3], numbers[i + 4], numbers[i + 5]}});
    return proof;
}

PairCertificate read_pair(const JsonNode& node) {
    PairCertificate pair;
    pair.a = node.require("a").integer(0).value_or(0);
    pair.b = node.require("b").integer(0).value_or(0);
    pair.lower = node.require("lower").number(scene::not_negative).value_or(0);
    pair.upper = node.require("upper").number(scene::not_negative).value_or(0);
    pair.step = node.require("step").integer(-1).value_or(-1);
    pair.segment = node.require("segment").integer(0).value_or(0);
    pair.s = node.require("s").number({0, 1}).value_or(0);
    pair.point_a = read_point(node.require("point_a"));
    pair.point_b = read_point(node.require("point_b"));
    for (const JsonNode& segment : node.require("segments").elements()) pair.segments.push_back(read_segment(segment));
    return pair;
}

std::uint64_t read_hash(const JsonNode& node) {
    const std::string text = node.string().value_or("0");
    std::uint64_t hash = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
    if (code != std::errc() || end != text.data() + text.size()) node.fail(ErrorCode::out_of_range, "a hexadecimal number is wanted");
    return hash;
}

}  // namespace

base::Errors write_certificate(const std::filesystem::path& path, const Certificate& certificate) {
    Writer out;
    out.text = "{";
    out.key("fettle_certificate");
    out.number(certificate.version);
    char hash[17] = {};
    std::to_chars(hash, hash + 16, certificate.geometry_hash, 16);
    out.key("geometry_hash");
    out.text += '"' + std::string(hash) + '"';
    out.key("motion");
    out.text += certificate.motion ? "true" : "false";
    out.key("bodies");
    out.text += '[';
    for (const BodyPieces& body : certificate.bodies) {
        out.text += out.text.back() == '[' ? "{" : ",\n {";
        out.key("elements");
        out.list(body.elements);
        out.key("cuts");
        out.list(body.cuts);
        out.text += '}';
    }
    out.text += ']';
    out.key("pairs");
    out.text += '[';
    for (const PairCertificate& pair : certificate.pairs) {
        if (out.text.back() != '[') out.text += ",\n ";
        write_pair(out, pair);
    }
    out.text += "]}\n";
    return base::write_file_atomically(path, out.text);
}

base::Result<Certificate> read_certificate(const std::filesystem::path& path) {
    auto document = scene::JsonDocument::read(path.string());
    if (!document) return document.errors();
    const JsonNode root = document->root();
    root.allow_keys({"fettle_certificate", "geometry_hash", "motion", "bodies", "pairs"});
    root.require("fettle_certificate").integer(1, 1);
    if (!document->errors().empty()) return document->errors();
    Certificate certificate;
    certificate.geometry_hash = read_hash(root.require("geometry_hash"));
    certificate.motion = root.require("motion").boolean().value_or(false);
    for (const JsonNode& body : root.require("bodies").elements())
        certificate.bodies.push_back({whole_numbers(body.require("elements")), whole_numbers(body.require("cuts"))});
    for (const JsonNode& pair : root.require("pairs").elements()) certificate.pairs.push_back(read_pair(pair));
    if (!document->errors().empty()) return document->errors();
    return certificate;
}

bool is_certificate_file(const std::filesystem::path& path) { return scene::has_top_level_key(path, "fettle_certificate"); }

}  // namespace fettle::core::clearance
