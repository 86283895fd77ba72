// SPDX-License-Identifier: MIT
#include "core/contact/friction.hpp"

#include <cmath>
#include <utility>

#include "core/base/parallel.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

// A contact at given poses: how far it has slid, and where its material points are relative to the bodies' positions.
struct Slide {
    Vector3 arm_first, arm_second;
    double u1, u2, distance;
};

Slide slide_of(const FrictionContact& c, const Pose& first, const Pose& second) {
    Slide s;
    s.arm_first = first.rotation * c.point_first;
    s.arm_second = second.rotation * c.point_second;
    const Vector3 moved = (first.position - second.position) + (s.arm_first - s.arm_second) - c.separation_reference;
    s.u1 = c.tangent_1.dot(moved);
    s.u2 = c.tangent_2.dot(moved);
    s.distance = std::sqrt(s.u1 * s.u1 + s.u2 * s.u2);
    return s;
}

FrictionContact lag_contact(const ContactPair& pair, const Pose& first, const Pose& second, const Matrix34& reference_first,
                            const Matrix34& reference_second) {
    const auto& w = pair.closest.weight;
    const int n = geometry::first_count(pair.type);
    Vector3 a = Vector3::Zero(), b = Vector3::Zero();
    for (int i = 0; i < n; ++i) a += w[i] * (pair.x[i] - first.position);
    for (int i = n; i < 4; ++i) b -= w[i] * (pair.x[i] - second.position);
    const Vector3 normal = contact_normal(pair);
    a -= pair.round.reach[0] * normal;
    b += pair.round.reach[1] * normal;
    FrictionContact c;
    c.point_first = first.rotation.transpose() * a;
    c.point_second = second.rotation.transpose() * b;
    const auto placed = [](const Matrix34& p, const Vector3& X) { return Vector3(p.leftCols<3>() * X + p.col(3)); };
    c.separation_reference = placed(reference_first, c.point_first) - placed(reference_second, c.point_second);
    c.tangent_1 = normal.unitOrthogonal();
    c.tangent_2 = normal.cross(c.tangent_1);
    return c;
}

std::size_t contacts_of(const FrictionSet& set) {
    std::size_t count = 0;
    for (const BodyPairFriction& pair : set.pairs) count += pair.contacts.size();
    return count;
}

}  // namespace

FrictionSet lag_friction(const model::Model& model, const ContactSet& contacts, const std::vector<Pose>& poses,
                         const BarrierParameters& parameters, const std::vector<Matrix34>& slip_reference, double slip_time) {
    std::vector<BodyPairFriction> lagged(contacts.pairs.size());
    const int at_once = geometry::pairs_at_once(lagged.size(), static_cast<std::size_t>(contacts.count));
    base::parallel_for(count_of(lagged), at_once, [&](int k) {
        const BodyPairContacts& list = contacts.pairs[k];
        BodyPairFriction& pair = lagged[k];
        pair.first = list.first;
        pair.second = list.second;
        pair.mu = friction_coefficient(model, list.first, list.second);
        if (!(pair.mu > 0)) return;
        pair.contacts.reserve(list.contacts.size());
        for (const ContactPair& contact : list.contacts) {
            const double load = pair.mu * normal_force(contact, parameters);
            if (!(load > 0)) continue;
            pair.contacts.push_back(
                lag_contact(contact, poses[list.first], poses[list.second], slip_reference[list.first], slip_reference[list.second]));
            pair.contacts.back().load = load;
        }
    });
    std::erase_if(lagged, [](const BodyPairFriction& pair) { return pair.contacts.empty(); });
    return {model.friction.eps_v * slip_time, std::move(lagged)};
}

double sliding_share(const FrictionSet& set, const std::vector<Pose>& poses) {
    double all = 0, sliding = 0;
    for (const BodyPairFriction& pair : set.pairs)
        for (const FrictionContact& c : pair.contacts) {
            all += c.load;
            if (slide_of(c, poses[pair.first], poses[pair.second]).distance > set.slip_bound) sliding += c.load;
        }
    return all > 0 ? sliding / all : 0;
}

double friction_potential(const FrictionSet& set, const std::vector<Pose>& poses) {
    std::vector<double> values(set.pairs.size());
    base::parallel_for(count_of(values), geometry::pairs_at_once(values.size(), contacts_of(set)), [&](int k) {
        const BodyPairFriction& pair = set.pairs[k];
        for (const FrictionContact& c : pair.contacts)
            values[k] += c.load * friction_mollifier(slide_of(c, poses[pair.first], poses[pair.second]).distance, set.slip_bound).value;
    });
    double sum = 0;
    for (const double value : values) sum += value;
    return sum;
}

void add_friction_derivatives(const FrictionSet& set, const std::vector<Pose>& poses, HessianKind kind,
                              std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian) {
    const auto make = [&](int k, BodyPairSum& sum) {
        const BodyPairFriction& pair = set.pairs[k];
        for (const FrictionContact& c : pair.contacts) {
            const Slide s = slide_of(c, poses[pair.first], poses[pair.second]);
            const FrictionMollifier f = friction_mollifier(s.distance, set.slip_bound);
            const Vector3 force = c.load * f.first_by_y * (s.u1 * c.tangent_1 + s.u2 * c.tangent_2);
            sum.first.add_force(force, s.arm_first);
            sum.second.add_force(-force, s.arm_second);
            if (kind == HessianKind::none) continue;
            // Along the slide f0'', across it f0' / y; at rest both are 2 / e and any two tangents do.
            const double c1 = s.distance > 0 ? s.u1 / s.distance : 1, c2 = s.distance > 0 ? s.u2 / s.distance : 0;
            const Vector3 along = c1 * c.tangent_1 + c2 * c.tangent_2, across = c1 * c.tangent_2 - c2 * c.tangent_1;
            const double stiffness = kind == HessianKind::projected ? f.first_by_y : f.second;
            add_rigid_stiffness(sum.hessian, c.load * stiffness, along, s.arm_first, s.arm_second);
            add_rigid_stiffness(sum.hessian, c.load * f.first_by_y, across, s.arm_first, s.arm_second);
        }
    };
    add_pair_sums(bodies_of(set.pairs), contacts_of(set), make, kind, gradients, hessian);
}

Vector3 friction_force(const FrictionSet& set, const BodyPairFriction& pair, const FrictionContact& c, const std::vector<Pose>& poses) {
    const Slide s = slide_of(c, poses[pair.first], poses[pair.second]);
    return -c.load * friction_mollifier(s.distance, set.slip_bound).first_by_y * (s.u1 * c.tangent_1 + s.u2 * c.tangent_2);
}

}  // namespace fettle::core::contact
