// SPDX-License-Identifier: MIT
#include "fettle/core/certificate/range_checker.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/certificate/certified_body.hpp"
#include "fettle/core/certificate/disjoint_solids.hpp"
#include "fettle/core/certificate/range_prover.hpp"

namespace fettle::core::certificate {
namespace {

constexpr std::size_t most_range_faults = 1000;
constexpr int box_halvings = 24;

class RangeChecker {
public:
    RangeChecker(const RangeCertificate& certificate, const model::Model& model, const stepper::Trajectory& trajectory)
        : certificate_(certificate), model_(model), trajectory_(trajectory) {}

    CertificateReport run() {
        if (certificate_.version != 1) fault("/fettle_range_certificate", "version 1 is what this program checks");
        check_hashes();
        if (certificate_.pairs.empty()) fault("/pairs", "there is no pair: nothing is certified");
        if (certificate_.bodies.size() != model_.bodies.size()) fault("/bodies", "one entry per body of the model is wanted");
        for (const base::Error& e : check_linkage(certificate_.linkage, model_.bodies.size())) fault(e.where, e.message);
        if (!report_.accepted()) return report_;
        for (const LinkageCoordinate& c : certificate_.linkage.coordinates) starts_.push_back(c.start);
        bodies_.resize(model_.bodies.size());
        solids_.resize(model_.bodies.size());
        const auto count = static_cast<int>(certificate_.pairs.size());
        std::vector<CertificateReport> reports(certificate_.pairs.size());
        for (int i = 0; i < count; ++i) prepare_pair(certificate_.pairs[static_cast<std::size_t>(i)], "/pairs/" + std::to_string(i));
        if (!report_.accepted()) return report_;
        base::parallel_for(count, 1, [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            reports[k] = check_pair(certificate_.pairs[k], "/pairs/" + std::to_string(i));
        });
        for (CertificateReport& part : reports) {
            report_.leaves += part.leaves;
            report_.pieces += part.pieces;
            for (CertificateFault& found : part.faults) add(report_, std::move(found));
        }
        return report_;
    }

private:
    struct Cell {
        RangeBox box;
        int a = 0, b = 0;
    };

    static void add(CertificateReport& report, CertificateFault fault) {
        if (report.faults.size() < most_range_faults) report.faults.push_back(std::move(fault));
    }
    void fault(const std::string& where, const std::string& message) { add(report_, {where, message}); }

    void check_hashes() {
        if (certificate_.geometry_hash != records::geometry_hash(model_)) {
            fault("/geometry_hash", "stale: the certificate is about other meshes");
            report_.stale = true;
        }
        if (certificate_.path_hash != records::path_hash(trajectory_)) {
            fault("/path_hash", "stale: the certificate is about other start poses");
            report_.stale = true;
        }
    }

    bool is_body(int body) const { return body >= 0 && body < static_cast<int>(model_.bodies.size()); }
    const geometry::Mesh& mesh(int body) const { return model_.bodies[static_cast<std::size_t>(body)].mesh; }

    // Bounds and shapes of what is listed; what bodies share is made once.
    void prepare_pair(const RangePairCertificate& pair, const std::string& where) {
        if (!is_body(pair.a) || !is_body(pair.b) || pair.a == pair.b) return fault(where, "a pair of two bodies of the model is wanted");
        if (!(pair.lower >= 0) || !(pair.upper >= pair.lower) || !std::isfinite(pair.upper))
            return fault(where, "bounds with 0 <= lower <= upper are wanted");
        for (const int body : {pair.a, pair.b}) {
            std::optional<SolidMesh>& solid = solids_[static_cast<std::size_t>(body)];
            if (!solid) solid = solid_of(model_.bodies[static_cast<std::size_t>(body)]);
            if (pair.lower > 0) prepare_body(body, where);
        }
    }

