// SPDX-License-Identifier: MIT
#include "fettle/core/certificate/certificate_checker.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/certificate/certified_body.hpp"
#include "fettle/core/certificate/disjoint_solids.hpp"
#include "fettle/core/certificate/interval_motion.hpp"
#include "fettle/core/certificate/joint_prover.hpp"

namespace fettle::core::certificate {
namespace {

constexpr std::size_t most_faults = 1000;
constexpr int leaf_halvings = 24;

class Checker {
public:
    Checker(const Certificate& certificate, const model::Model& model, const stepper::Trajectory& trajectory)
        : certificate_(certificate), model_(model), trajectory_(trajectory) {}

    CertificateReport run() {
        if (certificate_.version != 2) fault("/fettle_certificate", "version 2 is what this program checks");
        check_hashes();
        if (certificate_.pairs.empty()) fault("/pairs", "there is no pair: nothing is certified");
        if (certificate_.bodies.size() != model_.bodies.size()) fault("/bodies", "one entry per body of the model is wanted");
        if (!report_.accepted()) return report_;
        check_deviations();
        find_places();
        bodies_.resize(model_.bodies.size());
        solids_.resize(model_.bodies.size());
        for (std::size_t i = 0; i < certificate_.pairs.size(); ++i) {
            const PairCertificate& pair = certificate_.pairs[i];
            const std::string where = "/pairs/" + std::to_string(i);
            if (check_pair(pair, where) && check_segments(pair, where + "/segments/")) check_solids(pair, where + "/solids");
        }
        return report_;
    }

private:
    // False: how a check ends that finds one. The list has an end, so that its length tells nothing.
    bool fault(const std::string& where, const std::string& message) { return add(report_, {where, message}), false; }

    static void add(CertificateReport& report, CertificateFault fault) {
        if (report.faults.size() < most_faults) report.faults.push_back(std::move(fault));
    }

    void check_hashes() {
        if (certificate_.geometry_hash != records::geometry_hash(model_)) {
            fault("/geometry_hash", "stale: the certificate is about other meshes");
            report_.stale = true;
        }
        if (certificate_.path_hash != records::path_hash(trajectory_)) {
            fault("/path_hash", "stale: the certificate is about another path");
            report_.stale = true;
        }
    }

    void check_deviations() {
        if (!certificate_.joints) return;
        const IdealJoints& joints = *certificate_.joints;
        const base::Errors errors = check_joints(joints, model_.bodies.size());
        for (const base::Error& e : errors) fault(e.where, e.message);
        if (!errors.empty()) return;
        joints_are_sound_ = true;
        const ProvenDeviations proven = prove_deviations(joints, model_, trajectory_);
        if (!proven.fault.empty()) {
            fault("/joints", proven.fault);
            return;
        }
        for (std::size_t i = 0; i < joints.bodies.size(); ++i)
            if (!(joints.deviations[i] >= proven.of_body[i]))
                fault("/joints/deviations/" + std::to_string(i), "joints may have the body farther from the path than is claimed");
    }

    const SolidMesh& solid(int body) {
        std::optional<SolidMesh>& known = solids_[static_cast<std::size_t>(body)];
        if (!known) known = solid_of(model_.bodies[static_cast<std::size_t>(body)]);
        return *known;
    }

    // Decided here, then compared: the lower bound is proven by now.
    void check_solids(const PairCertificate& pair, const std::string& where) {
        if (pair.solids == Solids::overlap) {
            fault(where, "the solids overlap: there is no clearance to certify");
            return;
        }
        const SolidMesh &a = solid(pair.a), &b = solid(pair.b);
        PairStart start{trajectory_, places_[0].step, places_[0].segment, pair.a, pair.b};
        if (ask_for_path(a, b)) start.path = places_;
        if (joints_are_sound_) start.charge = joint_charge(*certificate_.joints, pair.a, pair.b);
        const Solids found = solids_of(a, b, start, pair.lower);
        if (found == Solids::overlap) {
            fault(where, "one body lies inside the other's material");
            return;
        }
        if (pair.solids == Solids::unproven || pair.solids == found) return;
        fault(where, std::string("\"") + to_string(pair.solids) + "\" is claimed, " +
                         (found == Solids::not_closed   ? "which cannot be verified: a body is not closed"
                          : found == Solids::unverified ? "which cannot be verified: a body is not closed, and the other may lie inside it"
                                                        : std::string("but it is ") + to_string(found)));
    }

