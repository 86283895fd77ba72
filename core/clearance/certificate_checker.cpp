// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/certificate_checker.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/clearance/interval_motion.hpp"

namespace fettle::core::clearance {
namespace {

using namespace checker;

constexpr std::size_t most_faults = 1000;
constexpr int leaf_halvings = 12;
// Larger regions are their boxes. Pieces of 128 elements, whose boxes the search may turn, have no more corners than this.
constexpr std::size_t most_points = 384;

// A part of a body's list of elements, with the region that its elements lie in.
struct Part {
    int left = -1, right = -1;
    Region region;
};

struct Place {
    int step = -1, segment = 0;
};

// Corners of the element with this number; empty if there is none.
std::vector<int> corners_of(const geometry::Mesh& mesh, int number) {
    const auto triangles = static_cast<int>(mesh.triangles.size()), edges = static_cast<int>(mesh.edges.size());
    if (number < 0) return {};
    if (number < triangles) return {mesh.triangles[number].begin(), mesh.triangles[number].end()};
    if (number < triangles + edges) return {mesh.edges[number - triangles].begin(), mesh.edges[number - triangles].end()};
    if (number - triangles - edges < mesh.vertices.cols()) return {number - triangles - edges};
    return {};
}

// Numbers of the elements that a list has to have: triangles, edges of none of them, vertices of no edge and no triangle.
std::vector<int> wanted_elements(const geometry::Mesh& mesh) {
    std::vector<int> wanted;
    std::set<std::pair<int, int>> of_triangles;
    std::vector<bool> used(static_cast<std::size_t>(mesh.vertices.cols()), false);
    const auto triangles = static_cast<int>(mesh.triangles.size()), edges = static_cast<int>(mesh.edges.size());
    for (int i = 0; i < triangles; ++i) {
        wanted.push_back(i);
        const auto& t = mesh.triangles[i];
        for (int k = 0; k < 3; ++k) of_triangles.insert(std::minmax(t[k], t[(k + 1) % 3]));
        for (const int v : t) used[v] = true;
    }
    for (int i = 0; i < edges; ++i) {
        const auto& e = mesh.edges[i];
        if (of_triangles.count(std::minmax(e[0], e[1])) == 0) wanted.push_back(triangles + i);
        for (const int v : e) used[v] = true;
    }
    for (int v = 0; v < static_cast<int>(used.size()); ++v)
        if (!used[v]) wanted.push_back(triangles + edges + v);
    return wanted;
}

class Checker {
public:
    Checker(const Certificate& certificate, const model::Model& model, const stepper::Trajectory& trajectory)
        : certificate_(certificate), model_(model), trajectory_(trajectory) {}

    CertificateReport run() {
        if (certificate_.version != 1) fault("/fettle_certificate", "version 1 is what this program checks");
        if (certificate_.geometry_hash != stepper::geometry_hash(model_)) fault("/geometry_hash", "the certificate is about other meshes");
        if (certificate_.bodies.size() != model_.bodies.size()) fault("/bodies", "one entry per body of the model is wanted");
        if (!report_.accepted()) return report_;
        find_places();
        parts_.resize(model_.bodies.size());
        for (std::size_t i = 0; i < certificate_.pairs.size(); ++i) check_pair(certificate_.pairs[i], "/pairs/" + std::to_string(i));
        return report_;
    }

private:
    void fault(const std::string& where, const std::string& message) {
        if (report_.faults.size() < most_faults) report_.faults.push_back({where, message});
    }

    void find_places() {
        places_.clear();
        if (!certificate_.motion) places_.push_back({});
        for (int t = 0; certificate_.motion && t < static_cast<int>(trajectory_.steps.size()); ++t)
            for (int k = 0; k < stepper::segment_count(trajectory_, t); ++k) places_.push_back({t, k});
    }

    bool is_body(int body) const { return body >= 0 && body < static_cast<int>(model_.bodies.size()); }

    void check_pair(const PairCertificate& pair, const std::string& where) {
        if (!is_body(pair.a) || !is_body(pair.b) || pair.a == pair.b) return fault(where, "a pair of two bodies of the model is wanted");
        if (!(pair.lower >= 0) || !(pair.upper >= pair.lower) || !std::isfinite(pair.upper))
            return fault(where, "bounds with 0 <= lower <= upper are wanted");
        check_upper(pair, where);
        if (pair.lower == 0) return;  // nothing to prove
        if (pair.segments.size() != places_.size())
            return fault(where + "/segments", std::to_string(places_.size()) + " proofs are wanted, one per segment of the path");
        if (!prepare(pair.a, where) || !prepare(pair.b, where)) return;
        for (std::size_t i = 0; i < places_.size(); ++i) check_segment(pair, i, where + "/segments/" + std::to_string(i));
    }