    void prepare_body(int index, const std::string& where) {
        std::optional<CertifiedBody>& body = bodies_[static_cast<std::size_t>(index)];
        if (!body) {
            auto made = certified_body(certificate_.bodies[static_cast<std::size_t>(index)], mesh(index));
            for (const base::Error& e : made.errors()) fault("/bodies/" + std::to_string(index) + e.where, e.message);
            body.emplace(made ? std::move(made).value() : CertifiedBody());
        }
        if (body->parts().empty()) fault(where, "the pieces of body " + std::to_string(index) + " are wrong");
    }

    const kinematics::Pose& start(int body) const { return trajectory_.poses.front()[static_cast<std::size_t>(body)]; }

    CertificateReport check_pair(const RangePairCertificate& pair, const std::string& where) const {
        CertificateReport report;
        const LinkedPair linked = linked_pair(certificate_.linkage, pair.a, pair.b);
        if (linked.coordinates.size() > static_cast<std::size_t>(most_coordinates) ||
            std::max(linked.a.size(), linked.b.size()) > most_screws) {
            add(report, {where, "more joints between the two than this program checks"});
            return report;
        }
        RangeProver prover(linked, starts_, start(pair.a), start(pair.b));
        check_upper(pair, linked, prover, where, report);
        if (pair.lower > 0) check_tree(pair, linked, prover, where, report);
        if (report.accepted()) check_solids(pair, where + "/solids", report);
        return report;
    }

    RangeBox ranges(const LinkedPair& linked) const {
        RangeBox box;
        for (const int k : linked.coordinates) {
            box.low.push_back(certificate_.linkage.coordinates[static_cast<std::size_t>(k)].low);
            box.high.push_back(certificate_.linkage.coordinates[static_cast<std::size_t>(k)].high);
        }
        return box;
    }

    void check_upper(const RangePairCertificate& pair, const LinkedPair& linked, RangeProver& prover, const std::string& where,
                     CertificateReport& report) const {
        const RangeBox box = ranges(linked);
        bool inside = pair.at.size() == box.low.size();
        for (std::size_t k = 0; inside && k < pair.at.size(); ++k) inside = pair.at[k] >= box.low[k] && pair.at[k] <= box.high[k];
        if (!inside) return add(report, {where + "/at", "the witness's configuration is not in the ranges"});
        Interval3 X_a, X_b;
        if (!point_of(mesh(pair.a), pair.point_a, X_a) || !point_of(mesh(pair.b), pair.point_b, X_b))
            return add(report, {where, "the witness's points are not of the bodies"});
        if (!(prover.magnitude() < 1e30)) return add(report, {where, "numbers that are too large"});
        const Interval distance = prover.distance_at(X_a, X_b, pair.at);
        if (!(distance.high <= pair.upper)) add(report, {where + "/upper", "the witness's points are farther apart"});
        double turned = 1;
        for (std::size_t k = 0; k < box.low.size(); ++k) turned += std::abs(box.high[k] - box.low[k]);
        const double size = norm_bound(X_a) + norm_bound(X_b) + prover.magnitude();
        if (!(pair.upper - distance.low <= 1e-11 * size * turned * (1 + prover.magnitude()) + 1e-300))
            add(report, {where + "/upper", "the witness's points are closer: the bound is not attained"});
    }

    // Decided here, then compared: the lower bound is proven by now.
    void check_solids(const RangePairCertificate& pair, const std::string& where, CertificateReport& report) const {
        if (pair.solids == Solids::overlap) return add(report, {where, "the solids overlap: there is no clearance to certify"});
        const Solids found = solids_of(*solids_[static_cast<std::size_t>(pair.a)], *solids_[static_cast<std::size_t>(pair.b)],
                                       {trajectory_, -1, 0, pair.a, pair.b}, pair.lower);
        if (found == Solids::overlap) return add(report, {where, "one body lies inside the other's material"});
        if (pair.solids == Solids::unproven || pair.solids == found) return;
        add(report, {where, std::string("\"") + to_string(pair.solids) + "\" is claimed, but it is " + to_string(found)});
    }