    void find_places() {
        places_.clear();
        if (!certificate_.motion) places_.push_back({});
        for (int t = 0; certificate_.motion && t < static_cast<int>(trajectory_.steps.size()); ++t)
            for (int k = 0; k < stepper::segment_count(trajectory_, t); ++k) places_.push_back({t, k});
    }

    bool is_body(int body) const { return body >= 0 && body < static_cast<int>(model_.bodies.size()); }

    // Can the rest of it be looked at?
    bool check_pair(const PairCertificate& pair, const std::string& where) {
        if (!is_body(pair.a) || !is_body(pair.b) || pair.a == pair.b) return fault(where, "a pair of two bodies of the model is wanted");
        if (!(pair.lower >= 0) || !(pair.upper >= pair.lower) || !std::isfinite(pair.upper))
            return fault(where, "bounds with 0 <= lower <= upper are wanted");
        if (!check_upper(pair, where)) return false;
        if (pair.lower == 0) return true;  // nothing to prove
        if (pair.segments.size() != places_.size())
            return fault(where + "/segments", std::to_string(places_.size()) + " proofs are wanted, one per segment of the path");
        return prepare(pair.a, where) && prepare(pair.b, where);
    }

    // All of a pair, on the threads; what is reported is in the order of the path. Is all of it proven?
    bool check_segments(const PairCertificate& pair, const std::string& where) {
        if (pair.lower == 0) return true;
        if (report_.faults.size() == most_faults) return false;  // no more can be told
        std::vector<CertificateReport> reports(places_.size());
        base::parallel_for(static_cast<int>(places_.size()), 1, [&](int i) {
            reports[static_cast<std::size_t>(i)] = check_segment(pair, static_cast<std::size_t>(i), where + std::to_string(i));
        });
        for (CertificateReport& part : reports) {
            report_.leaves += part.leaves;
            report_.pieces += part.pieces;
            for (CertificateFault& found : part.faults) add(report_, std::move(found));
        }
        return std::all_of(reports.begin(), reports.end(), [](const CertificateReport& part) { return part.accepted(); });
    }

    // The body's parts, once; false if its lists are wrong.
    bool prepare(int index, const std::string& where) {
        std::optional<CertifiedBody>& body = bodies_[static_cast<std::size_t>(index)];
        if (!body) {
            auto made =
                certified_body(certificate_.bodies[static_cast<std::size_t>(index)], model_.bodies[static_cast<std::size_t>(index)].mesh);
            for (const base::Error& e : made.errors()) fault("/bodies/" + std::to_string(index) + e.where, e.message);
            body.emplace(made ? std::move(made).value() : CertifiedBody());
        }
        if (body->parts().empty()) fault(where, "the pieces of body " + std::to_string(index) + " are wrong");
        return !body->parts().empty();
    }

    BodyPath path(std::size_t place, int body) const { return body_path(trajectory_, places_[place].step, places_[place].segment, body); }

