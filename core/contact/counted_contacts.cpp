// SPDX-License-Identifier: MIT
#include "core/contact/counted_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/contact/closest_feature.hpp"

namespace fettle::core::contact {
namespace {

std::uint64_t two(int high, int low) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(high)) << 32 | static_cast<std::uint32_t>(low);
}

// Where a pair stands in the order of its bodies' primitives.
struct Place {
    std::uint64_t first, second;
    int index;
    bool operator<(const Place& other) const { return first != other.first ? first < other.first : second < other.second; }
};

using Contact = CountingPlan::Contact;
using Kind = Contact::Kind;

// A contact-to-be, and its features.
struct Entry {
    std::uint64_t kind_vertex, corners;
    std::uint64_t last_order;  // last corner, then where the entry stands among those with the same features
    int pair;
    int end;
    bool swap;
    double weight;
    bool has_features_of(const Entry& other) const {
        return kind_vertex == other.kind_vertex && corners == other.corners && last_order >> 32 == other.last_order >> 32;
    }
    bool operator<(const Entry& other) const {
        if (kind_vertex != other.kind_vertex) return kind_vertex < other.kind_vertex;
        return corners != other.corners ? corners < other.corners : last_order < other.last_order;
    }
};

Feature edge_feature(int a, int b) { return {std::min(a, b), std::max(a, b), -1}; }

// Is the element, an edge or a vertex, one of the pair's face, and does the face's closest point lie in it? Then it is the element's too.
bool is_closest_in(const Feature& element, const ContactPair& pair, const Feature& closest) {
    const auto in = [&element](int v) { return v < 0 || v == element[0] || v == element[1]; };
    const auto has = [&pair](int v) { return v < 0 || v == pair.vertex[1] || v == pair.vertex[2] || v == pair.vertex[3]; };
    return in(closest[0]) && in(closest[1]) && closest[2] < 0 && has(element[0]) && has(element[1]);
}

bool are_finite(const std::vector<ContactPair>& pairs) {
    return std::all_of(pairs.begin(), pairs.end(), [](const ContactPair& pair) { return std::isfinite(pair.closest.distance_squared); });
}

// Surely farther from the segment than `distance`. Not so what is not a number.
bool is_beyond(const Vector3& p, const Vector3& a, const Vector3& b, double distance) {
    constexpr double margin = 1 + 1e-6;  // for rounding, here and in closest_points
    const Vector3 e = b - a, w = p - a;
    const double square = e.squaredNorm();
    const double t = square > 0 ? std::clamp(w.dot(e) / square, 0.0, 1.0) : 0.0;
    return (w - t * e).squaredNorm() > margin * (distance * distance);
}

// Which of a face's corners the vertex is; 0: none.
int corner_of(const ContactPair& pair, int vertex) {
    for (int k = 1; k < 4; ++k)
        if (pair.vertex[k] == vertex) return k;
    return 0;
}

class Counter {
public:
    CountingNotes notes;

    void count(const CountedSides& sides, NearPairs& near, std::vector<ContactPair>& forward, std::vector<ContactPair>& backward) {
        if (!are_finite(near.on_second) || !are_finite(near.on_first) || !are_finite(near.edges)) {  // none may be lost
            emit_as_they_are(near.on_second, forward);
            emit_as_they_are(near.edges, forward);
            emit_as_they_are(near.on_first, backward);
            return;
        }
        if (sides.by_element) {
            emit_elements(sides, sides.second, near.on_second, forward);
            emit_as_they_are(near.edges, forward);
            emit_elements(sides, sides.first, near.on_first, backward);
            return;
        }
        if (notes.plan != nullptr && count_as_planned(sides, near, forward, backward)) return;
        entries_.clear();
        is_repeatable_ = true;
        add_vertices(sides, sides.second, Kind::of_first, near.on_second);
        add_vertices(sides, sides.first, Kind::of_second, near.on_first);
        add_edges(near.edges);
        emit(near, forward, backward);
    }

private:
    // @return whether the plan held. If not, it has the key of what is near now, and nothing else.
    bool count_as_planned(const CountedSides& sides, const NearPairs& near, std::vector<ContactPair>& forward,
                          std::vector<ContactPair>& backward) {
        CountingPlan& plan = *notes.plan;
        find_key(near);
        const auto still_absent = [&](const CountingPlan::Absent& absent) {
            const auto& x = (absent.on_first ? near.on_first : near.on_second)[absent.pair].x;
            return is_beyond(x[0], x[absent.corners[0]], x[absent.corners[1]], sides.activation);
        };
        if (!plan.is_usable || key_ != plan.key || !std::all_of(plan.absent.begin(), plan.absent.end(), still_absent)) {
            plan.is_usable = false;
            plan.key = key_;
            plan.contacts.clear();
            plan.absent.clear();
            return false;
        }
        const auto of_second = std::count_if(plan.contacts.begin(), plan.contacts.end(),
                                             [](const Contact& contact) { return contact.kind == Kind::of_second; });
        backward.reserve(of_second);
        forward.reserve(plan.contacts.size() - static_cast<std::size_t>(of_second));
        for (const Contact& contact : plan.contacts) emit_contact(contact, near, forward, backward);
        return true;
    }