    // The two parts of a cell; false if it cannot be split so.
    bool split(char kind, const Cell& cell, const std::vector<Part>& parts_a, const std::vector<Part>& parts_b,
               std::vector<Cell>& pending) const {
        const Part &a = parts_a[static_cast<std::size_t>(cell.a)], &b = parts_b[static_cast<std::size_t>(cell.b)];
        Cell first = cell, second = cell;
        if (kind == 'a' && a.left >= 0) {
            first.a = a.left;
            second.a = a.right;
        } else if (kind == 'b' && b.left >= 0) {
            first.b = b.left;
            second.b = b.right;
        } else if (kind >= '0' && kind < '0' + static_cast<int>(cell.box.low.size())) {
            const auto k = static_cast<std::size_t>(kind - '0');
            const double middle = 0.5 * (cell.box.low[k] + cell.box.high[k]);
            if (!(cell.box.low[k] < middle && middle < cell.box.high[k])) return false;
            first.box.high[k] = second.box.low[k] = middle;
        } else {
            return false;
        }
        pending.push_back(std::move(second));
        pending.push_back(std::move(first));
        return true;
    }

    void check_tree(const RangePairCertificate& pair, const LinkedPair& linked, RangeProver& prover, const std::string& where,
                    CertificateReport& report) const {
        const RangeProof& proof = pair.proof;
        const std::vector<Part>&parts_a = bodies_[static_cast<std::size_t>(pair.a)]->parts(),
              &parts_b = bodies_[static_cast<std::size_t>(pair.b)]->parts();
        const auto ended = [&](const std::string& message) { add(report, {where + "/splits", message}); };
        std::vector<Cell> pending{{ranges(linked), 0, 0}};
        const std::size_t corners = std::size_t{1} << linked.coordinates.size();
        std::size_t used = 0;
        long leaf = 0;
        for (const char kind : proof.splits) {
            if (pending.empty()) return ended("more cells than the tree has room for");
            const Cell cell = std::move(pending.back());
            pending.pop_back();
            if (kind == '.' || kind == ':') {
                const std::size_t wanted = kind == '.' ? 1 : corners;
                if (used + wanted > proof.normals.size()) return ended("the vectors of leaf " + std::to_string(leaf) + " are missing");
                const auto first = proof.normals.begin() + static_cast<std::ptrdiff_t>(used);
                used += wanted;
                const long pieces =
                    prover.prove(parts_a[static_cast<std::size_t>(cell.a)].region, parts_b[static_cast<std::size_t>(cell.b)].region,
                                 cell.box, {first, first + static_cast<std::ptrdiff_t>(wanted)}, pair.lower, box_halvings);
                report.pieces += pieces;
                report.leaves += pieces > 0 ? 1 : 0;
                if (pieces == 0) add(report, {where + ", leaf " + std::to_string(leaf), "its vectors do not prove the lower bound"});
                if (report.faults.size() == most_range_faults) return;
                ++leaf;
            } else if (!split(kind, cell, parts_a, parts_b, pending)) {
                return ended(std::string("a cell cannot be split by `") + kind + "`");
            }
        }
        if (!pending.empty()) return ended("cells are missing: part of the ranges is not covered");
        if (used < proof.normals.size()) return ended("more vectors than leaves");
    }

    const RangeCertificate& certificate_;
    const model::Model& model_;
    const stepper::Trajectory& trajectory_;
    std::vector<double> starts_;
    std::vector<std::optional<CertifiedBody>> bodies_;
    std::vector<std::optional<SolidMesh>> solids_;
    CertificateReport report_;
};

}  // namespace

CertificateReport check_range_certificate(const RangeCertificate& certificate, const model::Model& model,
                                          const stepper::Trajectory& trajectory) {
    FETTLE_ASSERT(!trajectory.poses.empty() && trajectory.poses.front().size() == model.bodies.size(),
                  "a trajectory of the model's bodies");
    return RangeChecker(certificate, model, trajectory).run();
}

}  // namespace fettle::core::certificate
