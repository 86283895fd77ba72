// SPDX-License-Identifier: MIT
// Random unions, differences and intersections of boxes and prisms on a grid of whole millimetres, where most faces are flush and most
// edges lie on others. What comes out is known by counting cells.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/geometry/mass_moments.hpp"
#include "core/part_files/part_file.hpp"
#include "core/parts/solid_booleans.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/solid_oracle.hpp"

namespace fettle::core::parts::solid_grids_test {

namespace {

constexpr int size = 10;  // cells along each axis
constexpr int slab = 4 * size * size;

/// The cells of a solid: cubes of 1 mm, each in four prisms, which the diagonals of its square in x and y part: 0 below, 1 right, 2 above,
/// 3 left.
struct Cells {
    std::vector<char> filled = std::vector<char>(static_cast<std::size_t>(slab * size), 0);

    static std::size_t index(int x, int y, int z, int quarter) { return static_cast<std::size_t>(slab * z + 4 * (size * y + x) + quarter); }
    bool at(int x, int y, int z, int quarter) const {
        const auto within = [](int i) { return i >= 0 && i < size; };
        return within(x) && within(y) && within(z) && filled[index(x, y, z, quarter)] != 0;
    }
    double volume() const { return static_cast<double>(std::count(filled.begin(), filled.end(), 1)) / 4; }
};

/// Around a corner of cells, between directions to the next corners: sectors of 45 degrees (of 90 degrees about the middle of a square),
/// below and above.
using Sectors = std::vector<std::array<bool, 2>>;

Sectors around(const Cells& cells, int x, int y, int z, bool middle) {
    Sectors out;
    // From the right on, counter-clockwise: the square beside the corner, and which of its quarters.
    constexpr int beside[8][3] = {{0, 0, 0}, {0, 0, 3}, {-1, 0, 1}, {-1, 0, 0}, {-1, -1, 2}, {-1, -1, 1}, {0, -1, 3}, {0, -1, 2}};
    for (int s = 0; s < (middle ? 4 : 8); ++s) {
        std::array<bool, 2> both{};
        for (int up = 0; up < 2; ++up)
            both[static_cast<std::size_t>(up)] =
                middle ? cells.at(x, y, z - 1 + up, s) : cells.at(x + beside[s][0], y + beside[s][1], z - 1 + up, beside[s][2]);
        out.push_back(both);
    }
    return out;
}

int components(const Sectors& sectors, bool of) {
    const int n = static_cast<int>(sectors.size());
    std::vector<char> seen(static_cast<std::size_t>(2 * n), 0);
    int count = 0;
    for (int start = 0; start < 2 * n; ++start) {
        if (seen[start] != 0 || sectors[start / 2][start % 2] != of) continue;
        ++count;
        std::vector<int> open{start};
        seen[start] = 1;
        while (!open.empty()) {
            const int s = open.back() / 2, up = open.back() % 2;
            open.pop_back();
            for (const int next : {2 * ((s + 1) % n) + up, 2 * ((s + n - 1) % n) + up, 2 * s + 1 - up}) {
                if (seen[next] != 0 || sectors[next / 2][next % 2] != of) continue;
                seen[next] = 1;
                open.push_back(next);
            }
        }
    }
    return count;
}

bool has_touching_edge(const Sectors& sectors) {
    const std::size_t n = sectors.size();
    std::array<int, 2> changes{0, 0};
    for (std::size_t s = 0; s < n; ++s) {
        const auto &a = sectors[s], &b = sectors[(s + 1) % n];
        for (std::size_t up = 0; up < 2; ++up) changes[up] += a[up] != b[up] ? 1 : 0;
        if (a[0] == b[1] && a[1] == b[0] && a[0] != a[1]) return true;
    }
    return std::max(changes[0], changes[1]) > 2;
}

enum class Surface { empty, sound, touches_in_points, touches_along_edges };

Surface surface_of(const Cells& cells) {
    if (cells.volume() == 0) return Surface::empty;
    Surface out = Surface::sound;
    for (int z = 0; z <= size; ++z)
        for (int y = 0; y <= size; ++y)
            for (int x = 0; x <= size; ++x)
                for (const bool middle : {false, true}) {
                    const Sectors sectors = around(cells, x, y, z, middle);
                    if (has_touching_edge(sectors)) return Surface::touches_along_edges;
                    if (components(sectors, true) > 1 || components(sectors, false) > 1) out = Surface::touches_in_points;
                }
    return out;
}

// Vertices - edges + faces of the surface: twice that of the solid, by its prisms.
int euler_of_surface(const Cells& cells) {
    using Cell = std::vector<std::array<int, 3>>;  // its corners, in units of half a millimetre in x and y
    std::set<Cell> all;
    int sum = 0;
    const auto add = [&](Cell cell, int sign) {
        std::sort(cell.begin(), cell.end());
        if (all.insert(std::move(cell)).second) sum += sign;
    };
    constexpr int corners[5][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}};
    for (int z = 0; z < size; ++z)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
                for (int q = 0; q < 4; ++q) {
                    if (!cells.at(x, y, z, q)) continue;
                    const auto corner = [&](int k, int up) {
                        if (k == 2) return std::array<int, 3>{2 * x + 1, 2 * y + 1, z + up};
                        return std::array<int, 3>{2 * x + corners[q + k][0], 2 * y + corners[q + k][1], z + up};
                    };
                    for (int k = 0; k < 3; ++k) {
                        const int next = (k + 1) % 3;
                        for (int up = 0; up < 2; ++up) {
                            add({corner(k, up)}, 1);
                            add({corner(k, up), corner(next, up)}, -1);
                        }
                        add({corner(k, 0), corner(k, 1)}, -1);
                        add({corner(k, 0), corner(k, 1), corner(next, 0), corner(next, 1)}, 1);
                    }
                    for (int up = 0; up < 2; ++up) add({corner(0, up), corner(1, up), corner(2, up)}, 1);
                    --sum;
                }
    return 2 * sum;
}

/// A solid of a part's file, and its cells.
struct Grid {
    std::string json;
    Cells cells;
    bool is_sound = true;  ///< it, and everything that it is made of, is a solid that does not touch itself
};

class Generator {
public:
    /// @param turn  Each box and prism is turned so far about z, so that flush faces are so to rounding only [deg].
    Generator(unsigned seed, bool prisms, double turn) : random_(seed), prisms_(prisms), turn_(turn) {}