    // All that the counting goes by, but where absent elements are.
    void find_key(const NearPairs& near) {
        key_.resize(2 + 5 * (near.on_second.size() + near.on_first.size()) + 7 * near.edges.size());
        auto at = key_.begin();
        const auto put = [&at](std::initializer_list<int> numbers) { at = std::copy(numbers.begin(), numbers.end(), at); };
        for (const std::vector<ContactPair>* pairs : {&near.on_second, &near.on_first}) {
            put({static_cast<int>(pairs->size())});
            for (const ContactPair& pair : *pairs) {
                const Feature feature = closest_feature(pair);
                put({pair.vertex[0], pair.face, feature[0], feature[1], feature[2]});
            }
        }
        for (const ContactPair& pair : near.edges) {
            const int end = closest_end(pair);
            const Feature feature = end < 0 ? Feature{-1, -1, -1} : feature_opposite(pair, end);
            put({pair.vertex[0], pair.vertex[1], pair.vertex[2], pair.vertex[3], end, feature[0], feature[1]});
        }
    }

    // The element has to be looked at again where the same pairs are near.
    void note_absent(Kind kind, const Feature& element, const std::vector<ContactPair>& pairs, std::size_t first, std::size_t last) {
        if (notes.plan == nullptr) return;
        for (std::size_t k = first; k < last; ++k) {
            const ContactPair& pair = pair_at(pairs, k);
            const int a = corner_of(pair, element[0]), b = element[1] < 0 ? a : corner_of(pair, element[1]);
            if (a == 0 || b == 0) continue;
            notes.plan->absent.push_back({kind == Kind::of_second, order_[k].index, {a, b}});
            return;
        }
        is_repeatable_ = false;
    }

    void find_order(const std::vector<ContactPair>& pairs) {
        order_.clear();
        for (const ContactPair& pair : pairs) {
            const auto& v = pair.vertex;
            const int index = count_of(order_);
            if (pair.type == geometry::PairType::edge_edge)
                order_.push_back({two(v[0], v[1]), two(v[2], v[3]), index});
            else
                order_.push_back({two(v[0], 0), two(pair.face, 0), index});
        }
        std::sort(order_.begin(), order_.end());
    }

    void emit_as_they_are(const std::vector<ContactPair>& pairs, std::vector<ContactPair>& out) {
        find_order(pairs);
        for (const Place& place : order_) out.push_back(pairs[place.index]);
    }

    // Calls visit(first, last) for the places of each vertex.
    template <class Visit>
    void for_each_vertex(const std::vector<ContactPair>& pairs, const Visit& visit) {
        find_order(pairs);
        for (std::size_t first = 0; first < order_.size();) {
            std::size_t last = first;
            while (last < order_.size() && order_[last].first == order_[first].first) ++last;
            visit(first, last);
            first = last;
        }
    }

    const ContactPair& pair_at(const std::vector<ContactPair>& pairs, std::size_t place) const { return pairs[order_[place].index]; }

