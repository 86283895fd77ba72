// SPDX-License-Identifier: MIT
#include "core/contact/closest_feature.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::contact {
namespace {

constexpr double least_weight = 1e-12;  // below it a corner has no part in the closest point: rounding must not put it in two faces

bool has_part(double weight) { return std::abs(weight) > least_weight; }

// First vertex of the other edge.
int opposite(int end) { return end < 2 ? 2 : 0; }

}  // namespace

Feature closest_feature(const ContactPair& pair) {
    Feature feature{-1, -1, -1};
    int count = 0;
    for (int k = 1; k < 4; ++k) {
        if (!has_part(pair.closest.weight[k])) continue;
        int at = 0;
        while (at < count && feature[at] < pair.vertex[k]) ++at;
        if (at < count && feature[at] == pair.vertex[k]) continue;  // corners of wires and points coincide
        for (int j = count++; j > at; --j) feature[j] = feature[j - 1];
        feature[at] = pair.vertex[k];
    }
    return feature;
}

void put_on_feature(const Feature& feature, ContactPair& pair) {
    if (feature[2] >= 0) return;
    geometry::ClosestPoints& c = pair.closest;
    const auto vertex = pair.vertex;
    const geometry::PairVertices x = pair.x;
    const auto weight = c.weight;
    const auto free_weight = c.free_weight;
    pair.face = -1;
    const std::array<int, 3> corners{feature[0], feature[1] < 0 ? feature[0] : feature[1], feature[1] < 0 ? feature[0] : feature[1]};
    for (int k = 1; k < 4; ++k) {
        c.weight[k] = 0;
        for (auto& free : c.free_weight) free[k] = 0;
        pair.vertex[k] = corners[k - 1];
    }
    for (int k = 1; k < 4; ++k) {
        const int to = vertex[k] == feature[0] ? 1 : vertex[k] == feature[1] ? 2 : 0;
        if (to == 0) continue;
        pair.x[to] = x[k];
        c.weight[to] += weight[k];
        for (std::size_t a = 0; a < 2; ++a) c.free_weight[a][to] += free_weight[a][k];
    }
    if (feature[1] < 0) pair.x[2] = pair.x[1];
    pair.x[3] = pair.x[2];
    const bool was_elsewhere = c.free_count != (feature[1] < 0 ? 0 : 1);
    if (was_elsewhere) c = closest_points(pair.type, pair.x);
}

int closest_end(const ContactPair& pair) {
    const auto& w = pair.closest.weight;
    const int end = !has_part(w[1]) ? 0 : !has_part(w[0]) ? 1 : !has_part(w[3]) ? 2 : !has_part(w[2]) ? 3 : -1;
    return end >= 0 && edge_cross_squared(pair.x) < pair.mollifier_eps ? -1 : end;
}

void put_on_end(int end, ContactPair& pair) {
    const double sign = end < 2 ? 1 : -1;  // the vertex's body comes first
    const std::array<int, 3> from{end, opposite(end), opposite(end) + 1};
    const Feature feature = feature_opposite(pair, end);
    const auto vertex = pair.vertex;
    const geometry::PairVertices x = pair.x;
    geometry::ClosestPoints& c = pair.closest;
    const auto weight = c.weight;
    const auto free_weight = c.free_weight;
    pair.type = geometry::PairType::point_triangle;
    for (int k = 0; k < 4; ++k) {
        const int i = from[std::min(k, 2)];
        pair.vertex[k] = vertex[i];
        pair.x[k] = x[i];
        c.weight[k] = k == 0 ? 1 : k == 3 ? 0 : sign * weight[i];
        for (std::size_t a = 0; a < 2; ++a) c.free_weight[a][k] = k == 0 || k == 3 ? 0 : sign * free_weight[a][i];
    }
    c.difference *= sign;
    pair.mollifier_eps = 0;
    put_on_feature(feature, pair);
}

Feature feature_opposite(const ContactPair& pair, int end) {
    const int first = opposite(end), second = first + 1;
    const int low = pair.vertex[first], high = pair.vertex[second];
    if (!has_part(pair.closest.weight[second])) return {low, -1, -1};
    if (!has_part(pair.closest.weight[first])) return {high, -1, -1};
    return {std::min(low, high), std::max(low, high), -1};
}

void swap_bodies(ContactPair& pair) {
    pair.x = {pair.x[1], pair.x[0], pair.x[0], pair.x[0]};
    pair.vertex = {pair.vertex[1], pair.vertex[0], pair.vertex[0], pair.vertex[0]};
    pair.closest.difference = -pair.closest.difference;
}

}  // namespace fettle::core::contact
