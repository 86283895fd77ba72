// SPDX-License-Identifier: MIT
/// Areas of vertices and edges (core/model/build_model.cpp: a third of each triangle's that has them) in the shapes' vertices, and the
/// weights that an area-weighted barrier makes of them (core/contact/contact_areas.hpp). A contact's potential is proportional to its
/// weight w, so that its part r of a step's residual along a motion has dr/dw = r/w.
#pragma once

#include <vector>

#include "core/contact/contact_areas.hpp"

namespace fettle::adjoint::contact {

/// For one body: gradient in, or change of, Body::vertex_area and Body::edge_area. Empty: nothing is area-weighted.
struct AreaChange {
    VectorX vertex, edge;
};
AreaChange zero_areas(const core::model::Body& body);

/// vertices_bar += of the areas' gradient; a triangle of exactly zero area contributes 0.
void areas_adjoint(const core::geometry::Mesh& mesh, const AreaChange& areas_bar, Matrix3X& vertices_bar);
AreaChange areas_tangent(const core::geometry::Mesh& mesh, const Matrix3X& vertices_dot);

/// The shares of a configuration's contacts; none if the model is not area-weighted.
core::contact::ContactAreas areas_of_contacts(const core::model::Model& model, const std::vector<core::kinematics::Pose>& poses);

/// The derivative of one contact's weight.
void add_weight_gradient(const std::vector<core::contact::AreaShare>& shares, double weight_bar, std::vector<AreaChange>& areas_bar);
double weight_tangent(const std::vector<core::contact::AreaShare>& shares, const std::vector<AreaChange>& areas_dot);

}  // namespace fettle::adjoint::contact
