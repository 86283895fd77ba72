// SPDX-License-Identifier: MIT
#include "core/clearance/toleranced_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/text.hpp"
#include "core/clearance/box_certification.hpp"
#include "core/clearance/pair_certification.hpp"
#include "core/clearance/shared_ball.hpp"
#include "core/clearance/toleranced_search.hpp"
#include "core/clearance/touching.hpp"
#include "core/clearance/witness_instant.hpp"

namespace fettle::core::clearance {
namespace {

using certificate::Toleranced;
using certificate::TolerancedPair;
using certificate::TolerancedProver;
using certificate::VariableBox;

constexpr long looped_bounds_a_second = 20'000;  // where loops are closed, some seconds
// The solid that one set of deviations makes; its parts refer to each other.
struct MadeSolid {
    MadeSolid(int body, const MadeBodies& made, const geometry::Mesh& drawn)
        : mesh(with_vertices(drawn, made.vertices(body, drawn.vertices))),
          hierarchy(mesh),
          tree(make_piece_tree(mesh, hierarchy)),
          solid(certificate::solid_mesh(mesh)) {}
    MadeSolid(const MadeSolid&) = delete;
    MadeSolid& operator=(const MadeSolid&) = delete;

    SolidBody body() const { return {tree, solid}; }

    static geometry::Mesh with_vertices(geometry::Mesh mesh, Matrix3X vertices) {
        mesh.vertices = std::move(vertices);
        return mesh;
    }

    geometry::Mesh mesh;
    geometry::BodyHierarchy hierarchy;
    PieceTree tree;
    certificate::SolidMesh solid;
};

class TolerancedCertification : public BoxCertification {
public:
    TolerancedCertification(const model::Model& model, const Toleranced& toleranced, const std::vector<PairRequest>& pairs,
                            const ClearanceOptions& options, certificate::Certificate* certificate)
        : BoxCertification(model, pairs, options, certificate), toleranced_(toleranced) {}

private:
    void name_box(certificate::Certificate& certificate) const override { certificate.toleranced = toleranced_; }

    PairClearance certified(std::size_t i) const override {
        const PairRequest& asked = request(i);
        PairClearance out = unmeasured({asked.a, asked.b, asked.minimum}, "");
        const TolerancedPair pair = toleranced_pair(toleranced_, asked.a, asked.b);
        out.coordinates = pair.coordinates;
        out.coordinates.insert(out.coordinates.end(), pair.dependents.begin(), pair.dependents.end());
        for (const int k : out.coordinates) out.at.push_back(toleranced_.coordinates[k].start);
        out.deviations = pair.deviations;
        for (const int k : pair.deviations) out.deviations_at.push_back(toleranced_.deviations[k].base);
        out.reason = obstacle(asked, count_of(pair.coordinates));
        const int most_deviations = std::min(certificate::most_deviations, certificate::most_variables - count_of(pair.coordinates));
        if (out.reason.empty() && count_of(pair.deviations) > most_deviations) {
            std::vector<std::string> names;
            for (const int k : pair.deviations) names.push_back("`" + toleranced_.deviations[k].of + "`");
            out.reason = std::to_string(names.size()) + " tolerances matter for the two; at most " + std::to_string(most_deviations) +
                         " can be looked at together: " + base::joined(names);
        }
        if (out.reason.empty()) measure(pair, i, out);
        return out;
    }

    void measure(const TolerancedPair& pair, std::size_t index, PairClearance& out) const {
        const Matrix3X &a = model_.bodies[out.a].mesh.vertices, &b = model_.bodies[out.b].mesh.vertices;
        TolerancedProver prover(toleranced_, pair, a, b);
        out.reason = prover.loop_fault();
        if (!prover.is_bounded())
            out.reason = "a formula of the two has no value, or no bounded derivative, somewhere within the tolerances";
        if (!out.reason.empty()) return;
        const double mismatch = prover.mismatch_at_base(start(out.a), start(out.b), a, b);
        if (!(mismatch <= 1e-9 * prover.size())) {
            out.reason = "the formulas of the two are not those of their meshes and start poses";
            return;
        }
        const TolerancedBodies bodies = toleranced_bodies(toleranced_, pair, prover, *shape(out.a).tree, *shape(out.b).tree);
        if (!(bodies.slack <= 1e-3 * prover.size())) {
            out.reason = "its numbers are so large that rounding hides the distance";
            return;
        }
        const long a_second = pair.loops.empty() ? 4 * looped_bounds_a_second : looped_bounds_a_second;
        const BoxSearchOptions search = search_options(out, count_of(pair.coordinates), prover.size(), a_second);
        const TolerancedSearchResult found = search_toleranced(bodies, search);
        take_bounds(found, out);
        if (found.nearest.element_a >= 0) take_nearest(bodies, found, out);
        if (found.lower == 0 && found.nearest.element_a >= 0 && !found.intersecting && share_a_ball(bodies, prover, found.nearest.at)) {
            out.solids = Solids::overlap;
            out.upper = 0;
        }
        if (is_recorded()) write_record(bodies, found, search, out, record(index));
        finish(index, mismatch, out);
    }

