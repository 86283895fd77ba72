// SPDX-License-Identifier: MIT
// 3MF as programs write it, and as nobody should.
#include <zlib.h>

#include <catch2/catch.hpp>
#include <random>

#include "core/geometry/mass_moments.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/mesh_files/raw_mesh.hpp"
#include "core/mesh_files/xml_reader.hpp"
#include "core/solids/mesh_validity.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::mesh_files::threemf_parser_test {

namespace {

std::string little_endian(std::uint64_t value, int bytes) {
    std::string out;
    for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 255);
    return out;
}

std::string deflated(const std::string& text) {
    z_stream stream{};
    REQUIRE(deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) == Z_OK);
    std::string out(deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

/// As OpenSCAD 2021 (lib3mf) writes it: sizes and places in the zip64 extra field, 0xffffffff where they used to be, zip64 end record.
std::string zip64(const std::vector<std::pair<std::string, std::string>>& parts, std::uint64_t claimed_size = 0) {
    std::string out, directory;
    for (const auto& [name, text] : parts) {
        const std::uint64_t offset = out.size();
        const std::string packed = deflated(text);
        const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()));
        const std::string common = little_endian(45, 2) + little_endian(0, 2) + little_endian(8, 2) + little_endian(0, 4) +
                                   little_endian(checksum, 4) + little_endian(0xffffffff, 4) + little_endian(0xffffffff, 4) +
                                   little_endian(name.size(), 2);
        const std::string sizes = little_endian(claimed_size > 0 ? claimed_size : text.size(), 8) + little_endian(packed.size(), 8);
        out += "PK\3\4" + common + little_endian(20, 2) + name + little_endian(1, 2) + little_endian(16, 2) + sizes + packed;
        directory += "PK\1\2" + little_endian(45, 2) + common + little_endian(28, 2) + little_endian(0, 2) + little_endian(0, 2) +
                     little_endian(0, 2) + little_endian(0, 4) + little_endian(0xffffffff, 4) + name + little_endian(1, 2) +
                     little_endian(24, 2) + sizes + little_endian(offset, 8);
    }
    const std::uint64_t start = out.size(), end64 = start + directory.size();
    out += directory + "PK\6\6" + little_endian(44, 8) + little_endian(45, 2) + little_endian(45, 2) + little_endian(0, 8) +
           little_endian(parts.size(), 8) + little_endian(parts.size(), 8) + little_endian(directory.size(), 8) + little_endian(start, 8);
    out += std::string("PK\6\7") + little_endian(0, 4) + little_endian(end64, 8) + little_endian(1, 4);
    out += std::string("PK\5\6") + little_endian(0, 4) + little_endian(0xffff, 2) + little_endian(0xffff, 2) +
           little_endian(0xffffffff, 4) + little_endian(0xffffffff, 4) + little_endian(0, 2);
    return out;
}

const std::string tetrahedron =
    "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"0.1234567890123456\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/>"
    "<vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>"
    "<triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh>";
const std::string wheel = "<object id=\"1\" name=\"wheel &amp; axle\">" + tetrahedron + "</object>";

std::string model(const std::string& resources, const std::string& build, const std::string& attributes = "") {
    return "<?xml version=\"1.0\"?>\n<!-- made > by hand -->\n<model unit=\"meter\" " + attributes +
           " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>" + resources + "</resources>\n<build>" +
           build + "</build></model>";
}

Result<RawMesh> parsed(const std::string& model_text) { return parse_3mf(zip64({{"3D/3dmodel.model", model_text}}), "a.3mf"); }

Error only_error(const Result<RawMesh>& result) {
    REQUIRE(result.errors().size() == 1);
    return result.errors().front();
}

using fettle::tests::support::contains;

}  // namespace

TEST_CASE("3MF: zip64 entries are read, in double precision, with names") {
    const tests::support::TemporaryFolder folder;
    const auto path = folder.write("a.3mf", zip64({{"[Content_Types].xml", "<Types/>"},
                                                   {"_rels/.rels",
                                                    "<Relationships><Relationship Id=\"x\" Type=\"http://a/b/3dmodel\" "
                                                    "Target=\"/3D/other.model\"/></Relationships>"},
                                                   {"3D/other.model", model(wheel, "<item objectid=\"1\"/>")}}));
    const auto mesh = read_mesh(path);
    REQUIRE(mesh);
    CHECK(mesh->vertices(0, 1) == 0.1234567890123456);
    CHECK(mesh->shell_names == std::vector<std::string>{"wheel & axle"});
    CHECK(solids::validate_mesh(*mesh, {}).empty());
}

