// SPDX-License-Identifier: MIT
// Pictures: which parts hide others, which edges are drawn, where things are; PNG decoded by a reader of its own, SVG by an XML reader.
#include "design/exports/picture.hpp"

#include <zlib.h>

#include <catch2/catch.hpp>
#include <set>

#include "core/mesh_files/xml_reader.hpp"
#include "design/exports/png_writer.hpp"
#include "design/exports/svg_writer.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::exports::picture_test {

namespace {

using core::kinematics::Pose;
using tests::support::box_mesh;
using tests::support::contains;

/// A box of 2 x 2 x 2, and behind it (+y) a smaller one, of which the front hides all.
Assembly two_boxes() {
    Assembly out;
    out.parts = {{"front", part_colour(0), box_mesh({-1, -1, -1}, {1, 1, 1}), Vector3::Zero(), false},
                 {"back", part_colour(5), box_mesh({-0.5, 2, -0.5}, {0.5, 3, 0.5}), Vector3::Zero(), false}};
    out.keyframes = {{0, true, {Pose{}, Pose{}}}};
    return out;
}

PictureOptions seen_from(const std::string& view, const Vector3& up = Vector3::UnitZ()) {
    PictureOptions options;
    options.view = projection_view(view, up, "").value();
    options.width = options.height = 200;
    return options;
}

Picture drawn(const Assembly& assembly, const PictureOptions& options) {
    return draw_picture(assembly, assembly.keyframes.front().poses, options);
}

bool is_reddish(const Colour& c) { return c[0] > 2 * c[2]; }  // colour 5; colour 0 is blue

int count(const Image& image, bool (*fits)(const Colour&)) {
    return static_cast<int>(std::count_if(image.pixels.begin(), image.pixels.end(), fits));
}

unsigned big_endian(const std::string& bytes, std::size_t at) {
    unsigned out = 0;
    for (std::size_t i = 0; i < 4; ++i) out = out << 8 | static_cast<unsigned char>(bytes.at(at + i));
    return out;
}

/// The byte that a row's filter adds to the one at hand; PNG specification, section 9: of the pixels on the left, above, and above on the
/// left.
int predicted(char filter, int left, int up, int corner) {
    if (filter == 0) return 0;
    if (filter == 1) return left;
    if (filter == 2) return up;
    if (filter == 3) return (left + up) / 2;
    REQUIRE(filter == 4);
    const int p = left + up - corner, to_left = std::abs(p - left), to_up = std::abs(p - up), to_corner = std::abs(p - corner);
    return to_left <= to_up && to_left <= to_corner ? left : to_up <= to_corner ? up : corner;
}

/// Checksums checked; 8 bits a channel, three channels, not interlaced.
Image decoded(const std::string& png) {
    REQUIRE(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    Image image;
    std::string packed;
    for (std::size_t at = 8; at < png.size();) {
        const std::size_t size = big_endian(png, at);
        const std::string body = png.substr(at + 4, size + 4);
        CHECK(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())) == big_endian(png, at + 8 + size));
        if (body.substr(0, 4) == "IHDR") {
            image.width = static_cast<int>(big_endian(body, 4));
            image.height = static_cast<int>(big_endian(body, 8));
            CHECK(body.substr(12) == std::string("\x08\x02\x00\x00\x00", 5));
        }
        if (body.substr(0, 4) == "IDAT") packed += body.substr(4);
        at += size + 12;
    }
    const std::size_t row = 1 + 3 * static_cast<std::size_t>(image.width);
    std::string rows(row * static_cast<std::size_t>(image.height), '\0');
    uLongf length = rows.size();
    REQUIRE(uncompress(reinterpret_cast<Bytef*>(rows.data()), &length, reinterpret_cast<const Bytef*>(packed.data()), packed.size()) ==
            Z_OK);
    REQUIRE(length == rows.size());
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; ++y) {
        const std::size_t begin = static_cast<std::size_t>(y) * row;
        for (int x = 0; x < image.width; ++x) {
            for (std::size_t k = 0; k < 3; ++k) {
                const int left = x > 0 ? image.at(x - 1, y)[k] : 0, up = y > 0 ? image.at(x, y - 1)[k] : 0,
                          corner = x > 0 && y > 0 ? image.at(x - 1, y - 1)[k] : 0;
                const auto difference = static_cast<unsigned char>(rows[begin + 1 + 3 * static_cast<std::size_t>(x) + k]);
                image.at(x, y)[k] = static_cast<unsigned char>(difference + predicted(rows[begin], left, up, corner));
            }
        }
    }
    return image;
}