    // Somewhere within the tolerances, as made there.
    bool share_a_ball(const TolerancedBodies& bodies, TolerancedProver& prover, VariableBox::Values at) const {
        const auto place_of = [&](const VariableBox::Values& values, const auto& use) {
            const auto dependents = prover.dependents_at(values);
            if (!dependents) return;
            const AllValues all = all_values(toleranced_, bodies.pair, values, *dependents);
            const MadeBodies made(toleranced_, all.deviations);
            const MadeSolid a(bodies.pair.of_a, made, *bodies.a.mesh), b(bodies.pair.of_b, made, *bodies.b.mesh);
            use(a.body(), b.body(),
                pair_held(made.pose(bodies.pair.of_a, all.coordinates), made.pose(bodies.pair.of_b, all.coordinates), a.tree.radius(),
                          b.tree.radius()));
        };
        const VariableBox& box = prover.box();
        const double touch = default_touch_depth(*bodies.a.mesh, *bodies.b.mesh);
        return find_shared_ball(box.low, box.high, bodies.pair.variables(), touch, place_of, at);
    }

    static void take_nearest(const TolerancedBodies& bodies, const TolerancedSearchResult& found, PairClearance& out) {
        std::size_t k = 0;
        const std::size_t free = bodies.pair.coordinates.size();
        for (std::size_t i = 0; i < free; ++i) out.at[i] = found.nearest.at[k++];
        for (std::size_t i = free; i < out.at.size(); ++i) out.at[i] = found.nearest.dependents[i - free];
        for (double& value : out.deviations_at) value = found.nearest.at[k++];
        out.witness = witness_between(bodies.a, bodies.b, found.nearest.element_a, found.nearest.element_b, found.nearest.pair);
        out.witnesses = {out.witness};
    }

    void write_record(const TolerancedBodies& bodies, const TolerancedSearchResult& found, const BoxSearchOptions& search,
                      PairClearance& out, certificate::PairCertificate& record) const {
        record.a = out.a;
        record.b = out.b;
        record.at.assign(out.at.begin(), out.at.begin() + static_cast<std::ptrdiff_t>(bodies.pair.coordinates.size()));
        record.at.insert(record.at.end(), out.deviations_at.begin(), out.deviations_at.end());
        if (found.nearest.element_a < 0) return;
        make_claim(bodies.slack, out);  // the claim's proof is the search's own bound
        certificate::BoxProof proof;
        if (out.lower > 0) proof = prove_toleranced(bodies, out.lower, search);
        if (proof.splits.empty()) out.lower = 0;
        if (out.lower > 0) record.boxes = {std::move(proof)};
        record.lower = out.lower;
        const AllValues all = all_values(toleranced_, bodies.pair, found.nearest.at, found.nearest.dependents);
        const MadeBodies made(toleranced_, all.deviations);
        const ElementPairDistance& near = found.nearest.pair;
        record.point_a = point(made, bodies.a, out.a, all, found.nearest.element_a, near, near.kind_a, near.corner_a, near.point_a);
        record.point_b = point(made, bodies.b, out.b, all, found.nearest.element_b, near, near.kind_b, near.corner_b, near.point_b);
        VariableBox::Values at{};
        std::copy(record.at.begin(), record.at.end(), at.begin());
        const auto there = bodies.prover.distance_at(*bodies.a.mesh, record.point_a, *bodies.b.mesh, record.point_b, at);
        record.upper = there ? std::max(there->high, record.lower) : found.upper;
    }

    // A point of the made mesh, whose corners are elsewhere than the tree's.
    certificate::CertifiedPoint point(const MadeBodies& made, const PieceTree& tree, int body, const AllValues& all, int element,
                                      const ElementPairDistance& near, Primitive kind, int corner, const Vector3& x) const {
        const kinematics::Pose pose = made.pose(body, all.coordinates);
        geometry::Mesh mesh = *tree.mesh;
        mesh.vertices = made.vertices(body, tree.mesh->vertices);
        PieceTree moved;
        moved.mesh = &mesh;
        moved.elements = tree.elements;
        for (PieceElement& each : moved.elements)
            for (Eigen::Index i = 0; i < 3; ++i)
                each.corners.x.col(i) = mesh.vertices.col(
                    each.vertices[static_cast<std::size_t>(std::min(i, static_cast<Eigen::Index>(each.corners.count) - 1))]);
        return certified_witness(moved, element, near.intersecting, {kind, corner}, pose.rotation.transpose() * (x - pose.position));
    }

    const Toleranced& toleranced_;
};

}  // namespace

std::vector<PairClearance> certify(const model::Model& model, const Toleranced& toleranced, const std::vector<PairRequest>& pairs,
                                   const ClearanceOptions& options) {
    return TolerancedCertification(model, toleranced, pairs, options, nullptr).run();
}

ProvenClearances certify_with_proof(const model::Model& model, const Toleranced& toleranced, const std::vector<PairRequest>& pairs,
                                    const ClearanceOptions& options) {
    ProvenClearances proven;
    proven.pairs = TolerancedCertification(model, toleranced, pairs, options, &proven.certificate).run();
    return proven;
}

kinematics::Pose pose_at_witness(const Toleranced& toleranced, const PairClearance& pair, int body) {
    std::vector<double> coordinates = start_coordinates(toleranced), deviations = base_deviations(toleranced);
    for (std::size_t k = 0; k < pair.at.size(); ++k) coordinates[pair.coordinates[k]] = pair.at[k];
    for (std::size_t k = 0; k < pair.deviations_at.size(); ++k) deviations[pair.deviations[k]] = pair.deviations_at[k];
    return MadeBodies(toleranced, deviations).pose(body, coordinates);
}

}  // namespace fettle::core::clearance
