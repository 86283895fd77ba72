// SPDX-License-Identifier: MIT
#include "core/ccd/plane_edges.hpp"

#include "core/base/rounding.hpp"

namespace fettle::core::ccd {

const geometry::FlatFeatures* flat_features_of(const model::Model& model, const model::Body& body) {
    constexpr double negligible = 1e-2;  // of dhat: features left out are nearer than those kept by no more than this
    return body.flat && body.flat->any() && body.flat->height <= negligible * model.dhat ? body.flat.get() : nullptr;
}

const geometry::FlatFeatures* plane_features_of(const model::Model& model, const model::Body& body) {
    constexpr double nothing = 1e-8;  // of dhat: of gaps that no contact comes to
    const geometry::FlatFeatures* flat = flat_features_of(model, body);
    return flat != nullptr && flat->plane_height <= nothing * model.dhat ? flat : nullptr;
}

double lost_by_plane_edges(const model::Model& model, const model::Body& a, const model::Body& b) {
    const auto height = [&](const model::Body& body) {
        const geometry::FlatFeatures* flat = plane_features_of(model, body);
        return flat != nullptr ? flat->plane_height : 0;
    };
    return 2 * (height(a) + height(b)) * base::rounded_up;
}

}  // namespace fettle::core::ccd