    Grid solid(int depth) {
        Grid out = any(depth);
        out.is_sound = out.is_sound && surface_of(out.cells) == Surface::sound;
        return out;
    }

private:
    Grid any(int depth) {
        const int kind = below(depth > 0 ? 4 : 1);
        if (kind == 0) return leaf();
        if (kind == 1) return combined(depth, "union", 1 + below(3), [](bool a, bool b) { return a || b; });
        if (kind == 2) return combined(depth, "intersect", 1 + below(2), [](bool a, bool b) { return a && b; });
        const Grid from = solid(depth - 1);
        Grid out = combined(depth, "subtract", 1 + below(2), [](bool a, bool b) { return a || b; });
        out.json.insert(out.json.size() - 1, ", \"from\": " + from.json);
        for (std::size_t k = 0; k < from.cells.filled.size(); ++k)
            out.cells.filled[k] = from.cells.filled[k] != 0 && out.cells.filled[k] == 0;
        out.is_sound = out.is_sound && from.is_sound;
        return out;
    }

    int below(int end) { return static_cast<int>(random_() % static_cast<unsigned>(end)); }

    template <class Operation>
    Grid combined(int depth, const char* verb, int count, Operation operation) {
        Grid out = solid(depth - 1);
        std::string list = out.json;
        for (int k = 1; k < count; ++k) {
            const Grid next = solid(depth - 1);
            list += ", " + next.json;
            out.is_sound = out.is_sound && next.is_sound;
            for (std::size_t i = 0; i < out.cells.filled.size(); ++i)
                out.cells.filled[i] = operation(out.cells.filled[i] != 0, next.cells.filled[i] != 0);
        }
        out.json = std::string("{\"") + verb + "\": [" + list + "]}";
        return out;
    }

    Grid leaf() {
        const int x = below(5), y = below(5), z = below(5), height = 1 + below(4);
        int wide = 1 + below(4), deep = 1 + below(4);
        const int missing = prisms_ ? below(8) : 7;  // which corner of a square; from 4 on: none
        if (missing < 4) deep = wide;
        Grid out;
        for (int k = 0; k < height; ++k)
            for (int j = 0; j < deep; ++j)
                for (int i = 0; i < wide; ++i)
                    for (int q = 0; q < 4; ++q)
                        out.cells.filled[Cells::index(x + i, y + j, z + k, q)] = missing > 3 || is_in_triangle(i, j, q, wide, missing);
        std::ostringstream json;
        json << (turn_ != 0 ? R"({"turn": )" : "") << R"({"move": {"extrude": {"polygon": [)";
        constexpr int corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        bool first = true;
        for (int k = 0; k < 4; ++k) {
            if (k == missing) continue;
            json << (first ? "" : ", ") << "[" << wide * corners[k][0] << ", " << deep * corners[k][1] << "]";
            first = false;
        }
        json << "]}, \"to\": " << height << "}, \"by\": [" << x << ", " << y << ", " << z << "]}";
        if (turn_ != 0) json << ", \"by\": " << turn_ << "}";
        out.json = json.str();
        return out;
    }