TEST_CASE("3MF: a mirrored item stays a solid, support is left out, other parts are followed") {
    const std::string mirrored = model(wheel + "<object id=\"2\" type=\"support\">" + tetrahedron + "</object>",
                                       "<item objectid=\"2\"/><item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 5 0 0\"/>");
    const auto raw = parsed(mirrored);
    REQUIRE(raw);
    CHECK(raw->vertices.size() == 4);
    std::vector<geometry::Triangle> triangles;
    for (std::size_t i = 0; i < raw->corners.size(); i += 3)
        triangles.push_back({raw->corners[i], raw->corners[i + 1], raw->corners[i + 2]});
    Matrix3X vertices(3, 4);
    for (int i = 0; i < 4; ++i) vertices.col(i) = raw->vertices[i];
    CHECK(geometry::solid_moments(vertices, triangles)(3, 3) > 0.02);
    CHECK(vertices.row(0).minCoeff() == Approx(5 - 0.1234567890123456));

    const std::string root = model("", "<item objectid=\"1\" p:path=\"/3D/Objects/w.model\"/>",
                                   "requiredextensions=\"p\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"");
    const auto production = parse_3mf(zip64({{"3D/3dmodel.model", root}, {"3D/Objects/w.model", model(wheel, "")}}), "a.3mf");
    REQUIRE(production);
    CHECK(production->vertices.size() == 4);
}

TEST_CASE("3MF: what is wrong is told, and nothing is taken on trust") {
    const auto code = [](const Result<RawMesh>& result) { return only_error(result).code; };
    const std::string item = "<item objectid=\"1\"/>";
    CHECK(code(parse_3mf("not a zip", "a.3mf")) == ErrorCode::parse);
    CHECK(code(parse_3mf(zip64({{"readme", "x"}}), "a.3mf")) == ErrorCode::parse);
    CHECK(code(parsed("<svg/>")) == ErrorCode::parse);
    CHECK(code(parsed("<!DOCTYPE a [<!ENTITY b \"c\">]><model/>")) == ErrorCode::parse);
    CHECK(code(parsed(model(wheel, item).substr(0, 300))) == ErrorCode::parse);
    CHECK(code(parsed(model(wheel, "<item objectid=\"7\"/>"))) == ErrorCode::inconsistent);
    CHECK(code(parsed(model(wheel, item, "requiredextensions=\"b\" xmlns:b=\"http://x/beamlattice/2017/02\""))) == ErrorCode::unsupported);
    CHECK(code(parsed(model("<object id=\"1\"><components><component objectid=\"1\"/></components></object>", item))) ==
          ErrorCode::inconsistent);
    std::string bad_index = model(wheel, item);
    bad_index.replace(bad_index.find("v1=\"1\" v2=\"2\""), 6, "v1=\"9\"");
    CHECK(contains(only_error(parsed(bad_index)).message, "names a vertex beyond its 4"));
    std::string bad_number = model(wheel, item);
    bad_number.replace(bad_number.find("y=\"1\""), 5, "y=\"a\"");
    const Error number = only_error(parsed(bad_number));
    CHECK(contains(number.where, "a.3mf/3D/3dmodel.model:4"));
    CHECK(contains(number.message, "`y` of a <vertex> is not a number"));
    // Components that place components a hundred times each would fill any memory.
    std::string bomb = wheel;
    for (int level = 2; level < 9; ++level) {
        bomb += "<object id=\"" + std::to_string(level) + "\"><components>";
        for (int i = 0; i < 100; ++i) bomb += "<component objectid=\"" + std::to_string(level - 1) + "\"/>";
        bomb += "</components></object>";
    }
    CHECK(code(parsed(model(bomb, "<item objectid=\"8\"/>"))) == ErrorCode::out_of_range);
    CHECK(code(parse_3mf(zip64({{"3D/3dmodel.model", "<model/>"}}, std::uint64_t{1} << 40), "a.3mf")) == ErrorCode::out_of_range);
    CHECK(code(parse_3mf(zip64({{"3D/3dmodel.model", "<model/>"}}, 1 << 20), "a.3mf")) == ErrorCode::parse);
}

TEST_CASE("3MF: what a small file asks for has limits that are told, and takes linear time") {
    const auto items = [](int count) {
        std::string all;
        for (int i = 0; i < count; ++i) all += "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 " + std::to_string(2 * i) + " 0 0\"/>\n";
        return model(wheel, all);
    };
    const Error many = only_error(parsed(items(20'000)));
    CHECK(many.code == ErrorCode::out_of_range);
    CHECK(contains(many.message, "more than 10,000 items"));
    const tests::support::TemporaryFolder folder;
    const auto parts = read_mesh_parts(folder.write("a.3mf", zip64({{"3D/3dmodel.model", items(10'000)}})));
    REQUIRE(parts);
    REQUIRE(parts->size() == 10'000);
    CHECK(parts->back().name == parts->front().name);
    CHECK(parts->back().shell_names == parts->front().shell_names);
    CHECK(parts->back().vertices.row(0).minCoeff() == Approx(2 * 9999));
    // A wide object of many components, each on a line of its own.
    std::string wide = wheel + "<object id=\"2\"><components>";
    for (int i = 0; i < 50'000; ++i) wide += "<component objectid=\"1\"/>\n";
    CHECK(parsed(model(wide + "</components></object>", "<item objectid=\"2\"/>"))->polygon_ends.size() == 200'000);
    // Two components each, 31 levels deep, and nothing, or support alone, at the end: two thousand million placings.
    for (const std::string last : {"<object id=\"1\"></object>", "<object id=\"1\" type=\"support\"></object>"}) {
        std::string tree = last;
        for (int level = 2; level < 33; ++level) {
            const std::string inner = "<component objectid=\"" + std::to_string(level - 1) + "\"/>";
            tree += "<object id=\"" + std::to_string(level) + "\"><components>" + inner + inner + "</components></object>";
        }
        CHECK(contains(only_error(parsed(model(tree, "<item objectid=\"32\"/>"))).message, "or a million objects"));
    }
    // 80 MB of blanks, a thousandth of it packed; and 30 MB three times, in parts of their own.
    CHECK(contains(only_error(parsed(model(std::string(80'000'000, ' '), ""))).message, "unpacks to 800"));
    const std::string blank = model(std::string(30'000'000, ' '), "");
    std::string three = "<object id=\"1\"><components>";
    for (const char* part : {"a", "b", "c"}) three += "<component objectid=\"1\" p:path=\"" + std::string(part) + "\"/>";
    three += "</components></object>";
    const auto whole = parse_3mf(zip64({{"3D/3dmodel.model", model(three, "")}, {"a", blank}, {"b", blank}, {"c", blank}}), "a.3mf");
    CHECK(only_error(whole).code == ErrorCode::out_of_range);
}

TEST_CASE("XML: what is not well formed, too deep or too long is refused; lines are counted right") {
    const auto fault = [](std::string_view text) {
        XmlReader xml(text, "x");
        int visits = 0;
        xml.read([&] { ++visits; });
        CAPTURE(text.substr(0, 60));
        REQUIRE(xml.errors().size() == 1);
        CHECK(visits <= 100);
        return xml.errors().front().message;
    };
    CHECK(contains(fault(std::string_view("<a></a>\0 garbage", 16)), "not valid XML"));
    std::string many = "<a";
    for (int i = 0; i < 101; ++i) many += " a" + std::to_string(i) + "=\"\"";
    many += "/>";
    CHECK(contains(fault(many), "more than 100 attributes"));
    CHECK(contains(fault("<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>"), "a document type is not read"));
    CHECK(contains(fault("<a>&b;</a>"), "not valid XML"));
    std::string deep;
    for (int i = 0; i < 101; ++i) deep += "<a>";
    CHECK(contains(fault(deep), "nested deeper than 100"));
    CHECK(contains(fault("<a><!--" + std::string(40'000'000, 'x') + "--></a>"), "more than a megabyte"));
    for (const char* broken :
         {"", "a", "<a>", "<a></b>", "<a/><a/>", "<a b='1' b='2'/>", "<a b=1/>", "<a b='<'/>", "<a>\xff</a>", "<a b='\xc3'/>"})
        CHECK(contains(fault(broken), "not valid XML"));
    XmlReader lines("<a>\n\n<b/>\n<c\nd='1'/></a>", "x");
    std::vector<std::string> places;
    lines.read([&] { places.push_back(lines.where()); });
    CHECK(places == std::vector<std::string>{"x:1", "x:3", "x:3", "x:4", "x:5", "x:5"});
}

TEST_CASE("3MF: cut and damaged archives are read or refused, never out of bounds") {
    const std::string good = zip64({{"_rels/.rels", "<Relationships/>"}, {"3D/3dmodel.model", model(wheel, "<item objectid=\"1\"/>")}});
    REQUIRE(parse_3mf(good, "a.3mf"));
    for (std::size_t length = 0; length < good.size(); ++length) CHECK_FALSE(parse_3mf(good.substr(0, length), "a.3mf"));
    std::mt19937 random(3);
    int refused = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        std::string damaged = good;
        for (int k = 0; k < 1 + trial % 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
        if (!parse_3mf(damaged, "a.3mf")) ++refused;
    }
    CHECK(refused > 1000);
    const std::string text = model(wheel, "<item objectid=\"1\"/>");
    for (int trial = 0; trial < 2000; ++trial) {
        std::string damaged = text;
        damaged[random() % damaged.size()] = static_cast<char>(random());
        XmlReader xml(damaged, "x");
        int tags = 0;
        xml.read([&] { tags += xml.depth() > 0 ? 1 : 0; });
        CHECK(tags < 100);
    }
}

}  // namespace fettle::core::mesh_files::threemf_parser_test
