// SPDX-License-Identifier: MIT
/// Clearance between some faces of two bodies: the same bodies on the same path, of which these faces are all that there is. What is
/// certified of them (clearance.hpp, range_clearance.hpp) holds of the faces; they have no inside, so that nothing is said of the solids.
#pragma once

#include <vector>

#include "core/clearance/pair_clearance.hpp"
#include "core/geometry/named_faces.hpp"
#include "core/model/model.hpp"

namespace fettle::core::clearance {

/// Triangles of a body; empty: all of it, as the solid that it is.
struct FacesOfBody {
    int body = 0;
    std::vector<int> triangles;
};

class FacesAlone {
public:
    /// @param model  Not needed afterwards. Contract: different bodies of it, triangles of their meshes.
    FacesAlone(const model::Model& model, const FacesOfBody& a, const FacesOfBody& b);

    /// Both bodies as their faces, at their old places in the list. Its joints are those of before.
    const model::Model& model() const { return model_; }

    /// What was found with model(), with the primitives of the whole bodies.
    Witness in_whole(Witness witness) const;
    PairClearance in_whole(PairClearance pair) const;

private:
    model::Model model_;
    geometry::SubMesh a_, b_;  // without triangles: the body is whole
};

}  // namespace fettle::core::clearance
