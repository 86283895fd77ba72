// SPDX-License-Identifier: MIT
#include "core/certificate/certificate_checker.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/base/contract.hpp"
#include "core/base/parallel.hpp"
#include "core/certificate/certified_body.hpp"
#include "core/certificate/disjoint_solids.hpp"
#include "core/certificate/interval_motion.hpp"
#include "core/certificate/joint_prover.hpp"
#include "core/certificate/range_prover.hpp"
#include "core/certificate/toleranced_prover.hpp"

namespace fettle::core::certificate {
namespace {

constexpr std::size_t most_faults = 1000;
constexpr std::size_t trees_at_once = 4096;
constexpr int leaf_halvings = 24;
constexpr double largest_mismatch = 1e-9;  // of formulas and meshes, of the bodies' radii

class Checker {
public:
    Checker(const Certificate& certificate, const model::Model& model, const stepper::Trajectory& trajectory)
        : certificate_(certificate), model_(model), trajectory_(trajectory) {}

    CertificateReport run() {
        check_frame();
        if (!report_.accepted()) return report_;
        check_deviations();
        find_places();
        bodies_.resize(model_.bodies.size());
        solids_.resize(model_.bodies.size());
        for (std::size_t first = 0; first < certificate_.pairs.size();) first = check_some(first);
        return report_;
    }

private:
    template <class Box>
    struct Cell {
        Box box;
        int a = 0, b = 0;
    };

    // False: how a check ends that finds one. The list has an end, so that its length tells nothing.
    bool fault(const std::string& where, const std::string& message) { return add(report_, {where, message}), false; }

    static void add(CertificateReport& report, CertificateFault fault) {
        if (report.faults.size() < most_faults) report.faults.push_back(std::move(fault));
    }

    void merge(CertificateReport&& part) {
        report_.leaves += part.leaves;
        report_.pieces += part.pieces;
        for (CertificateFault& found : part.faults) add(report_, std::move(found));
    }

    void check_frame() {
        if (certificate_.version != certificate_version)
            fault("/fettle_certificate", "version " + std::to_string(certificate_version) + " is what this program checks");
        check_hashes();
        if (certificate_.pairs.empty()) fault("/pairs", "there is no pair: nothing is certified");
        if (certificate_.bodies.size() != model_.bodies.size()) fault("/bodies", "one entry per body of the model is expected");
        if (certificate_.toleranced) check_tolerances();
        if (!certificate_.linkage) return;
        if (certificate_.motion || certificate_.joints) fault("/motion", "over ranges of joints there is no path, and no joints along one");
        for (const base::Error& e : check_linkage(*certificate_.linkage, model_.bodies.size())) fault(e.where, e.message);
    }

    void check_tolerances() {
        if (certificate_.motion || certificate_.joints || certificate_.linkage)
            fault("/motion", "over a box of tolerances there is no path, and no other joints than its own");
        std::vector<int> vertices;
        for (const model::Body& body : model_.bodies) vertices.push_back(static_cast<int>(body.mesh.vertices.cols()));
        for (const base::Error& e : check_toleranced(*certificate_.toleranced, vertices)) fault(e.where, e.message);
    }