    // Flat edges and vertices of the faces in elements_, each once.
    void find_elements(const ContactSide& faces, const std::vector<ContactPair>& pairs, std::size_t first, std::size_t last) {
        elements_.clear();
        if (faces.flat == nullptr) return;
        for (std::size_t k = first; k < last; ++k) {
            const int face = pair_at(pairs, k).face;
            const unsigned bits = face < 0 ? 0 : faces.flat->of_face(face);
            if (bits == 0) continue;
            const geometry::Triangle& corners = faces.body.hierarchy->faces()[face];
            for (int j = 0; j < 3; ++j) {
                if ((bits >> j & 1U) != 0) elements_.push_back(edge_feature(corners[j], corners[(j + 1) % 3]));
                if ((bits >> (3 + j) & 1U) != 0) elements_.push_back({corners[j], -1, -1});
            }
        }
        std::sort(elements_.begin(), elements_.end());
        elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
    }

    static int sign_of(const Feature& element) { return element[1] < 0 ? 1 : -1; }

    static ContactPair pair_with(const ContactSide& faces, const Feature& element, const ContactPair& of_vertex) {
        ContactPair pair = of_vertex;
        const int a = element[0], b = element[1] < 0 ? a : element[1];
        pair.face = -1;
        pair.vertex = {pair.vertex[0], a, b, b};
        for (int k = 1; k < 4; ++k) pair.x[k] = world_position(faces.pose, faces.body.mesh.vertices.col(pair.vertex[k]));
        pair.closest = closest_points(pair.type, pair.x);
        return pair;
    }

