// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/toleranced_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/base/text.hpp"
#include "fettle/core/clearance/body_motions.hpp"
#include "fettle/core/clearance/certificate_builder.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/clearance/pair_certification.hpp"
#include "fettle/core/clearance/toleranced_search.hpp"

namespace fettle::core::clearance {
namespace {

using certificate::Toleranced;
using certificate::TolerancedPair;
using certificate::TolerancedProver;
using certificate::VariableBox;

Witness toleranced_witness(const TolerancedBodies& bodies, const TolerancedEncounter& nearest) {
    const ElementPairDistance& found = nearest.pair;
    Witness w;
    w.kind_a = found.kind_a;
    w.kind_b = found.kind_b;
    w.edge_edge = found.kind_a == Primitive::edge && found.kind_b == Primitive::edge;
    w.vertex_on_a = found.kind_a == Primitive::vertex;
    w.primitive_a = primitive_index(bodies.a, nearest.element_a, found.kind_a, found.corner_a);
    w.primitive_b = primitive_index(bodies.b, nearest.element_b, found.kind_b, found.corner_b);
    w.point_a = found.point_a;
    w.point_b = found.point_b;
    w.distance = found.distance;
    return w;
}

class TolerancedCertification {
public:
    TolerancedCertification(const model::Model& model, const Toleranced& toleranced, const std::vector<PairRequest>& pairs,
                            const ClearanceOptions& options, certificate::Certificate* certificate)
        : model_(model),
          toleranced_(toleranced),
          pairs_(pairs),
          options_(options),
          certificate_(certificate),
          start_(as_assembled(model)),
          usable_(have_usable_numbers(model, start_, {{}})),
          shapes_(body_shapes(model, bodies_of(pairs, count_of(model.bodies)))) {}

    std::vector<PairClearance> run() {
        if (certificate_ != nullptr) start_record();
        std::vector<PairClearance> results(pairs_.size());
        std::mutex report;
        int done = 0;
        const auto count = count_of(pairs_);
        // Each pair is a search of its own: the number of threads cannot change a result.
        base::parallel_for(count, 1, [&](int i) {
            results[i] = certified(static_cast<std::size_t>(i));
            if (!options_.on_pair) return;
            const std::lock_guard<std::mutex> lock(report);
            options_.on_pair(++done, count);
        });
        if (certificate_ != nullptr) drop_unmeasured(*certificate_);
        return results;
    }

private:
    void start_record() {
        std::vector<const PieceTree*> trees;
        for (const BodyShape& shape : shapes_) trees.push_back(shape.tree.get());
        *certificate_ = start_certificate(model_, start_, trees, false, pairs_.size());
        certificate_->toleranced = toleranced_;
    }

    PairClearance certified(std::size_t i) const {
        const PairRequest& request = pairs_[i];
        PairClearance out = unmeasured({request.a, request.b, request.minimum}, "");
        const TolerancedPair pair = toleranced_pair(toleranced_, request.a, request.b);
        out.coordinates = pair.coordinates;
        out.coordinates.insert(out.coordinates.end(), pair.dependents.begin(), pair.dependents.end());
        for (const int k : out.coordinates) out.at.push_back(toleranced_.coordinates[k].start);
        out.deviations = pair.deviations;
        for (const int k : pair.deviations) out.deviations_at.push_back(toleranced_.deviations[k].base);
        if (count_of(pair.coordinates) > certificate::most_coordinates) {
            out.reason = std::to_string(pair.coordinates.size()) + " coordinates move the two against each other; at most " +
                         std::to_string(certificate::most_coordinates) + " can be looked at together";
            return out;
        }
        if (count_of(pair.deviations) > certificate::most_deviations) {
            std::vector<std::string> names;
            for (const int k : pair.deviations) names.push_back("`" + toleranced_.deviations[k].of + "`");
            out.reason = std::to_string(names.size()) + " tolerances matter for the two; at most " +
                         std::to_string(certificate::most_deviations) + " can be looked at together: " + base::joined(names);
            return out;
        }
        for (const int body : {request.a, request.b})
            if (!usable_[body]) {
                out.reason = "its numbers are not finite, or larger than 1e30";
                return out;
            }
        measure(pair, i, out);
        return out;
    }