    void check_hashes() {
        if (certificate_.geometry_hash != records::geometry_hash(model_)) {
            fault("/geometry_hash", "stale: the certificate is about other meshes");
            report_.stale = true;
        }
        if (certificate_.path_hash != records::path_hash(trajectory_)) {
            fault("/path_hash", certificate_.linkage || certificate_.toleranced ? "stale: the certificate is about other start poses"
                                                                                : "stale: the certificate is about another path");
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

    void find_places() {
        if (!certificate_.motion) places_.push_back({});
        for (int t = 0; certificate_.motion && t < count_of(trajectory_.steps); ++t)
            for (int k = 0; k < stepper::segment_count(trajectory_, t); ++k) places_.push_back({t, k});
    }

    const PairCertificate& pair(std::size_t i) const { return certificate_.pairs[i]; }
    static std::string name(std::size_t i) { return "/pairs/" + std::to_string(i); }
    const geometry::Mesh& mesh(int body) const { return model_.bodies[body].mesh; }
    const std::vector<Part>& parts(int body) const { return bodies_[body]->parts(); }

    std::size_t trees_of(const PairCertificate& pair) const { return pair.lower > 0 ? places_.size() : 0; }

    // The pairs from `first` on, as many as give all threads work. @return behind the last of them
    std::size_t check_some(std::size_t first) {
        std::vector<std::size_t> sound, proven;         // pairs
        std::vector<std::array<std::size_t, 2>> trees;  // of a pair, of a place
        std::size_t last = first;
        for (; last < certificate_.pairs.size() && trees.size() < trees_at_once; ++last) {
            if (!check_pair(pair(last), name(last))) continue;
            sound.push_back(last);
            for (std::size_t place = 0; place < trees_of(pair(last)); ++place) trees.push_back({last, place});
        }
        if (report_.faults.size() == most_faults) return last;  // no more can be told
        std::vector<CertificateReport> reports(trees.size());
        base::parallel_for(count_of(trees), 1, [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            const std::size_t of = trees[k][0], place = trees[k][1];
            with_prover(pair(of), place, [&](auto& prover) {
                reports[k] = check_tree(pair(of), pair(of).boxes[place], prover, name(of) + "/boxes/" + std::to_string(place));
            });
        });
        auto next = reports.begin();
        for (const std::size_t i : sound) {
            bool all = true;
            for (std::size_t k = 0; k < trees_of(pair(i)); ++k, ++next) {
                all = all && next->accepted();
                merge(std::move(*next));
            }
            if (all) proven.push_back(i);
        }
        check_solids(proven);
        return last;
    }

    bool is_body(int body) const { return body >= 0 && body < count_of(model_.bodies); }

    // Can the rest of it be looked at?
    bool check_pair(const PairCertificate& pair, const std::string& where) {
        if (!is_body(pair.a) || !is_body(pair.b) || pair.a == pair.b) return fault(where, "a pair of two bodies of the model is expected");
        if (!(pair.lower >= 0) || !(pair.upper >= pair.lower) || !std::isfinite(pair.upper))
            return fault(where, "bounds with 0 <= lower <= upper are expected");
        if (certificate_.linkage) {
            const LinkedPair linked = linked_pair(*certificate_.linkage, pair.a, pair.b);
            if (linked.coordinates.size() > static_cast<std::size_t>(most_coordinates) ||
                std::max(linked.a.size(), linked.b.size()) > static_cast<std::size_t>(most_screws))
                return fault(where, "more joints between the two than this program checks");
        }
        if (certificate_.toleranced && !check_tolerances_of(pair, where)) return false;
        if (!check_upper(pair, where)) return false;
        if (pair.lower == 0) return true;  // nothing to prove
        if (pair.boxes.size() != places_.size())
            return fault(where + "/boxes", std::to_string(places_.size()) + " proofs are expected, one for each box: " +
                                               (certificate_.linkage || certificate_.toleranced ? "the ranges" : "a segment of the path"));
        return prepare(pair.a, where) && prepare(pair.b, where);
    }

    // Few enough variables, and formulas of the meshes and poses at hand.
    bool check_tolerances_of(const PairCertificate& pair, const std::string& where) {
        const TolerancedPair toleranced = toleranced_pair(*certificate_.toleranced, pair.a, pair.b);
        if (count_of(toleranced.coordinates) > most_coordinates || count_of(toleranced.deviations) > most_deviations ||
            toleranced.variables() > most_variables)
            return fault(where, "more joints or deviations matter for the two than this program checks");
        TolerancedProver prover(*certificate_.toleranced, toleranced, mesh(pair.a).vertices, mesh(pair.b).vertices);
        if (!(mismatch_of(pair) <= largest_mismatch * prover.size()))
            return fault(where, "the formulas of its bodies are not those of the meshes and start poses");
        return true;
    }

    double mismatch_of(const PairCertificate& pair) const {
        TolerancedProver prover(*certificate_.toleranced, toleranced_pair(*certificate_.toleranced, pair.a, pair.b), mesh(pair.a).vertices,
                                mesh(pair.b).vertices);
        const auto& start = trajectory_.poses.front();
        return prover.mismatch_at_base(start[pair.a], start[pair.b], mesh(pair.a).vertices, mesh(pair.b).vertices);
    }

    // The body's parts, once; false if its lists are wrong.
    bool prepare(int index, const std::string& where) {
        std::optional<CertifiedBody>& body = bodies_[index];
        if (!body) {
            auto made = certified_body(certificate_.bodies[index], mesh(index));
            for (const base::Error& e : made.errors()) fault("/bodies/" + std::to_string(index) + e.where, e.message);
            body.emplace(made ? std::move(made).value() : CertifiedBody());
        }
        if (body->parts().empty()) fault(where, "the pieces of body " + std::to_string(index) + " are wrong");
        return !body->parts().empty();
    }

    // What moves the pair's bodies over one of its boxes.
    template <class Use>
    void with_prover(const PairCertificate& pair, std::size_t place, const Use& use) const {
        if (certificate_.toleranced) {
            TolerancedProver prover(*certificate_.toleranced, toleranced_pair(*certificate_.toleranced, pair.a, pair.b),
                                    mesh(pair.a).vertices, mesh(pair.b).vertices);
            use(prover);
        } else if (certificate_.linkage) {
            const auto start = [&](int body) { return trajectory_.poses.front()[body]; };
            RangeProver prover(*certificate_.linkage, linked_pair(*certificate_.linkage, pair.a, pair.b), start(pair.a), start(pair.b));
            use(prover);
        } else {
            const auto path = [&](int body) { return body_path(trajectory_, places_[place].step, places_[place].segment, body); };
            PathProver prover(path(pair.a), path(pair.b));
            use(prover);
        }
    }

    bool check_upper(const PairCertificate& pair, const std::string& where) {
        const auto is_its = [&](const Place& place) { return place.step == pair.step && place.segment == pair.segment; };
        const auto found = std::find_if(places_.begin(), places_.end(), is_its);
        if (found == places_.end()) return fault(where, "the witness is at no time of the path");
        Interval3 X_a, X_b;
        if (!point_of(mesh(pair.a), pair.point_a, X_a) || !point_of(mesh(pair.b), pair.point_b, X_b))
            return fault(where, "the witness's points are not of the bodies");
        bool is_attained = false;
        with_prover(pair, static_cast<std::size_t>(found - places_.begin()), [&](auto& prover) {
            const auto at = place_in(prover.box(), prover.coordinates(), pair.at);
            if (!at) {
                fault(where + "/at", "the witness's instant or configuration is not in the box");
                return;
            }
            const Interval distance = distance_at(prover, pair, X_a, X_b, *at);
            if (!(distance.high <= pair.upper))
                fault(where + "/upper", "the witness's points are farther apart");
            else if (!(pair.upper - distance.low <= prover.witness_room(X_a, X_b)))
                fault(where + "/upper", "the witness's points are closer: the bound is not attained");
            else
                is_attained = true;
        });
        return is_attained;
    }

    template <class Prover, class Place>
    Interval distance_at(Prover& prover, const PairCertificate& pair, const Interval3& X_a, const Interval3& X_b, const Place& at) const {
        if constexpr (std::is_same_v<Prover, TolerancedProver>)  // whose points are elsewhere there
            return prover.distance_at(mesh(pair.a), pair.point_a, mesh(pair.b), pair.point_b, at).value();
        else
            return prover.distance_at(X_a, X_b, at);
    }

    template <class Box>
    static auto place_in(const Box& box, int count, const std::vector<double>& at) {
        using Place = std::remove_cv_t<decltype(box.low)>;
        std::optional<Place> none;
        if (at.size() != static_cast<std::size_t>(count)) return none;
        Place out{};
        for (std::size_t k = 0; k < at.size(); ++k) {
            if (!(at[k] >= box.low[k] && at[k] <= box.high[k])) return none;
            out[k] = at[k];
        }
        return std::optional<Place>(out);
    }

    template <class Prover>
    CertificateReport check_tree(const PairCertificate& pair, const BoxProof& proof, Prover& prover, const std::string& where) const {
        CertificateReport report;
        const auto ended = [&](const std::string& message) { return add(report, {where, message}), std::move(report); };
        const std::vector<Part>&parts_a = parts(pair.a), &parts_b = parts(pair.b);
        const std::span<const Vector3> normals(proof.normals);
        using OfBox = Cell<std::decay_t<decltype(prover.box())>>;
        std::vector<OfBox> pending{{prover.box(), 0, 0}};
        std::size_t used = 0;
        long leaf = 0;
        for (const char kind : proof.splits) {
            if (pending.empty()) return ended("more cells than the tree has room for");
            const OfBox cell = pending.back();
            pending.pop_back();
            const Part &a = parts_a[cell.a], &b = parts_b[cell.b];
            if (is_leaf(prover, kind)) {
                const std::size_t count = vectors_of(prover, kind);
                if (used + count > normals.size()) return ended("the vectors of leaf " + std::to_string(leaf) + " are missing");
                const long pieces = pieces_of(prover, a.region, b.region, cell.box, kind, normals.subspan(used, count), pair.lower);
                used += count;
                report.pieces += pieces;
                report.leaves += pieces > 0 ? 1 : 0;
                if (pieces == 0) add(report, {where + ", leaf " + std::to_string(leaf), "its vectors do not prove the lower bound"});
                if (report.faults.size() == most_faults) return report;
                ++leaf;
            } else if (!split(kind, cell, a, b, prover.coordinates(), pending)) {
                return ended(std::string("a cell cannot be split by `") + kind + "`");
            }
        }
        if (!pending.empty()) return ended("cells are missing: part of the box is not covered");
        if (used < normals.size()) return ended("more vectors than leaves");
        return report;
    }

    template <class Prover>
    static bool is_leaf(const Prover& /*prover*/, char kind) {
        return kind == still_leaf || kind == turning_leaf || (kind == round_leaf && std::is_same_v<Prover, RangeProver>);
    }

    template <class Prover>
    static std::size_t vectors_of(const Prover& prover, char kind) {
        if constexpr (std::is_same_v<Prover, TolerancedProver>)
            return kind == still_leaf ? 1 : 1 + static_cast<std::size_t>(prover.coordinates());
        else
            return kind == turning_leaf ? std::size_t{1} << prover.coordinates() : 1;
    }

    template <class Prover, class Box>
    static long pieces_of(Prover& prover, const Region& a, const Region& b, const Box& box, char kind, std::span<const Vector3> normals,
                          double lower) {
        if constexpr (std::is_same_v<Prover, TolerancedProver>)
            return prover.prove(a, b, box, kind, normals, lower);
        else if constexpr (std::is_same_v<Prover, RangeProver>)
            return kind == round_leaf ? prover.prove_round(a, b, box, normals.front(), lower)
                                      : prover.prove(a, b, box, normals, lower, leaf_halvings);
        else
            return prover.prove(a, b, box, normals, lower, leaf_halvings);
    }

    // The two parts of a cell, the first on top; false if it cannot be split so.
    template <class OfBox>
    static bool split(char kind, const OfBox& cell, const Part& a, const Part& b, int coordinates, std::vector<OfBox>& pending) {
        OfBox first = cell, second = cell;
        if (kind == 'a' && a.left >= 0) {
            first.a = a.left;
            second.a = a.right;
        } else if (kind == 'b' && b.left >= 0) {
            first.b = b.left;
            second.b = b.right;
        } else if (const int variable = variable_of_split(kind); variable >= 0 && variable < coordinates) {
            const auto k = static_cast<std::size_t>(variable);
            const double middle = 0.5 * (cell.box.low[k] + cell.box.high[k]);
            if (!(cell.box.low[k] < middle && middle < cell.box.high[k])) return false;
            first.box.high[k] = second.box.low[k] = middle;
        } else {
            return false;
        }
        pending.push_back(second);
        pending.push_back(first);
        return true;
    }

    // Decided here, then compared: the lower bounds are proven by now.
    void check_solids(const std::vector<std::size_t>& proven) {
        for (const std::size_t i : proven)
            for (const int body : {pair(i).a, pair(i).b}) {
                std::optional<SolidMesh>& solid = solids_[body];
                if (!solid) solid = solid_of(model_.bodies[body]);
            }
        std::vector<CertificateReport> reports(proven.size());
        base::parallel_for(count_of(proven), 1, [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            reports[k] = solids_report(pair(proven[k]), name(proven[k]) + "/solids");
        });
        for (CertificateReport& each : reports) merge(std::move(each));
    }

    CertificateReport solids_report(const PairCertificate& pair, const std::string& where) const {
        CertificateReport report;
        const auto ended = [&](const std::string& message) { return add(report, {where, message}), std::move(report); };
        if (pair.solids == Solids::overlap) return ended("the solids overlap: there is no clearance to certify");
        const SolidMesh &a = *solids_[pair.a], &b = *solids_[pair.b];
        PairStart start{trajectory_, places_[0].step, places_[0].segment, pair.a, pair.b};
        if (!certificate_.linkage && !certificate_.toleranced && ask_for_path(a, b)) start.path = places_;
        if (certificate_.toleranced) start.charge = mismatch_of(pair);
        if (joints_are_sound_) start.charge = joint_charge(*certificate_.joints, pair.a, pair.b);
        const Solids found = solids_of(a, b, start, pair.lower);
        if (found == Solids::overlap) return ended("material of one body lies inside the other");
        if (pair.solids == Solids::unproven || pair.solids == found) return report;
        return ended(std::string("\"") + to_string(pair.solids) + "\" is claimed, " +
                     (found == Solids::not_closed   ? "which cannot be verified: a body is not closed"
                      : found == Solids::unverified ? "which cannot be verified: a body is not closed, and the other may lie inside it"
                                                    : std::string("but it is ") + to_string(found)));
    }

    const Certificate& certificate_;
    const model::Model& model_;
    const stepper::Trajectory& trajectory_;
    bool joints_are_sound_ = false;  // as data: the charges can be asked for
    std::vector<Place> places_;      // of the boxes
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