    // The body's parts with their regions, once; false if its lists are wrong.
    bool prepare(int body, const std::string& where) {
        std::optional<std::vector<Part>>& parts = parts_[static_cast<std::size_t>(body)];
        if (!parts) {
            parts.emplace();
            if (!build_parts(body, *parts)) parts->clear();
        }
        if (parts->empty()) fault(where, "the pieces of body " + std::to_string(body) + " are wrong");
        return !parts->empty();
    }

    bool build_parts(int body, std::vector<Part>& parts) {
        const BodyPieces& pieces = certificate_.bodies[static_cast<std::size_t>(body)];
        const geometry::Mesh& mesh = model_.bodies[static_cast<std::size_t>(body)].mesh;
        const std::string where = "/bodies/" + std::to_string(body);
        const std::set<int> listed(pieces.elements.begin(), pieces.elements.end());
        for (const int number : wanted_elements(mesh)) {
            if (listed.count(number) > 0) continue;
            fault(where + "/elements", "element " + std::to_string(number) + " is missing");
            return false;
        }
        for (const int number : pieces.elements) {
            if (!corners_of(mesh, number).empty()) continue;
            fault(where + "/elements", "there is no element " + std::to_string(number));
            return false;
        }
        return split_parts(pieces, mesh, where, parts);
    }

    bool split_parts(const BodyPieces& pieces, const geometry::Mesh& mesh, const std::string& where, std::vector<Part>& parts) {
        struct Range {
            int first, count, parent;
            bool second;
        };
        std::vector<Range> pending{{0, static_cast<int>(pieces.elements.size()), -1, false}};
        std::size_t next_cut = 0;
        while (!pending.empty()) {
            const Range range = pending.back();
            pending.pop_back();
            const int index = static_cast<int>(parts.size());
            parts.emplace_back();
            if (range.parent >= 0) (range.second ? parts[range.parent].right : parts[range.parent].left) = index;
            if (range.count == 1) {
                set_element(mesh, pieces.elements[range.first], parts[index].region);
                continue;
            }
            const int cut = next_cut < pieces.cuts.size() ? pieces.cuts[next_cut] : 0;
            ++next_cut;
            if (cut < 1 || cut >= range.count) {
                fault(where + "/cuts", "cut " + std::to_string(next_cut - 1) + " is missing or leaves nothing to one side");
                return false;
            }
            pending.push_back({range.first + cut, range.count - cut, index, true});
            pending.push_back({range.first, cut, index, false});
        }
        if (next_cut != pieces.cuts.size()) fault(where + "/cuts", "there are more cuts than pieces to cut");
        for (auto part = parts.rbegin(); part != parts.rend(); ++part)  // children come after their parents
            if (part->left >= 0) set_union(parts[part->left].region, parts[part->right].region, part->region);
        return next_cut == pieces.cuts.size();
    }

    static void set_element(const geometry::Mesh& mesh, int number, Region& region) {
        for (const int v : corners_of(mesh, number)) {
            const Vector3 x = mesh.vertices.col(v);
            region.low = region.points.empty() ? x : Vector3(region.low.cwiseMin(x));
            region.high = region.points.empty() ? x : Vector3(region.high.cwiseMax(x));
            region.radius = std::max(region.radius, norm_bound(Interval3{x.x(), x.y(), x.z()}));
            region.points.push_back(x);
        }
    }

    static void set_union(const Region& first, const Region& second, Region& region) {
        region.low = first.low.cwiseMin(second.low);
        region.high = first.high.cwiseMax(second.high);
        region.radius = std::max(first.radius, second.radius);
        if (first.points.empty() || second.points.empty()) return;
        region.points = first.points;
        for (const Vector3& x : second.points)  // neighbours share corners
            if (std::find(first.points.begin(), first.points.end(), x) == first.points.end()) region.points.push_back(x);
        if (region.points.size() > most_points) region.points.clear();
    }

    const BodyPath& path(std::size_t place, int body) {
        const auto key = std::make_pair(place, body);
        const auto known = paths_.find(key);
        if (known != paths_.end()) return known->second;
        return paths_.emplace(key, body_path(trajectory_, places_[place].step, places_[place].segment, body)).first->second;
    }