    // Is the quarter in the triangle that a square of n cells is without the corner `missing`?
    static bool is_in_triangle(int i, int j, int q, int n, int missing) {
        // The middle of the quarter, in quarters of a cell.
        const int u = 4 * i + (q == 1 ? 3 : q == 3 ? 1 : 2), v = 4 * j + (q == 2 ? 3 : q == 0 ? 1 : 2), whole = 4 * n;
        switch (missing) {
            case 0:
                return u + v > whole;
            case 1:
                return v > u;
            case 2:
                return u + v < whole;
            default:
                return v < u;
        }
    }

    std::mt19937 random_;
    bool prisms_;
    double turn_;
};

struct Tally {
    int drawn = 0, refused = 0, not_sound = 0, not_sound_refused = 0;
};

void check(unsigned seed, bool prisms, double turn, Tally& tally) {
    const Grid grid = Generator(seed, prisms, turn).solid(3);
    const auto file = part_files::PartFile::parse(
        R"({"fettle_part": 1, "units": "mm", "dimensions": {"a": 1}, "solid": )" + grid.json + "}", "grid.part.json");
    REQUIRE(file);
    const auto part = file->drawn({1e-3});
    INFO("seed " << seed << ", prisms " << prisms << ", turned by " << turn << ": " << grid.json);
    for (const Error& error : part.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    const Surface surface = surface_of(grid.cells);
    if (surface == Surface::empty || surface == Surface::touches_along_edges) {
        CHECK_FALSE(part);
        ++tally.refused;
        return;
    }
    // A solid that is made of nothing, or of one that touches itself, may be refused.
    if (!grid.is_sound) {
        ++tally.not_sound;
        tally.not_sound_refused += part ? 0 : 1;
        if (!part) return;
    }
    CHECK(part);
    if (!part) return;
    ++tally.drawn;
    const auto& mesh = part->mesh;
    CHECK(geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3) == Approx(grid.cells.volume() * 1e-9).epsilon(1e-12));
    if (surface != Surface::sound) return;
    CHECK(tests::support::fault_of_solid(mesh) == "");
    CHECK(static_cast<int>(mesh.vertices.cols()) - static_cast<int>(mesh.triangles.size()) / 2 == euler_of_surface(grid.cells));
}

}  // namespace

TEST_CASE("the cells of a grid know volume, holes and what touches") {
    Cells two;
    const auto fill = [&](int x, int y, int z) {
        for (int q = 0; q < 4; ++q) two.filled[Cells::index(x, y, z, q)] = 1;
    };
    CHECK(surface_of(two) == Surface::empty);
    fill(1, 1, 1);
    CHECK(surface_of(two) == Surface::sound);
    CHECK(euler_of_surface(two) == 2);
    fill(2, 2, 2);
    CHECK(surface_of(two) == Surface::touches_in_points);
    fill(2, 2, 1);
    CHECK(surface_of(two) == Surface::touches_along_edges);
    fill(2, 1, 1);
    CHECK(surface_of(two) == Surface::sound);
    CHECK(two.volume() == 4);
    for (int x = 4; x < 7; ++x)
        for (int y = 4; y < 7; ++y)
            if (x != 5 || y != 5) fill(x, y, 5);
    CHECK(surface_of(two) == Surface::sound);
    CHECK(euler_of_surface(two) == 2 + 0);
}

TEST_CASE("what is cut on a grid: volume, holes and surface are those of its cells") {
    if (!has_solid_booleans()) FETTLE_SKIP("no CGAL");
    Tally tally;
    for (unsigned k = 0; k < 40; ++k) check(k + k / 2, false, 0, tally);
    CHECK(tally.drawn > 10);
}

TEST_CASE("what is cut on a grid, a thousand times: as it stands and turned", "[slow]") {
    if (!has_solid_booleans()) FETTLE_SKIP("no CGAL");
    for (const double turn : {0.0, 37.0}) {
        Tally tally;
        for (unsigned seed = 0; seed < 1060; ++seed) check(seed, seed % 3 == 2, turn, tally);
        INFO("turned by " << turn << ": drawn " << tally.drawn << ", refused " << tally.refused << ", of parts that are not sound "
                          << tally.not_sound_refused << " of " << tally.not_sound);
        CHECK(tally.drawn > 400);
        CHECK(tally.drawn > 3 * tally.not_sound_refused);
    }
}

}  // namespace fettle::core::parts::solid_grids_test