std::vector<PictureLine> lines_of(const Picture& picture) {
    std::vector<PictureLine> out;
    for (const PartEdges& edges : picture.edges) out.insert(out.end(), edges.lines.begin(), edges.lines.end());
    return out;
}

}  // namespace

TEST_CASE("Picture: what is in front hides what is behind, wherever it stands in the list") {
    for (const bool turned_list : {false, true}) {
        Assembly assembly = two_boxes();
        if (turned_list) std::swap(assembly.parts[0], assembly.parts[1]);
        CHECK(count(drawn(assembly, seen_from("front")).surfaces, is_reddish) == 0);
        const Picture back = drawn(assembly, seen_from("back"));
        const int red = count(back.surfaces, is_reddish);
        CHECK(red == Approx(84 * 84).epsilon(0.05));  // half of 84% of the picture's 200 pixels, each way: 168 for 2 units
    }
}

TEST_CASE("Picture: of a cube seen from the front four edges, of one seen askew nine, none of what is hidden") {
    Assembly assembly = two_boxes();
    const auto length = [](const Picture& picture) {
        double sum = 0;
        for (const PictureLine& line : lines_of(picture)) sum += (line.to - line.from).norm();
        return sum;
    };
    const Picture front = drawn(assembly, seen_from("front"));
    CHECK(length(front) >= 4 * 168 * 0.99);
    for (const PictureLine& line : lines_of(front))  // along the border of the square from 16 to 184, not where the hidden box is
        for (const Vector2& p : {line.from, line.to}) CHECK((p - Vector2(100, 100)).cwiseAbs().maxCoeff() == Approx(84).margin(1.5));
    assembly.parts.pop_back();
    assembly.keyframes = {{0, true, {Pose{}}}};
    const Picture askew = drawn(assembly, seen_from("iso"));
    CHECK(lines_of(askew).size() == 9);
    const double edge = askew.scale_pixels > 0 ? length(askew) / 9 : 0;
    for (const PictureLine& line : lines_of(askew))
        CHECK((line.to - line.from).norm() == Approx(edge).epsilon(0.05));  // all axes equally long
}

TEST_CASE("Picture: flat facets of a curved face have no edges between them below the crease") {
    Assembly assembly = two_boxes();
    PictureOptions options = seen_from("iso");
    options.crease = M_PI / 2 + 0.1;  // a cube's own corners are below it: outlines alone are left
    assembly.parts.pop_back();
    assembly.keyframes = {{0, true, {Pose{}}}};
    CHECK(lines_of(drawn(assembly, options)).size() == 6);
}

