// SPDX-License-Identifier: MIT
#include "core/contact/contact_areas.hpp"

#include <cmath>
#include <map>

#include "core/base/contract.hpp"
#include "core/contact/near_search.hpp"
#include "core/geometry/half_edges.hpp"

namespace fettle::core::contact {
namespace {

class AreaCounter {
public:
    AreaCounter(const model::Model& model, const std::vector<kinematics::Pose>& poses) : model_(model), poses_(poses) {}

    void add(const ccd::BodyPairCandidates& list, const WorldVertices& vertices) {
        NearPairs near;
        find_near({model_, list, poses_, vertices}, near);
        std::vector<ContactPair> forward, backward;
        WeightParts forward_parts, backward_parts;
        count_contacts(counted_sides(model_, list, poses_), near, forward, backward, {&forward_parts, &backward_parts});
        for (const WeightParts* parts : {&forward_parts, &backward_parts})
            for (const std::vector<WeightPart>& contact : *parts) {
                out_.shares.emplace_back();
                for (const WeightPart& part : contact) out_.shares.back().push_back(share_of(list, part));
            }
    }

    ContactAreas take() { return std::move(out_); }

private:
    AreaShare share_of(const ccd::BodyPairCandidates& list, const WeightPart& part) {
        const double factor = 0.5 * part.count;
        if (part.type == geometry::PairType::point_triangle) return {part.of_second ? list.b : list.a, false, part.vertex[0], factor};
        const int a = edge_of(list.a, part.vertex[0], part.vertex[1]), b = edge_of(list.b, part.vertex[2], part.vertex[3]);
        const double area_a = area_of(list.a, a), area_b = area_of(list.b, b);
        constexpr double same = 1e-9;
        if (std::abs(area_a - area_b) <= same * area_a) out_.equal.push_back({list.a, a, list.b, b});
        return area_a <= area_b ? AreaShare{list.a, true, a, factor} : AreaShare{list.b, true, b, factor};
    }

    int edge_of(int body, int a, int b) {
        const auto entry = edges_.try_emplace(body, model_.bodies[body].mesh.edges).first;
        return entry->second.find(a, b);
    }

    double area_of(int body, int edge) const { return model_.bodies[body].edge_area[edge]; }

    const model::Model& model_;
    const std::vector<kinematics::Pose>& poses_;
    std::map<int, geometry::EdgeIndex> edges_;
    ContactAreas out_;
};

}  // namespace

ContactAreas contact_areas(const model::Model& model, const ccd::Candidates& candidates, const std::vector<kinematics::Pose>& poses) {
    FETTLE_ASSERT(model.area_weighted, "only an area-weighted barrier has areas");
    AreaCounter counter(model, poses);
    const WorldVertices vertices(model, candidates, poses);
    for (const ccd::BodyPairCandidates& list : candidates.pairs)
        if (!list.empty()) counter.add(list, vertices);
    return counter.take();
}

}  // namespace fettle::core::contact