    void measure(const TolerancedPair& pair, std::size_t index, PairClearance& out) const {
        const BodyShape &shape_a = shapes_[out.a], &shape_b = shapes_[out.b];
        TolerancedProver prover(toleranced_, pair, model_.bodies[out.a].mesh.vertices, model_.bodies[out.b].mesh.vertices);
        if (!prover.is_bounded()) {
            out.reason = "a formula of the two has no value, or no bounded derivative, somewhere within the tolerances";
            return;
        }
        if (!prover.loop_fault().empty()) {
            out.reason = prover.loop_fault();
            return;
        }
        const auto& poses = start_.poses.front();
        const double mismatch =
            prover.mismatch_at_base(poses[out.a], poses[out.b], model_.bodies[out.a].mesh.vertices, model_.bodies[out.b].mesh.vertices);
        if (!(mismatch <= 1e-9 * prover.size())) {
            out.reason = "the formulas of the two are not those of their meshes and start poses";
            return;
        }
        const TolerancedBodies bodies = toleranced_bodies(toleranced_, pair, *shape_a.tree, *shape_b.tree);
        if (!(bodies.slack <= 1e-3 * prover.size())) {
            out.reason = "its numbers are so large that rounding hides the distance";
            return;
        }
        out.tolerance = count_of(pair.coordinates) > 2 && options_.coarse > 0
                            ? std::max(options_.tolerance, options_.coarse * prover.size())
                            : options_.tolerance;
        RangeSearchOptions search;
        search.tolerance = certificate_ != nullptr ? 0.75 * out.tolerance : out.tolerance;
        search.minimum = out.minimum;
        search.max_bounds = options_.max_bounds;
        search.should_stop = options_.should_stop;
        const TolerancedSearchResult found = search_toleranced(bodies, search);
        out.lower = found.lower;
        out.upper = found.upper;
        out.complete = found.complete;
        out.intersecting = found.intersecting;
        out.bounds = found.bounds;
        if (found.nearest.element_a >= 0) take_nearest(bodies, found, out);
        if (certificate_ != nullptr) record(bodies, prover, found, search, out, certificate_->pairs[index]);
        decide_solids(mismatch, out);
        if (certificate_ != nullptr) certificate_->pairs[index].solids = out.is_clash() ? Solids::unproven : out.solids;
        judge(out, {out.a, out.b, out.minimum}, 0, false);
    }

    static void take_nearest(const TolerancedBodies& bodies, const TolerancedSearchResult& found, PairClearance& out) {
        std::size_t k = 0;
        const std::size_t free = bodies.pair.coordinates.size();
        for (std::size_t i = 0; i < free; ++i) out.at[i] = found.nearest.at[k++];
        for (std::size_t i = free; i < out.at.size(); ++i) out.at[i] = found.nearest.dependents[i - free];
        for (double& value : out.deviations_at) value = found.nearest.at[k++];
        out.witness = toleranced_witness(bodies, found.nearest);
        out.witnesses = {out.witness};
    }

    void record(const TolerancedBodies& bodies, TolerancedProver& prover, const TolerancedSearchResult& found,
                const RangeSearchOptions& search, PairClearance& out, certificate::PairCertificate& record) const {
        record.a = out.a;
        record.b = out.b;
        record.at.assign(out.at.begin(), out.at.begin() + static_cast<std::ptrdiff_t>(bodies.pair.coordinates.size()));
        record.at.insert(record.at.end(), out.deviations_at.begin(), out.deviations_at.end());
        if (found.nearest.element_a < 0) return;
        // The claim's proof is the search's own bound: what it leaves is for the order in which the tree is gone through.
        double room = std::min(out.tolerance, std::max(0.0, found.upper - found.lower)) / 8 + 8 * bodies.slack;
        const double above = found.lower - (out.minimum < found.lower ? out.minimum : 0);  // a claim keeps what was decided, if it can
        room = std::max(8 * bodies.slack, std::min(room, 0.5 * above));
        out.lower = found.lower > room ? found.lower - room : 0;
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
        const auto there = prover.distance_at(*bodies.a.mesh, record.point_a, *bodies.b.mesh, record.point_b, at);
        record.upper = there ? std::max(there->high, record.lower) : found.upper;
    }

    // Of the made mesh, whose corners are elsewhere than the tree's.
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

    // Surfaces that never meet leave one thing to ask, whose answer is the same everywhere in the box.
    void decide_solids(double mismatch, PairClearance& out) const {
        if (out.intersecting || !(out.lower > 0)) return;
        certificate::PairStart start{start_, -1, 0, out.a, out.b};
        start.charge = mismatch;
        out.solids = certificate::solids_of(*shapes_[out.a].solid, *shapes_[out.b].solid, start, out.lower);
        if (out.solids != Solids::overlap) return;
        out.lower = out.upper = 0;
    }

    const model::Model& model_;
    const Toleranced& toleranced_;
    const std::vector<PairRequest>& pairs_;
    const ClearanceOptions& options_;
    certificate::Certificate* certificate_;  // null: none is wanted
    const stepper::Trajectory start_;
    const std::vector<char> usable_;  // [body]
    const std::vector<BodyShape> shapes_;
};

}  // namespace

std::vector<PairClearance> certify_toleranced(const model::Model& model, const Toleranced& toleranced,
                                              const std::vector<PairRequest>& pairs, const ClearanceOptions& options) {
    return TolerancedCertification(model, toleranced, pairs, options, nullptr).run();
}

ProvenClearances certify_toleranced_with_proof(const model::Model& model, const Toleranced& toleranced,
                                               const std::vector<PairRequest>& pairs, const ClearanceOptions& options) {
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