    void check_segment(const PairCertificate& pair, std::size_t place, const std::string& where) {
        struct Cell {
            Span span;
            int a, b;
        };
        const SegmentProof& proof = pair.segments[place];
        const std::vector<Part>&parts_a = *parts_[static_cast<std::size_t>(pair.a)], &parts_b = *parts_[static_cast<std::size_t>(pair.b)];
        const BodyPath &path_a = path(place, pair.a), &path_b = path(place, pair.b);
        std::vector<Cell> pending{{{0, 1}, 0, 0}};
        std::size_t leaf = 0;
        for (const char kind : proof.splits) {
            if (pending.empty()) return fault(where, "more cells than the tree has room for");
            const Cell cell = pending.back();
            pending.pop_back();
            const Part &a = parts_a[cell.a], &b = parts_b[cell.b];
            const double middle = 0.5 * (cell.span.start + cell.span.end);
            if (kind == '.') {
                const std::string at = where + ", leaf " + std::to_string(leaf);
                if (leaf >= proof.planes.size()) return fault(at, "its plane is missing");
                const bool proven =
                    prove_leaf(path_a, path_b, a.region, b.region, cell.span, proof.planes[leaf], pair.lower, leaf_halvings);
                proven ? void(++report_.leaves) : fault(at, "its plane does not prove the lower bound");
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
                return fault(where, std::string("a cell cannot be split by `") + kind + "`");
            }
        }
        if (!pending.empty()) fault(where, "cells are missing: part of the segment is not covered");
        if (leaf < proof.planes.size()) fault(where, "more planes than leaves");
    }

    void check_upper(const PairCertificate& pair, const std::string& where) {
        const Place place{pair.step, pair.segment};
        const auto is_place = [&](const Place& p) { return p.step == place.step && p.segment == place.segment; };
        const auto found = std::find_if(places_.begin(), places_.end(), is_place);
        if (found == places_.end() || !(pair.s >= 0 && pair.s <= 1)) return fault(where, "the witness's instant is not on the path");
        Interval3 X_a, X_b;
        if (!body_point(pair.a, pair.point_a, X_a) || !body_point(pair.b, pair.point_b, X_b))
            return fault(where, "the witness's points are not of the bodies");
        const auto index = static_cast<std::size_t>(found - places_.begin());
        const BodyPath &a = path(index, pair.a), &b = path(index, pair.b);
        const Interval distance = distance_at(a, b, X_a, X_b, pair.s);
        if (!(distance.high <= pair.upper)) fault(where + "/upper", "the witness's points are farther apart");
        const double size =
            norm_bound(X_a) + norm_bound(X_b) + norm_bound(a.place) + norm_bound(b.place) + norm_bound(a.drift) + norm_bound(b.drift);
        const double turned = 1 + norm_bound(a.theta) + norm_bound(b.theta) + a.speed + b.speed;
        if (!(pair.upper - distance.low <= 1e-11 * size * turned + 1e-300))
            fault(where + "/upper", "the witness's points are closer: the bound is not attained");
    }

    // The point, as intervals in the body's frame.
    bool body_point(int body, const CertifiedPoint& point, Interval3& X) const {
        const geometry::Mesh& mesh = model_.bodies[static_cast<std::size_t>(body)].mesh;
        const auto triangles = static_cast<int>(mesh.triangles.size()), edges = static_cast<int>(mesh.edges.size());
        const int count = point.kind == Primitive::triangle ? triangles
                          : point.kind == Primitive::edge   ? edges
                                                            : static_cast<int>(mesh.vertices.cols());
        if (point.index < 0 || point.index >= count) return false;
        const int offset = point.kind == Primitive::triangle ? 0 : point.kind == Primitive::edge ? triangles : triangles + edges;
        const std::vector<int> corners = corners_of(mesh, offset + point.index);
        for (std::size_t i = corners.size(); i < point.weight.size(); ++i)
            if (point.weight[i] != 0) return false;
        Interval total = 0;
        X = {Interval(0), Interval(0), Interval(0)};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const double weight = point.weight[i];
            if (!(weight >= 0 && weight <= 2)) return false;
            total = total + Interval(weight);
            for (std::size_t k = 0; k < 3; ++k)
                X[k] = X[k] + Interval(weight) * Interval(mesh.vertices(static_cast<Eigen::Index>(k), corners[i]));
        }
        if (!(total.low > 0.5)) return false;
        for (Interval& x : X) x = x / total;
        return true;
    }

    const Certificate& certificate_;
    const model::Model& model_;
    const stepper::Trajectory& trajectory_;
    std::vector<Place> places_;
    std::vector<std::optional<std::vector<Part>>> parts_;  // per body
    std::map<std::pair<std::size_t, int>, BodyPath> paths_;
    CertificateReport report_;
};

}  // namespace

CertificateReport check_certificate(const Certificate& certificate, const model::Model& model, const stepper::Trajectory& trajectory) {
    FETTLE_ASSERT(!trajectory.poses.empty() && trajectory.poses.front().size() == model.bodies.size(),
                  "a trajectory of the model's bodies");
    return Checker(certificate, model, trajectory).run();
}

}  // namespace fettle::core::clearance