TEST_CASE("Views: right-handed, by name and by angles, with any axis up") {
    for (const Vector3& up : {Vector3(0, 0, 1), Vector3(0, 1, 0), Vector3(1, 0, 0), Vector3(0, 0, -1), Vector3(0, -1, 0)}) {
        for (const char* name : {"iso", "front", "back", "left", "right", "top", "bottom", "33,-12.5", "-200,89"}) {
            const ProjectionView view = projection_view(name, up, "").value();
            CHECK((view.right.cross(view.up) - view.towards).norm() < 1e-12);
            CHECK(view.right.norm() == Approx(1));
            CHECK(view.towards.norm() == Approx(1));
            CHECK(view.up.dot(up) >= -1e-12);
        }
    }
    const auto towards = [](const std::string& name, const Vector3& up) { return projection_view(name, up, "").value().towards; };
    CHECK(towards("front", Vector3::UnitZ()) == Vector3(0, -1, 0));
    CHECK(towards("right", Vector3::UnitZ()) == Vector3(1, 0, 0));
    CHECK(towards("top", Vector3::UnitZ()) == Vector3(0, 0, 1));
    CHECK((towards("front", Vector3::UnitY()) - Vector3(0, 0, 1)).norm() < 1e-12);
    CHECK((towards("right", Vector3::UnitY()) - Vector3(1, 0, 0)).norm() < 1e-12);
    CHECK((towards("90,0", Vector3::UnitZ()) - towards("right", Vector3::UnitZ())).norm() < 1e-12);
    for (const char* wrong : {"", "izo", "10", "10,91", "nan,0", "0,nan", "1,2,3"}) {
        const auto view = projection_view(wrong, Vector3::UnitZ(), "--view");
        REQUIRE_FALSE(view);
        CHECK(view.errors().front().where == "--view");
    }
    CHECK(contains(projection_view("izo", Vector3::UnitZ(), "").errors().front().message, "iso"));
}

TEST_CASE("Picture: what is marked is cut free of what hides it, and shown near in an inset") {
    const Assembly assembly = two_boxes();
    PictureOptions options = seen_from("front");
    options.width = options.height = 400;
    const auto marked = [&](const Vector3& a, const Vector3& b) {
        options.marker = PictureMarker{a, b, "a:b"};
        return drawn(assembly, options);
    };
    const auto reddish_within = [](const Picture& picture, double low, double high) {
        int found = 0;
        for (int y = 0; y < 400; ++y)
            for (int x = 0; x < 400; ++x) {
                const double away = (Vector2(x + 0.5, y + 0.5) - middle_of(*picture.marker)).norm();
                found += away > low && away < high && is_reddish(picture.surfaces.at(x, y)) ? 1 : 0;
            }
        return found;
    };
    SECTION("on the box behind: the one before it is taken away round the marker, no farther") {
        const Picture picture = marked({0, 2, 0}, {0.1, 2, 0});
        REQUIRE(picture.hole > 20);
        CHECK(reddish_within(picture, 0, picture.hole - 2) > 0.9 * M_PI * picture.hole * picture.hole);
        CHECK(reddish_within(picture, picture.hole + 2, 400) == 0);
        REQUIRE(picture.inset.size() == 1);
        CHECK(count(picture.inset.front().surfaces, is_reddish) > 1000);
        const Image image = decoded(png_bytes(picture));
        const int x = static_cast<int>(picture.inset_place.x()) + 20, y = static_cast<int>(picture.inset_place.y()) + 20;
        CHECK(is_reddish(image.at(x, y)));
        CHECK((middle_of(*picture.marker) - picture.inset_place).norm() > picture.hole);
        CHECK(contains(svg_text(picture), "<svg x="));
    }
    SECTION("inside the box before: its material is shown, hatched") {
        const Picture picture = marked({0, 0, 0}, {0.1, 0, 0});
        REQUIRE(picture.hole > 0);
        const Colour plain = part_colour(0);
        int cut = 0;
        for (const Colour& c : picture.surfaces.pixels) cut += c == plain ? 1 : 0;
        CHECK(cut > 0.45 * M_PI * picture.hole * picture.hole);  // a line in every six pixels, which darkens up to three of them
    }
    SECTION("in front of all: nothing is cut") {
        const Picture picture = marked({0, -1, 0}, {0.5, -1, 0});
        CHECK(picture.hole == 0);
        CHECK(reddish_within(picture, 0, 400) == 0);
        CHECK(picture.inset.size() == 1);
    }
    SECTION("two points on one line of sight are beside each other in the inset") {
        const Picture picture = marked({0, -1, 0}, {0, -1.2, 0});
        const PictureLine& marker = *picture.inset.front().marker;
        CHECK((marker.to - marker.from).norm() == Approx(0.2 * 1.6 * 168).epsilon(0.01));  // 168 pixels are 1 m in the picture
    }
}