    CertificateReport check_segment(const PairCertificate& pair, std::size_t place, const std::string& where) const {
        struct Cell {
            Span span;
            int a, b;
        };
        CertificateReport report;
        const auto ended = [&](const std::string& message) { return add(report, {where, message}), report; };
        const SegmentProof& proof = pair.segments[place];
        const std::vector<Part>&parts_a = bodies_[static_cast<std::size_t>(pair.a)]->parts(),
              &parts_b = bodies_[static_cast<std::size_t>(pair.b)]->parts();
        LeafProver prover(path(place, pair.a), path(place, pair.b));
        std::vector<Cell> pending{{{0, 1}, 0, 0}};
        std::size_t leaf = 0;
        for (const char kind : proof.splits) {
            if (pending.empty()) return ended("more cells than the tree has room for");
            const Cell cell = pending.back();
            pending.pop_back();
            const Part &a = parts_a[cell.a], &b = parts_b[cell.b];
            const double middle = 0.5 * (cell.span.start + cell.span.end);
            if (kind == '.') {
                if (leaf >= proof.planes.size()) return ended("the plane of leaf " + std::to_string(leaf) + " is missing");
                const long pieces = prover.prove(a.region, b.region, cell.span, proof.planes[leaf], pair.lower, leaf_halvings);
                report.pieces += pieces;
                report.leaves += pieces > 0;
                if (pieces == 0) add(report, {where + ", leaf " + std::to_string(leaf), "its plane does not prove the lower bound"});
                if (report.faults.size() == most_faults) return report;
                ++leaf;
            } else if (kind == 'a' && a.left >= 0) {
                pending.push_back({cell.span, a.right, cell.b});
                pending.push_back({cell.span, a.left, cell.b});
            } else if (kind == 'b' && b.left >= 0) {
                pending.push_back({cell.span, cell.a, b.right});
                pending.push_back({cell.span, cell.a, b.left});
            } else if (kind == 't' && middle - cell.span.start > 0 && middle - cell.span.start == cell.span.end - middle) {
                pending.push_back({{middle, cell.span.end}, cell.a, cell.b});
                pending.push_back({{cell.span.start, middle}, cell.a, cell.b});
            } else {
                return ended(std::string("a cell cannot be split by `") + kind + "`");
            }
        }
        if (!pending.empty()) return ended("cells are missing: part of the segment is not covered");
        if (leaf < proof.planes.size()) return ended("more planes than leaves");
        return report;
    }

    bool check_upper(const PairCertificate& pair, const std::string& where) {
        const Place place{pair.step, pair.segment};
        const auto is_place = [&](const Place& p) { return p.step == place.step && p.segment == place.segment; };
        const auto found = std::find_if(places_.begin(), places_.end(), is_place);
        if (found == places_.end() || !(pair.s >= 0 && pair.s <= 1)) return fault(where, "the witness's instant is not on the path");
        Interval3 X_a, X_b;
        const auto mesh = [&](int body) -> const geometry::Mesh& { return model_.bodies[static_cast<std::size_t>(body)].mesh; };
        if (!point_of(mesh(pair.a), pair.point_a, X_a) || !point_of(mesh(pair.b), pair.point_b, X_b))
            return fault(where, "the witness's points are not of the bodies");
        const auto index = static_cast<std::size_t>(found - places_.begin());
        const BodyPath a = path(index, pair.a), b = path(index, pair.b);
        const Interval distance = distance_at(a, b, X_a, X_b, pair.s);
        if (!(distance.high <= pair.upper)) return fault(where + "/upper", "the witness's points are farther apart");
        const double size =
            norm_bound(X_a) + norm_bound(X_b) + norm_bound(a.place) + norm_bound(b.place) + norm_bound(a.drift) + norm_bound(b.drift);
        const double turned = 1 + norm_bound(a.theta) + norm_bound(b.theta) + a.speed + b.speed;
        if (!(pair.upper - distance.low <= 1e-11 * size * turned + 1e-300))
            return fault(where + "/upper", "the witness's points are closer: the bound is not attained");
        return true;
    }

    const Certificate& certificate_;
    const model::Model& model_;
    const stepper::Trajectory& trajectory_;
    bool joints_are_sound_ = false;  // as data: the charges can be asked for
    std::vector<Place> places_;
    std::vector<std::optional<CertifiedBody>> bodies_;
    std::vector<std::optional<SolidMesh>> solids_;
    CertificateReport report_;
};

}  // namespace

CertificateReport check_certificate(const Certificate& certificate, const model::Model& model, const stepper::Trajectory& trajectory) {
    FETTLE_ASSERT(!trajectory.poses.empty() && trajectory.poses.front().size() == model.bodies.size(),
                  "a trajectory of the model's bodies");
    return Checker(certificate, model, trajectory).run();
}

}  // namespace fettle::core::certificate
