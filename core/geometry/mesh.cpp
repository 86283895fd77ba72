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

/// A hash of words: four chains that do not wait for each other.
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

std::size_t shape_hash(const Mesh& mesh) {
    WordHash hash;
    const double* x = mesh.vertices.data();
    for (Eigen::Index i = 0; i < mesh.vertices.size(); ++i) hash.add(std::bit_cast<std::uint64_t>(x[i] + 0.0));  // -0 + 0 = 0
    const auto word = [](int low, int high) {
        return static_cast<std::uint64_t>(static_cast<std::uint32_t>(low)) << 32 | static_cast<std::uint32_t>(high);
    };
    for (const Triangle& t : mesh.triangles) {
        hash.add(word(t[0], t[1]));
        hash.add(word(t[2], 0));
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
    return a.vertices.cols() == b.vertices.cols() && have_same_bytes(a.triangles, b.triangles) && have_same_bytes(a.edges, b.edges) &&
           have_same_bytes(a.codimensional_points, b.codimensional_points) && a.vertices == b.vertices;
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
