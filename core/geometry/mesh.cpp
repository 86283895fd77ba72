// SPDX-License-Identifier: MIT
#include "core/geometry/mesh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <unordered_map>

#include "core/base/mixed_bits.hpp"
#include "core/base/parallel.hpp"

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

/// A hash of the counts, and of some of the vertices and triangles: meshes that it does not tell apart are compared anyhow.
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

std::vector<std::size_t> first_of_shape(const std::vector<const Mesh*>& meshes) {
    constexpr int meshes_at_once = 8;  // that a thread takes
    const auto count = count_of(meshes);
    std::vector<std::size_t> hashes(meshes.size()), first(meshes.size());
    base::parallel_for(count, meshes_at_once, [&](int i) { hashes[i] = shape_hash(*meshes[i]); });
    std::unordered_map<std::size_t, std::vector<std::size_t>> by_hash;  // the first of each shape
    for (std::size_t i = 0; i < meshes.size(); ++i) first[i] = by_hash.try_emplace(hashes[i], 1, i).first->second.front();
    std::vector<char> is_copy(meshes.size());
    base::parallel_for(count, 1, [&](int i) {
        is_copy[i] = first[i] == static_cast<std::size_t>(i) || have_same_shape(*meshes[first[i]], *meshes[i]) ? 1 : 0;
    });
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (is_copy[i] != 0) continue;  // else other shapes have its hash
        std::vector<std::size_t>& others = by_hash[hashes[i]];
        const auto same =
            std::find_if(others.begin(), others.end(), [&](std::size_t k) { return have_same_shape(*meshes[k], *meshes[i]); });
        first[i] = same == others.end() ? i : *same;
        if (same == others.end()) others.push_back(i);
    }
    return first;
}

}  // namespace fettle::core::geometry