TEST_CASE("Picture: material that two bodies share is red where it is cut") {
    Assembly assembly = two_boxes();
    assembly.parts[1].mesh = box_mesh({0.5, -0.5, -0.5}, {1.5, 0.5, 0.5});  // half of it in the first
    PictureOptions options = seen_from("front");
    options.width = options.height = 400;
    options.marker = PictureMarker{{0.75, 0, 0}, {0.75, 0, 0}, "front:back", true, 0.5};
    const Picture picture = drawn(assembly, options);
    CHECK(picture.hole > 0);
    CHECK(picture.marker_colour == alarm);
    const auto is_alarm = [](const Colour& c) { return c == alarm; };
    const int found = count(picture.inset.front().surfaces, is_alarm);
    const double scale = 1.6 * 0.84 * 400 / 2.5;                 // pixels per metre: 1.6 times those of 2.5 m in 84% of 400
    CHECK(found > 0.45 * 0.5 * scale * std::min(scale, 144.0));  // of 0.5 x 1, as far as 144 pixels show it, but for the hatching
    CHECK(found < 0.5 * scale * std::min(scale, 144.0));
    options.marker->a = options.marker->b = {0, -1, 0};
    options.marker->size = 0.05;
    CHECK(count(drawn(assembly, options).inset.front().surfaces, is_alarm) == 0);
}

TEST_CASE("Picture: marker, legend and scale, as PNG and as SVG") {
    PictureOptions options = seen_from("front");
    options.marker = PictureMarker{Vector3(0, -1, 0), Vector3(0.5, -1, 0), "a:b <0.1 mm"};
    options.title = "t & t";
    const Assembly assembly = two_boxes();
    const Picture picture = drawn(assembly, options);
    REQUIRE(picture.marker);
    CHECK((picture.marker->from - Vector2(100, 100)).norm() < 1e-9);
    CHECK((picture.marker->to - Vector2(142, 100)).norm() < 1e-9);
    CHECK(picture.legend.size() == 2);
    CHECK(picture.scale_text == "200 mm");  // a sixth of 200 pixels at 84 pixels per metre is 0.397 m
    CHECK(picture.scale_pixels == Approx(16.8));

    const Image image = decoded(png_bytes(picture)), surfaces = decoded(png_bytes(picture.surfaces));
    CHECK(image.width == 200);
    CHECK(image.height == 200);
    CHECK(surfaces.pixels == picture.surfaces.pixels);
    const Colour marked = image.at(120, 99);  // between its ends
    CHECK(marked == nearest);
    CHECK(surfaces.at(120, 99) != nearest);

    const std::string svg = svg_text(picture);
    core::mesh_files::XmlReader xml(svg, "svg");
    int paths = 0, texts = 0, circles = 0;
    xml.read([&] {
        if (!xml.opens()) return;
        paths += xml.name() == "path" ? 1 : 0;
        texts += xml.name() == "text" ? 1 : 0;
        circles += xml.name() == "circle" ? 1 : 0;
    });
    CHECK(xml.errors().empty());
    CHECK(paths == 4);  // edges of the one that is seen, marker, scale and what is white round it
    CHECK(texts == 5);
    CHECK(circles == 4);
    CHECK(contains(svg, "a:b &lt;0.1 mm"));
    CHECK(contains(svg, "href=\"data:image/png;base64,iVBORw0KGgo"));
}

