// SPDX-License-Identifier: MIT
#include "design/gradient_audit/contact_states.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "adjoint/contact/contact_pair_adjoint.hpp"
#include "adjoint/stepper/step_linearisation.hpp"
#include "core/contact/closest_feature.hpp"
#include "core/contact/contact_set.hpp"

namespace fettle::design::gradient_audit {
namespace {

using core::contact::ContactPair;
using core::geometry::PairType;
using core::model::Body;
using core::model::Model;

using Corners = core::contact::Feature;

// Plane faces of a body: which of them a triangle, a flat edge or a flat vertex belongs to, and all their vertices.
class PlaneFaces {
public:
    explicit PlaneFaces(const Body& body) : parent_(body.mesh.triangles.size()) {
        std::iota(parent_.begin(), parent_.end(), 0);
        std::map<Corners, int> triangle_at;  // a flat edge
        for (int f = 0; f < count_of(parent_); ++f)
            for (const Corners& element : flat_elements(body, f))
                if (const auto [known, is_new] = triangle_at.emplace(element, f); !is_new) join(known->second, f);
        for (int f = 0; f < count_of(parent_); ++f) {
            const core::geometry::Triangle& corners = body.mesh.triangles[f];
            const int face = root(f);
            face_of_[ascending(corners)] = face;
            for (const Corners& element : flat_elements(body, f)) face_of_[element] = face;
            vertices_[face].insert(vertices_[face].end(), corners.begin(), corners.end());
        }
        for (auto& [face, vertices] : vertices_) {
            std::sort(vertices.begin(), vertices.end());
            vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        }
    }

    ContactFeature feature_of(const Corners& corners) const {
        if (const auto face = face_of_.find(corners); face != face_of_.end())
            return {ContactFeature::Kind::face, vertices_.at(face->second)};
        ContactFeature out;
        for (const int v : corners)
            if (v >= 0) out.vertices.push_back(v);
        out.kind = out.vertices.size() == 1   ? ContactFeature::Kind::vertex
                   : out.vertices.size() == 2 ? ContactFeature::Kind::edge
                                              : ContactFeature::Kind::face;
        return out;
    }

private:
    static Corners ascending(core::geometry::Triangle corners) {
        std::sort(corners.begin(), corners.end());
        return {corners[0], corners[1], corners[2]};
    }

    // Flat edges and vertices of a triangle.
    static std::vector<Corners> flat_elements(const Body& body, int f) {
        std::vector<Corners> out;
        const unsigned bits = body.flat ? body.flat->of_face(f) : 0U;
        const core::geometry::Triangle& corners = body.mesh.triangles[f];
        for (int k = 0; k < 3 && bits != 0; ++k) {
            const int from = corners[k], to = corners[(k + 1) % 3];
            if ((bits >> k & 1U) != 0) out.push_back({std::min(from, to), std::max(from, to), -1});
            if ((bits >> (3 + k) & 1U) != 0) out.push_back({from, -1, -1});
        }
        return out;
    }

    int root(int f) {
        while (parent_[f] != f) f = parent_[f] = root(parent_[f]);
        return f;
    }
    void join(int f, int g) { parent_[std::max(root(f), root(g))] = std::min(root(f), root(g)); }

    std::vector<int> parent_;
    std::map<Corners, int> face_of_;
    std::map<int, std::vector<int>> vertices_;
};

// The corners of an edge-edge pair: all of the edge where the mollifier acts, which feels more than the closest points.
Corners edge_corners(const ContactPair& pair, int first, bool is_mollified) {
    constexpr double least_weight = 1e-12;  // as closest_feature
    std::vector<int> met;
    for (int k = first; k < first + 2; ++k)
        if (is_mollified || std::abs(pair.closest.weight[k]) > least_weight) met.push_back(pair.vertex[k]);
    std::sort(met.begin(), met.end());
    met.resize(3, -1);
    return {met[0], met[1], met[2]};
}

// The contact states of one step.
class StatesAt {
public:
    StatesAt(const Model& model, const std::vector<PlaneFaces>& faces, const core::energy::StepProblem& problem,
             const std::vector<core::kinematics::Pose>& poses)
        : model_(model), faces_(faces), problem_(problem), poses_(poses) {}

    std::vector<ContactState> find() const {
        std::vector<ContactState> out;
        std::vector<double> weights;
        const core::contact::ContactSet set = core::contact::find_contacts(model_, core::ccd::find_candidates(model_, poses_, 0), poses_);
        for (const core::contact::BodyPairContacts& list : set.pairs)
            for (const ContactPair& pair : list.contacts) {
                out.push_back(state_of(list, pair));
                weights.push_back(pair.weight);
            }
        return counted(out, weights);
    }

private:
    // Contacts of the same features once, and those not at all that flat edges and vertices take back.
    static std::vector<ContactState> counted(const std::vector<ContactState>& states, const std::vector<double>& weights) {
        std::vector<size_t> order(states.size());
        std::iota(order.begin(), order.end(), size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](size_t x, size_t y) { return compare_contacts(states[x], states[y]) < 0; });
        std::vector<ContactState> out;
        for (size_t first = 0, last = 0; first < order.size(); first = last) {
            double sum = 0, all = 0;
            for (; last < order.size() && compare_contacts(states[order[first]], states[order[last]]) == 0; ++last) {
                sum += weights[order[last]];
                all += std::abs(weights[order[last]]);
            }
            if (sum > 1e-9 * all) out.push_back(states[order[first]]);
        }
        return out;
    }

