// SPDX-License-Identifier: MIT
#include "adjoint/model/body_mass_adjoint.hpp"

#include <algorithm>

#include "adjoint/scene/mass_kind_adjoint.hpp"
#include "core/base/contract.hpp"
#include "core/linear/factorisations.hpp"
#include "core/model/body_mass.hpp"

namespace fettle::adjoint::model {
namespace {

using core::model::Body;
using core::model::least_inertia;
using core::scene::MassKind;

// What wires and points get so that they resist being turned about every axis.
struct AddedInertia {
    bool is_any = false;
    double mass = 0, radius = 0;
    Eigen::Index farthest = -1;  // the vertex that the radius is of; -1: the radius is dhat
    Eigen::Vector4d first;       // M e4 without it
    Vector3 longest;             // u

    AddedInertia(const Body& body, double dhat, const Matrix4& unit_moments) {
        if (body.mass_kind != MassKind::length && body.mass_kind != MassKind::vertex) return;
        const Matrix4 moments = body.density * unit_moments;
        first = moments.col(3);
        mass = first[3];
        const Matrix3 central = moments.topLeftCorner<3, 3>() - first.head<3>() * first.head<3>().transpose() / mass;
        const core::linear::SymmetricEigen<3> eigen = core::linear::symmetric_eigen<3>(central);
        longest = eigen.vectors.col(2);
        body.mesh.vertices.colwise().squaredNorm().maxCoeff(&farthest);
        if (!(body.radius > dhat)) farthest = -1;
        radius = std::max(body.radius, dhat);
        is_any = least_inertia * mass * radius * radius > eigen.values[0] + eigen.values[1];
    }

    // d(lacking)/dM, symmetric, r held.
    Matrix4 moments_gradient() const {
        Matrix4 out = Matrix4::Zero();
        const Matrix3 across = Matrix3::Identity() - longest * longest.transpose();
        const Vector3 centre = first.head<3>() / mass;
        out.topLeftCorner<3, 3>() = -across;
        out.topRightCorner<3, 1>() = across * centre;
        out.bottomLeftCorner<1, 3>() = out.topRightCorner<3, 1>().transpose();
        out(3, 3) = least_inertia * radius * radius - centre.dot(across * centre);
        return out;
    }

    Vector3 vertex_gradient(const Body& body) const { return 2 * least_inertia * mass * Vector3(body.mesh.vertices.col(farthest)); }
};

double isotropic(const Matrix4& moments) { return moments.topLeftCorner<3, 3>().trace(); }

}  // namespace

bool has_moments_of_mesh(const Body& body, double dhat) {
    const Matrix4 moments = mass_moments(body, dhat);
    return (body.moments - moments).norm() <= 1e-9 * moments.norm();
}

Errors check_masses(const core::model::Model& model) {
    Errors errors;
    for (const Body& body : model.bodies) {
        const bool is_held = std::all_of(body.prescribed.begin(), body.prescribed.end(), [](const auto& dof) { return dof.has_value(); });
        if (is_held || body.given_mass || has_moments_of_mesh(body, model.dhat)) continue;
        errors.push_back({core::base::ErrorCode::unsupported, body.name,
                          "'" + body.name + "' cannot be differentiated: its mass is not that of its mesh and density"});
    }
    return errors;
}

void mass_moments_adjoint(const Body& body, double dhat, const Matrix4& moments_bar, BodyGradient& bar) {
    if (body.given_mass || moments_bar.isZero(0)) return;
    FETTLE_ASSERT(has_moments_of_mesh(body, dhat), "the body's moments are those of its mesh");
    const Matrix4 unit = core::scene::unit_moments(body.mesh, body.mass_kind);
    Matrix4 plain_bar = moments_bar;
    const AddedInertia added(body, dhat, unit);
    if (added.is_any) {
        const double lacking_bar = 0.5 * isotropic(moments_bar);
        plain_bar += lacking_bar * added.moments_gradient();
        if (added.farthest >= 0) bar.vertices_bar.col(added.farthest) += lacking_bar * added.vertex_gradient(body);
    }
    bar.density_bar += plain_bar.cwiseProduct(unit).sum();
    scene::unit_moments_adjoint(body.mesh, body.mass_kind, body.density * plain_bar, bar.vertices_bar);
}

Matrix4 mass_moments_tangent(const Body& body, double dhat, const BodyTangent& dot) {
    if (body.given_mass || !has_moments_of_mesh(body, dhat)) return Matrix4::Zero();
    const Matrix4 unit = core::scene::unit_moments(body.mesh, body.mass_kind);
    Matrix4 out = dot.density_dot * unit + body.density * scene::unit_moments_tangent(body.mesh, body.mass_kind, dot.vertices_dot);
    const AddedInertia added(body, dhat, unit);
    if (!added.is_any) return out;
    double lacking_dot = added.moments_gradient().cwiseProduct(out).sum();
    if (added.farthest >= 0) lacking_dot += added.vertex_gradient(body).dot(dot.vertices_dot.col(added.farthest));
    out.topLeftCorner<3, 3>().diagonal().array() += 0.5 * lacking_dot;
    return out;
}

}  // namespace fettle::adjoint::model
