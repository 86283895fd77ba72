// SPDX-License-Identifier: MIT
#include "fettle/core/contact/face_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::core::contact {
namespace {

// One to three vertices of the body, ascending; -1 for none.
using Feature = std::array<int, 3>;

Feature edge_feature(int a, int b) { return {std::min(a, b), std::max(a, b), -1}; }

constexpr double least_weight = 1e-12;  // below it a corner has no part in the closest point: rounding must not put it in two faces

// What the closest point of a pair lies in.
Feature closest_feature(const ContactPair& pair) {
    Feature feature{-1, -1, -1};
    int count = 0;
    for (int k = 1; k < 4; ++k) {
        if (!(std::abs(pair.closest.weight[k]) > least_weight)) continue;
        int at = 0;
        while (at < count && feature[at] < pair.vertex[k]) ++at;
        if (at < count && feature[at] == pair.vertex[k]) continue;  // corners of wires and points coincide
        for (int j = count++; j > at; --j) feature[j] = feature[j - 1];
        feature[at] = pair.vertex[k];
    }
    return feature;
}

// Is the element, an edge or a vertex, one of the pair's face, and does the face's closest point lie in it? Then it is the element's too.
bool is_closest_in(const Feature& element, const ContactPair& pair, const Feature& closest) {
    const auto in = [&element](int v) { return v < 0 || v == element[0] || v == element[1]; };
    const auto has = [&pair](int v) { return v < 0 || v == pair.vertex[1] || v == pair.vertex[2] || v == pair.vertex[3]; };
    return in(closest[0]) && in(closest[1]) && closest[2] < 0 && has(element[0]) && has(element[1]);
}

// The same contact as one of a vertex and an edge, or of two vertices: a face whose corners coincide.
ContactPair on_feature(const ContactPair& pair, const Feature& feature) {
    if (feature[2] >= 0) return pair;
    ContactPair out = pair;
    out.face = -1;
    const std::array<int, 3> corners{feature[0], feature[1] < 0 ? feature[0] : feature[1], feature[1] < 0 ? feature[0] : feature[1]};
    auto& c = out.closest;
    for (int k = 1; k < 4; ++k) {
        c.weight[k] = 0;
        for (auto& free : c.free_weight) free[k] = 0;
        out.vertex[k] = corners[k - 1];
    }
    for (int k = 1; k < 4; ++k) {
        const int to = pair.vertex[k] == feature[0] ? 1 : pair.vertex[k] == feature[1] ? 2 : 0;
        if (to == 0) continue;
        out.x[to] = pair.x[k];
        c.weight[to] += pair.closest.weight[k];
        for (std::size_t a = 0; a < 2; ++a) c.free_weight[a][to] += pair.closest.free_weight[a][k];
    }
    if (feature[1] < 0) out.x[2] = out.x[1];
    out.x[3] = out.x[2];
    const bool was_elsewhere = c.free_count != (feature[1] < 0 ? 0 : 1);
    if (was_elsewhere) c = closest_points(out.type, out.x);
    return out;
}

// Of one vertex.
class FaceCount {
public:
    explicit FaceCount(const FaceSide& side) : side_(side) {}

    void add_face(const ContactPair& pair) {
        entries_.push_back({pair, closest_feature(pair), 1});
        if (side_.flat == nullptr || pair.face < 0) return;
        const unsigned bits = side_.flat->of_face(pair.face);
        const geometry::Triangle& corners = side_.body.hierarchy->faces()[pair.face];
        for (int k = 0; k < 3; ++k) {
            if ((bits >> k & 1U) != 0) elements_.push_back(edge_feature(corners[k], corners[(k + 1) % 3]));
            if ((bits >> (3 + k) & 1U) != 0) elements_.push_back({corners[k], -1, -1});
        }
    }

    void add_flat_elements() {
        sort_elements();
        const std::size_t faces = entries_.size();
        for (const Feature& element : elements_) {
            const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(faces);
            const auto known =
                std::find_if(entries_.begin(), end, [&](const Entry& entry) { return is_closest_in(element, entry.pair, entry.feature); });
            const int count = element[1] < 0 ? 1 : -1;
            if (known != end) {
                known->count += count;
                continue;
            }
            const ContactPair pair = pair_with(element);
            const double square = pair.closest.distance_squared;
            if (square < side_.activation * side_.activation) entries_.push_back({pair, closest_feature(pair), count});
        }
    }

    void emit(std::vector<ContactPair>& out) {
        std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& x, const Entry& y) { return x.feature < y.feature; });
        for (auto first = entries_.begin(); first != entries_.end();) {
            auto last = first;
            int count = 0;
            for (; last != entries_.end() && last->feature == first->feature; ++last) count += last->count;
            if (count != 0) {
                out.push_back(on_feature(first->pair, first->feature));
                out.back().weight *= count;
            }
            first = last;
        }
    }

    // Each by itself.
    void emit_elements(std::vector<ContactPair>& out) {
        for (const Entry& entry : entries_) out.push_back(entry.pair);
        sort_elements();
        for (const Feature& element : elements_) {
            const ContactPair pair = pair_with(element);
            if (!(pair.closest.distance_squared < side_.activation * side_.activation)) continue;
            out.push_back(pair);
            out.back().weight *= element[1] < 0 ? 1 : -1;
        }
    }

private:
    struct Entry {
        ContactPair pair;
        Feature feature;
        int count;
    };

    void sort_elements() {
        std::sort(elements_.begin(), elements_.end());
        elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
    }

    ContactPair pair_with(const Feature& element) const {
        ContactPair pair = entries_.front().pair;
        const int a = element[0], b = element[1] < 0 ? a : element[1];
        pair.face = -1;
        pair.vertex = {pair.vertex[0], a, b, b};
        for (int k = 1; k < 4; ++k) pair.x[k] = world_position(side_.pose, side_.body.mesh.vertices.col(pair.vertex[k]));
        pair.closest = closest_points(pair.type, pair.x);
        return pair;
    }

    const FaceSide& side_;
    std::vector<Entry> entries_;
    std::vector<Feature> elements_;  // flat edges and vertices of the faces
};

}  // namespace

void count_faces_once(const FaceSide& side, std::span<const ContactPair> near, std::vector<ContactPair>& out) {
    const auto is_finite = [](const ContactPair& pair) { return std::isfinite(pair.closest.distance_squared); };
    if (!std::all_of(near.begin(), near.end(), is_finite)) {  // of infinite potential: none may be lost
        out.insert(out.end(), near.begin(), near.end());
        return;
    }
    const bool alone = near.size() == 1 && (side.flat == nullptr || near[0].face < 0 || side.flat->of_face(near[0].face) == 0);
    if (alone) {
        out.push_back(side.by_element ? near[0] : on_feature(near[0], closest_feature(near[0])));
        return;
    }
    FaceCount count(side);
    for (const ContactPair& pair : near) count.add_face(pair);
    if (side.by_element) {
        count.emit_elements(out);
        return;
    }
    count.add_flat_elements();
    count.emit(out);
}

}  // namespace fettle::core::contact