    void emit_elements(const CountedSides& sides, const ContactSide& faces, const std::vector<ContactPair>& pairs,
                       std::vector<ContactPair>& out) {
        for_each_vertex(pairs, [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) out.push_back(pair_at(pairs, k));
            find_elements(faces, pairs, first, last);
            for (const Feature& element : elements_) {
                ContactPair pair = pair_with(faces, element, pair_at(pairs, first));
                if (!(pair.closest.distance_squared < sides.activation * sides.activation)) continue;
                pair.weight *= sign_of(element);
                out.push_back(pair);
            }
        });
    }

    void add_entry(Kind kind, int vertex, const Feature& feature, int pair, int end, double weight) {
        const bool swap = kind == Kind::of_second && feature[1] < 0;
        const int order = count_of(entries_);
        if (swap)
            entries_.push_back(
                {two(static_cast<int>(Kind::of_first), feature[0]), two(vertex, -1), two(-1, order), pair, end, true, weight});
        else
            entries_.push_back(
                {two(static_cast<int>(kind), vertex), two(feature[0], feature[1]), two(feature[2], order), pair, end, false, weight});
    }

    void add_vertices(const CountedSides& sides, const ContactSide& faces, Kind kind, std::vector<ContactPair>& pairs) {
        for_each_vertex(pairs, [&](std::size_t first, std::size_t last) {
            const int vertex = pair_at(pairs, first).vertex[0];
            const double weight = pair_at(pairs, first).weight;
            features_.clear();
            for (std::size_t k = first; k < last; ++k) {
                features_.push_back(closest_feature(pair_at(pairs, k)));
                add_entry(kind, vertex, features_.back(), order_[k].index, -1, weight);
            }
            find_elements(faces, pairs, first, last);
            for (const Feature& element : elements_) {
                std::size_t known = first;
                while (known < last && !is_closest_in(element, pair_at(pairs, known), features_[known - first])) ++known;
                if (known < last) {
                    add_entry(kind, vertex, features_[known - first], order_[known].index, -1, sign_of(element) * weight);
                    continue;
                }
                const ContactPair pair = pair_with(faces, element, pair_at(pairs, first));
                if (!(pair.closest.distance_squared < sides.activation * sides.activation)) {
                    note_absent(kind, element, pairs, first, last);
                    continue;
                }
                is_repeatable_ = false;
                add_entry(kind, vertex, closest_feature(pair), count_of(pairs), -1, sign_of(element) * weight);
                pairs.push_back(pair);
            }
        });
    }

    void add_edges(const std::vector<ContactPair>& pairs) {
        find_order(pairs);
        for (const Place& place : order_) {
            const ContactPair& pair = pairs[place.index];
            const int end = closest_end(pair);
            if (end < 0)
                add_entry(Kind::of_edges, pair.vertex[0], {pair.vertex[1], pair.vertex[2], pair.vertex[3]}, place.index, end, pair.weight);
            else
                add_entry(end < 2 ? Kind::of_first : Kind::of_second, pair.vertex[end], feature_opposite(pair, end), place.index, end,
                          pair.weight);
        }
    }

    // Contacts with the same features take the first one's numbers.
    void emit(const NearPairs& near, std::vector<ContactPair>& forward, std::vector<ContactPair>& backward) {
        std::sort(entries_.begin(), entries_.end());
        for (std::size_t first = 0; first < entries_.size();) {
            const Entry& entry = entries_[first];
            double weight = 0;
            std::size_t last = first;
            for (; last < entries_.size() && entries_[last].has_features_of(entry); ++last) weight += entries_[last].weight;
            const std::size_t begin = std::exchange(first, last);
            if (weight == 0) continue;
            const Kind kind = static_cast<Kind>(entry.kind_vertex >> 32);
            const Contact contact{kind, entry.pair, entry.end, entry.swap, weight};
            emit_contact(contact, near, forward, backward);
            if (notes.plan != nullptr) notes.plan->contacts.push_back(contact);
            if (WeightParts* parts = kind == Kind::of_second ? notes.backward_parts : notes.forward_parts) {
                parts->emplace_back();
                for (std::size_t k = begin; k < last; ++k) parts->back().push_back(part_of(entries_[k], kind, near));
            }
        }
        if (notes.plan != nullptr) notes.plan->is_usable = is_repeatable_;
    }

    static void emit_contact(const Contact& contact, const NearPairs& near, std::vector<ContactPair>& forward,
                             std::vector<ContactPair>& backward) {
        std::vector<ContactPair>& out = contact.kind == Kind::of_second ? backward : forward;
        const bool of_first = contact.kind == Kind::of_first && !contact.swap;
        const bool is_of_edges = contact.kind == Kind::of_edges || contact.end >= 0;
        const std::vector<ContactPair>& from = is_of_edges ? near.edges : of_first ? near.on_second : near.on_first;
        ContactPair& pair = out.emplace_back(from[contact.pair]);
        pair.weight = contact.weight;
        if (contact.kind == Kind::of_edges) return;
        if (contact.end >= 0) return put_on_end(contact.end, pair);  // two vertices begin with that of the first body
        put_on_feature(closest_feature(pair), pair);
        if (contact.swap) swap_bodies(pair);
    }

    static WeightPart part_of(const Entry& entry, Kind kind, const NearPairs& near) {
        const auto index = static_cast<std::size_t>(entry.pair);
        const int count = entry.weight < 0 ? -1 : 1;
        if (kind == Kind::of_edges || entry.end >= 0) return {geometry::PairType::edge_edge, false, near.edges[index].vertex, count};
        const bool of_first = kind == Kind::of_first && !entry.swap;
        return {geometry::PairType::point_triangle, !of_first, (of_first ? near.on_second : near.on_first)[index].vertex, count};
    }

    std::vector<Place> order_;
    std::vector<Entry> entries_;
    std::vector<Feature> elements_, features_;
    std::vector<int> key_;
    bool is_repeatable_ = true;  // whatever was counted is of near pairs
};

// Adds the parts of contacts that nothing was merged into.
void add_missing_parts(const std::vector<ContactPair>& contacts, bool of_second, WeightParts& parts) {
    while (parts.size() < contacts.size()) {
        const ContactPair& pair = contacts[parts.size()];
        parts.push_back({{pair.type, of_second, pair.vertex, pair.weight < 0 ? -1 : 1}});
    }
}

}  // namespace

void count_contacts(const CountedSides& sides, NearPairs& near, std::vector<ContactPair>& forward, std::vector<ContactPair>& backward,
                    const CountingNotes& notes) {
    if (near.on_second.empty() && near.on_first.empty() && near.edges.empty()) return;
    static thread_local Counter counter;
    counter.notes = notes;
    counter.count(sides, near, forward, backward);
    if (notes.forward_parts == nullptr) return;
    add_missing_parts(forward, false, *notes.forward_parts);
    add_missing_parts(backward, true, *notes.backward_parts);
}

}  // namespace fettle::core::contact
