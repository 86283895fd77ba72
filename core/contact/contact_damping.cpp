// SPDX-License-Identifier: MIT
#include "core/contact/contact_damping.hpp"

#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"

namespace fettle::core::contact {
namespace {

int body_of(const BodyPairContacts& list, const ContactPair& pair, int i) {
    return i < geometry::first_count(pair.type) ? list.first : list.second;
}

Eigen::Vector4d material_point(const model::Model& model, const BodyPairContacts& list, const ContactPair& pair, int i) {
    return model.bodies[body_of(list, pair, i)].mesh.vertices.col(pair.vertex[i]).homogeneous();
}

ContactPair pair_at(const model::Model& model, const BodyPairContacts& list, const ContactPair& pair, const std::vector<Matrix34>& poses) {
    ContactPair out = pair;
    for (int i = 0; i < 4; ++i) out.x[i] = poses[body_of(list, pair, i)] * material_point(model, list, pair, i);
    out.closest = closest_points(out.type, out.x);
    return out;
}

bool is_apart(const ContactPair& pair, const BarrierParameters& p) {
    return pair.closest.distance_squared > p.dmin * p.dmin && std::isfinite(pair.closest.distance_squared);
}

void add_damped_pair(const DampedPair& pair, const BarrierParameters& closeness, HessianKind kind, const Vector3& first_position,
                     const Vector3& second_position, BodyPairSum& sum) {
    const double slope = pair.slope();
    const bool closing = slope >= 0 && pair.stiffness >= 0;  // the sum of its positive parts is one
    BodyPairSum phi;
    add_pair_derivatives(pair.end, closeness, closing || kind == HessianKind::none ? kind : HessianKind::exact, first_position,
                         second_position, phi);
    sum.first.force += slope * phi.first.force;
    sum.first.arm += slope * phi.first.arm;
    sum.second.force += slope * phi.second.force;
    sum.second.arm += slope * phi.second.arm;
    if (kind == HessianKind::none) return;
    PairVector gradient;  // the forces are opposite
    gradient << tangent_gradient(phi.first), tangent_gradient(phi.second).tail<3>();
    PairMatrix h = slope * phi.hessian;
    add_outer_product(h, pair.stiffness, gradient);
    sum.hessian += kind == HessianKind::projected && !closing ? positive_part(h) : h;
}

}  // namespace

void set_contact_damping(double damping_share, const BarrierParameters& barrier, ContactDamping& damping) {
    const double gap_hat_squared = barrier.gap_hat * barrier.gap_hat;
    damping.closeness = barrier;
    damping.closeness.factor = 1 / gap_hat_squared;
    damping.factor = damping_share * barrier.factor * gap_hat_squared;
}

DampedPair damped_pair(const model::Model& model, const ContactDamping& damping, const BodyPairContacts& list, const ContactPair& pair) {
    DampedPair out;
    out.end = pair;
    out.end.weight = 1;
    out.start = pair_at(model, list, out.end, damping.start);
    out.stiffness = damping.factor * pair.weight;
    out.closeness = pair_potential(out.end, damping.closeness);
    out.closeness_t0 = pair_potential(out.start, damping.closeness);
    return out;
}

double contact_damping_potential(const DampedContacts& damped) {
    const model::Model& model = damped.model;  // by name: clang 14 captures no structured bindings
    const ContactSet& set = damped.contacts;
    const ContactDamping& damping = damped.damping;
    std::vector<double> values(set.pairs.size());
    base::parallel_for(count_of(set.pairs), geometry::pairs_at_once(set.pairs.size(), static_cast<std::size_t>(set.count)), [&](int k) {
        const BodyPairContacts& list = set.pairs[k];
        for (const ContactPair& contact : list.contacts) {
            const bool apart = is_apart(contact, damping.closeness);
            const DampedPair pair = apart ? damped_pair(model, damping, list, contact) : DampedPair{};
            values[k] += apart ? 0.5 * pair.stiffness * pair.closeness * (pair.closeness - 2 * pair.closeness_t0)
                               : std::numeric_limits<double>::infinity();
        }
    });
    double sum = 0;
    for (const double value : values) sum += value;
    return sum;
}

void add_contact_damping_derivatives(const DampedContacts& damped, const std::vector<kinematics::Pose>& poses, HessianKind kind,
                                     std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian) {
    const model::Model& model = damped.model;  // by name: clang 14 captures no structured bindings
    const ContactSet& set = damped.contacts;
    const ContactDamping& damping = damped.damping;
    const auto make = [&](int k, BodyPairSum& sum) {
        const BodyPairContacts& list = set.pairs[k];
        for (const ContactPair& pair : list.contacts)
            add_damped_pair(damped_pair(model, damping, list, pair), damping.closeness, kind, poses[list.first].position,
                            poses[list.second].position, sum);
    };
    add_pair_sums(bodies_of(set.pairs), static_cast<std::size_t>(set.count), make, kind, gradients, hessian);
}

}  // namespace fettle::core::contact
