// SPDX-License-Identifier: MIT
/// Contacts between two bodies: of the pairs of primitives that are near, what counts, and how often.
///
/// One vertex over the faces of a body: a plane face is one contact, however it is cut into triangles. Inclusion and exclusion over the
/// faces T near the vertex, the flat edges e and the flat vertices w between them (geometry/flat_features.hpp):
///   sum_T b(T) - sum_e b(e) + sum_w b(w).
/// Over a plane face without notches all terms but the one of the nearest place cancel; round notches what remains is smooth, with a corner
/// that may count -1. Source of the idea: Li, Ferguson, Schneider, Langlois, Zorin, Panozzo, Jiang, Kaufman, "Convergent Incremental
/// Potential Contact", 2023 (section on improved max approximation).
///
/// Contacts with the same closest features (closest_feature.hpp) are one contact, weighted by how often the features count: pairs of edges
/// that meet in a vertex of one, and two vertices that each body's faces name. Where boxes stand on one another that is most of them.
#pragma once

#include <vector>

#include "core/contact/contact_pair.hpp"
#include "core/geometry/flat_features.hpp"
#include "core/model/model.hpp"

namespace fettle::core::contact {

struct ContactSide {
    const model::Body& body;
    const kinematics::Pose& pose;
    const geometry::FlatFeatures* flat = nullptr;  ///< null: nothing is
};

struct CountedSides {
    ContactSide first, second;
    double activation = 0;  ///< [m]
    bool by_element =
        false;  ///< merge nothing, and keep faces, edges and vertices apart: for functions of more than the distance at one time
};

/// All pairs that are closer than the activation distance, `closest` filled, in any order.
struct NearPairs {
    std::vector<ContactPair> on_second;  ///< vertices of the first body over faces of the second
    std::vector<ContactPair> on_first;   ///< vertices of the second over faces of the first
    std::vector<ContactPair> edges;
    void clear() {
        on_second.clear();
        on_first.clear();
        edges.clear();
    }
};

/// A pair that was near and whose weight is in a contact's, `count` times.
struct WeightPart {
    geometry::PairType type = geometry::PairType::point_triangle;
    bool of_second = false;       ///< point_triangle: the vertex is on the second body
    std::array<int, 4> vertex{};  ///< as ContactPair::vertex; point_triangle: only the first
    int count = 1;                ///< 1 or -1
};
/// [contact]: its weight is the sum of these.
using WeightParts = std::vector<std::vector<WeightPart>>;

/// How near pairs were counted. It holds, with the same bits, while the same pairs are near, in the same order, with the same closest
/// features, and nothing flat has come near that was not: at rest that is always so, and most of the work of counting is finding it out
/// anew.
class CountingPlan {
public:
    /// What counts `weight` times: pair number `pair` of a list of NearPairs, as it is, or as the contact of its vertex `end`.
    struct Contact {
        enum class Kind : int { of_first, of_edges, of_second };  ///< whose vertex
        Kind kind;
        int pair, end;
        bool swap;  ///< the other way round
        double weight;
    };
    /// A flat element, by corners of a near pair's face, that was beyond the activation distance of that pair's vertex.
    struct Absent {
        bool on_first;  ///< the face is the first body's
        int pair;
        std::array<int, 2> corners;  ///< into ContactPair::x
    };

    bool is_usable = false;
    std::vector<int> key;  ///< primitives and closest features of the near pairs
    std::vector<Contact> contacts;
    std::vector<Absent> absent;
};

/// What count_contacts returns beside the contacts, each on request.
struct CountingNotes {
    WeightParts *forward_parts = nullptr,
                *backward_parts = nullptr;  ///< both or none: what weights are made of, appended contact by contact
    CountingPlan* plan = nullptr;           ///< of the same two bodies and model before: used if it holds, else made anew
};

/// The order of what comes out depends on the primitives alone.
/// @param near      used up
/// @param forward   appended: contacts whose first primitive is on the first body; two vertices are here, and pairs of edges
/// @param backward  appended: contacts whose first primitive is a vertex of the second
void count_contacts(const CountedSides& sides, NearPairs& near, std::vector<ContactPair>& forward, std::vector<ContactPair>& backward,
                    const CountingNotes& notes = {});

}  // namespace fettle::core::contact
