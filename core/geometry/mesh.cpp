// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/mesh.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "fettle/core/base/mixed_bits.hpp"

namespace fettle::core::geometry {
namespace {

/// A hash of words.
class WordHash {
public:
    void add(std::uint64_t word) {
        std::uint64_t& chain = chains_[count_++ & 3];
        chain = (std::rotl(chain, 29) ^ word) * 0x9e3779b97f4a7c15u;
    }
    std::size_t value() const {
        std::uint64_t hash = count_;
        for (const std::uint64_t chain : chains_) hash = base::mixed_bits(hash ^ chain);
        return static_cast<std::size_t>(hash);
    }

private:
    std::array<std::uint64_t, 4> chains_{};
    std::uint64_t count_ = 0;
};

/// Of the counts, and of some of the vertices and triangles: meshes that it does not tell apart are compared anyhow.
std::size_t shape_hash(const Mesh& mesh) {
    constexpr std::size_t looked_at = 256;
    WordHash hash;
    const auto word = [](std::size_t low, std::size_t high) {
        return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
    };
    const auto vertices = static_cast<std::size_t>(mesh.vertices.cols());
    hash.add(word(vertices, mesh.triangles.size()));
    hash.add(word(mesh.edges.size(), mesh.codimensional_points.size()));
    for (std::size_t i = 0; i < vertices; i += vertices / looked_at + 1) {
        const double* x = mesh.vertices.data() + 3 * i;
        for (int k = 0; k < 3; ++k) hash.add(std::bit_cast<std::uint64_t>(x[k] + 0.0));  // -0 + 0 = 0
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); i += mesh.triangles.size() / looked_at + 1) {
        const Triangle& t = mesh.triangles[i];
        hash.add(word(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1])) ^ static_cast<std::uint64_t>(t[2]));
    }
    return hash.value();
}

/// Rows of integers compared at once: what has no padding is equal if its bytes are.
template <class Row>
bool have_same_bytes(const std::vector<Row>& a, const std::vector<Row>& b) {
    static_assert(std::has_unique_object_representations_v<Row>);
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Row)) == 0);
}

}  // namespace

bool have_same_shape(const Mesh& a, const Mesh& b) {
    return a.vertices.cols() == b.vertices.cols() && a.vertices == b.vertices && have_same_bytes(a.triangles, b.triangles) &&
           have_same_bytes(a.edges, b.edges) && have_same_bytes(a.codimensional_points, b.codimensional_points);
}

std::size_t ShapeIndex::add(const Mesh& mesh) {
    const std::size_t index = meshes_.size(), hash = shape_hash(mesh);
    meshes_.push_back(&mesh);
    const auto [begin, end] = by_hash_.equal_range(hash);
    for (auto at = begin; at != end; ++at)
        if (have_same_shape(*meshes_[at->second], mesh)) return at->second;
    by_hash_.emplace(hash, index);
    return index;
}

}  // namespace fettle::core::geometry