    ContactState state_of(const core::contact::BodyPairContacts& list, const ContactPair& pair) const {
        ContactState s;
        s.is_mollified = adjoint::contact::is_mollified(pair);
        const bool by_edges = pair.type == PairType::edge_edge && pair.round.side == 0;
        const Corners on_first = by_edges ? edge_corners(pair, 0, s.is_mollified) : Corners{pair.vertex[0], -1, -1};
        const Corners on_second = by_edges               ? edge_corners(pair, 2, s.is_mollified)
                                  : pair.round.side == 0 ? closest_feature(pair)
                                                         : Corners{};
        s.a = list.first;
        s.b = list.second;
        const bool is_round = pair.round.side != 0;
        s.on_a = faces_[s.a].feature_of(is_round ? round_feature(s.a, pair, 0) : on_first);
        s.on_b = faces_[s.b].feature_of(is_round ? round_feature(s.b, pair, 1) : on_second);
        Vector3 x_first = Vector3::Zero(), x_second = Vector3::Zero();
        for (int i = 0; i < 4; ++i) {
            const double weight = pair.closest.weight[i];
            (i < first_count(pair.type) ? x_first : x_second) += std::abs(weight) * pair.x[i];
        }
        s.place = 0.5 * (x_first + x_second);
        s.slides = is_sliding(list, pair, x_first, x_second);
        if (s.a < s.b) return s;
        std::swap(s.a, s.b);
        std::swap(s.on_a, s.on_b);
        return s;
    }

    // A side, by its first corner, as contact goes smoothly round it; of a plane or sharp corner its own first vertex.
    Corners round_feature(int body, const ContactPair& pair, std::size_t k) const {
        const int vertex = pair.vertex[k == 0 ? 0 : first_count(pair.type)];
        if (vertex >= 0) return {vertex, -1, -1};
        const core::geometry::RoundSurfaces& round = *model_.bodies[body].round;
        return {round.mesh_sides.sides[round.places[-1 - vertex].side].corners[0].rim[0], -1, -1};
    }

    // s = (1 - n n^T) (x_a - x_b - where the step's slip reference has the same material points).
    bool is_sliding(const core::contact::BodyPairContacts& list, const ContactPair& pair, const Vector3& x_first,
                    const Vector3& x_second) const {
        if (model_.friction.rounds == 0 || !(friction_coefficient(model_, list.first, list.second) > 0)) return false;
        const auto reference = [&](int body, const Vector3& x) {
            const core::kinematics::Pose& pose = poses_[body];
            const Matrix34& slip = problem_.slip_reference[body];
            return Vector3(slip.leftCols<3>() * (pose.rotation.transpose() * (x - pose.position)) + slip.col(3));
        };
        const Vector3 moved = (x_first - reference(list.first, x_first)) - (x_second - reference(list.second, x_second));
        const Vector3 normal = pair.closest.difference.normalized();
        return (moved - normal * normal.dot(moved)).norm() >= model_.friction.eps_v * problem_.slip_time;
    }

    const Model& model_;
    const std::vector<PlaneFaces>& faces_;
    const core::energy::StepProblem& problem_;
    const std::vector<core::kinematics::Pose>& poses_;
};

}  // namespace

const char* to_string(ContactFeature::Kind kind) {
    switch (kind) {
        case ContactFeature::Kind::vertex:
            return "a vertex";
        case ContactFeature::Kind::edge:
            return "an edge";
        case ContactFeature::Kind::face:
            break;
    }
    return "a face";
}

bool adjoin(const ContactFeature& a, const ContactFeature& b) {
    return std::any_of(a.vertices.begin(), a.vertices.end(),
                       [&](int v) { return std::binary_search(b.vertices.begin(), b.vertices.end(), v); });
}

int compare_contacts(const ContactState& x, const ContactState& y) {
    const auto key = [](const ContactState& s) { return std::tie(s.a, s.b, s.on_a.kind, s.on_a.vertices, s.on_b.kind, s.on_b.vertices); };
    return key(x) < key(y) ? -1 : key(y) < key(x) ? 1 : 0;
}

std::vector<std::vector<ContactState>> contact_states(const Model& model, const core::stepper::Trajectory& trajectory) {
    std::vector<PlaneFaces> faces;
    for (const Body& body : model.bodies) faces.emplace_back(body);
    const adjoint::stepper::SweepHistory history = adjoint::stepper::sweep_history(model, trajectory);
    std::vector<std::vector<ContactState>> out;
    for (int t = 0; t < count_of(trajectory.steps); ++t) {
        const core::energy::StepProblem problem = adjoint::stepper::problem_at(model, trajectory, t, history);
        out.push_back(StatesAt(model, faces, problem, trajectory.poses[static_cast<size_t>(t) + 1]).find());
    }
    return out;
}

}  // namespace fettle::design::gradient_audit