TEST_CASE("Picture: words are written in letters, whatever bytes they have") {
    PictureOptions options = seen_from("front");
    const auto title = [&](const std::string& words) {
        Assembly none;
        none.keyframes = {{0, true, {}}};
        options.title = words;
        const Picture picture = drawn(none, options);
        CHECK(png_bytes(picture) == png_bytes(picture));
        const Image image = decoded(png_bytes(picture));
        double darkness = 0;
        for (int y = 10; y < 40; ++y)
            for (int x = 0; x < 200; ++x) darkness += 1 - image.at(x, y)[0] / 255.0;
        return darkness;
    };
    CHECK(title("") == 0);
    const double one = title("rod");
    CHECK(one > 20);
    CHECK(one < 0.5 * text_width("rod", title_letters) * title_letters.size);
    CHECK(title("rod rod") == Approx(2 * one).epsilon(0.05));
    CHECK(title("K\xc3\xb6rper") > one);
    CHECK(title("\xff") > 0);  // shown as \xff
    CHECK(title(std::string(1000, 'W')) > one);
    const Picture picture = drawn(two_boxes(), options);
    const std::string own = png_bytes(picture, "/no/fonts");  // cairo's letters: others, and nothing else is
    CHECK(own != png_bytes(picture));
    const Image a = decoded(own), b = decoded(png_bytes(picture));
    int apart = 0;
    for (int y = 90; y < 170; ++y)
        for (int x = 0; x < 200; ++x) apart += a.at(x, y) == b.at(x, y) ? 0 : 1;
    CHECK(apart == 0);
    CHECK(text_width("\xc3\xa4", plain_letters) == text_width("a", plain_letters));
}

TEST_CASE("Picture: of faces that lie in each other the first part's is seen, all of it") {
    Assembly assembly = two_boxes();
    assembly.parts[1].mesh = box_mesh({-0.9, -1, -0.8}, {0.7, 0.3, 0.6});  // its front lies in the other's
    for (const char* view : {"front", "20,30"}) CHECK(count(drawn(assembly, seen_from(view)).surfaces, is_reddish) == 0);
}

TEST_CASE("Picture: a face below the crease is lit smoothly, one above it is not") {
    Assembly assembly;  // a polygon of 24, seen from the side
    AssemblyPart part{"drum", part_colour(0), {}, Vector3::Zero(), false};
    constexpr int sides = 24;
    part.mesh.vertices.resize(3, 2 * sides);
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * M_PI * (i + 0.5) / sides;
        part.mesh.vertices.col(i) = Vector3(std::cos(angle), std::sin(angle), -1);
        part.mesh.vertices.col(sides + i) = Vector3(std::cos(angle), std::sin(angle), 1);
        const int next = (i + 1) % sides;
        part.mesh.triangles.push_back({i, next, sides + next});
        part.mesh.triangles.push_back({i, sides + next, sides + i});
    }
    core::geometry::build_connectivity(part.mesh);
    assembly.parts = {part};
    assembly.keyframes = {{0, true, {Pose{}}}};
    const auto shades = [&](double crease) {
        PictureOptions options = seen_from("front");
        options.crease = crease;
        const Picture picture = drawn(assembly, options);
        std::set<Colour> found;
        for (int x = 30; x < 170; ++x) found.insert(picture.surfaces.at(x, 100));
        return found.size();
    };
    CHECK(shades(0.6) > 30);
    CHECK(shades(0.1) < 30);
}

TEST_CASE("Picture: nothing at all, and a point, are pictures too") {
    Assembly empty;
    empty.keyframes = {{0, true, {}}};
    CHECK(count(drawn(empty, seen_from("iso")).surfaces, [](const Colour& c) { return c != Colour{255, 255, 255}; }) == 0);
    AssemblyPart point{"point", part_colour(1), {}, Vector3::Zero(), false};
    point.mesh.vertices = Matrix3X::Zero(3, 1);
    core::geometry::build_connectivity(point.mesh);
    Assembly one;
    one.parts = {point};
    one.keyframes = {{0, true, {Pose{}}}};
    CHECK(decoded(png_bytes(drawn(one, seen_from("top")))).pixels.size() == 40000);
}

}  // namespace fettle::design::exports::picture_test
