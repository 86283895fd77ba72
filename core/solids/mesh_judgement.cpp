// SPDX-License-Identifier: MIT
#include "core/solids/mesh_judgement.hpp"

#include <algorithm>
#include <cstdio>

#include "core/base/text.hpp"
#include "core/geometry/half_edges.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/geometry/predicates.hpp"
#include "core/solids/mesh_validity.hpp"
#include "core/solids/overlap_bound.hpp"
#include "core/solids/shells.hpp"

namespace fettle::core::solids {
namespace {

constexpr const char* unbounded = "what it does to the mass could not be bounded: check the volume";
constexpr int most_pairs = 20'000;  ///< of intersecting triangles: beyond it no bound is worked out

std::string place(const Vector3& x) {
    char text[96];
    std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g) mm", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
    return text;
}

class Judge {
public:
    Judge(const geometry::Mesh& mesh, bool as_solid) : mesh_(mesh), as_solid_(as_solid) {}

    MeshFindings run() {
        findings_.errors = faults_of_numbers(mesh_);
        if (!findings_.errors.empty()) return findings_;
        look_at_areas();
        look_at_edges();
        if (as_solid_ && !findings_.errors.empty()) return findings_;
        if (as_solid_) measure();
        if (!findings_.errors.empty()) return findings_;
        look_at_intersections();
        return findings_;
    }

private:
    void warn(const std::string& what) { findings_.warnings.push_back("mesh " + mesh_.name + ": " + what); }
    void refuse(const std::string& where, const std::string& what) {
        findings_.errors.push_back({ErrorCode::mesh_invalid, mesh_.name + ": " + where, what});
    }
    Vector3 corner(std::size_t triangle) const { return mesh_.vertices.col(mesh_.triangles[triangle][0]); }

    void look_at_areas() {
        std::size_t count = 0, first = 0;
        const std::vector<char> without_area = triangles_without_area(mesh_);
        for (std::size_t t = mesh_.triangles.size(); t-- > 0;) {
            if (without_area[t] == 0) continue;
            ++count;
            first = t;
        }
        if (count == 0) return;
        warn(std::to_string(count) + (count == 1 ? " triangle has" : " triangles have") + " no area, first triangle " +
             std::to_string(first) + " at " + place(corner(first)) + "; no effect on the mass");
    }

    void look_at_edges() {
        if (!as_solid_) return;
        std::size_t several = 0, turned = 0;
        geometry::HalfEdge first_several{}, first_turned{};
        halves_ = geometry::sorted_half_edges(mesh_);
        const std::vector<geometry::HalfEdge>& halves = halves_;
        geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
            if (last - first > 2 && several++ == 0) first_several = halves[first];
            const bool same =
                last - first == 2 && halves[first].forward == halves[first + 1].forward && halves[first].low != halves[first].high;
            if (same && turned++ == 0) first_turned = halves[first];
        });
        if (turned > 0) {
            refuse(
                "triangle " + std::to_string(first_turned.triangle),
                "and its neighbour over the edge at " + place(mesh_.vertices.col(first_turned.low)) +
                    " run the same way round: one is turned over, and the surface is open or has no two sides, so that which one cannot be "
                    "told (" +
                    std::to_string(turned) + " such edges); orient all triangles counter-clockwise seen from outside");
        }
        if (several > 0) {
            warn(std::to_string(several) + (several == 1 ? " edge belongs" : " edges belong") + " to more than two triangles, first at " +
                 place(mesh_.vertices.col(first_several.low)) + "; no effect on the mass where both directions stand equally often");
        }
        const std::size_t loose =
            mesh_.codimensional_points.size() + mesh_.edges.size() - std::min(mesh_.edges.size(), geometry::count_edges(halves));
        if (loose > 0) warn(std::to_string(loose) + " edges or points belong to no triangle: they touch others, and have no mass");
    }

    /// Its volume, openings capped.
    void measure() {
        const std::vector<geometry::Opening> holes = geometry::openings(mesh_.vertices, halves_);
        if (!geometry::is_nearly_closed(mesh_.vertices, mesh_.triangles, holes)) return refuse_open();
        volume_ = geometry::capped_solid_moments(mesh_.vertices, mesh_.triangles, holes)(3, 3);
        if (!(volume_ > 0)) {
            return refuse("mesh",
                          "its volume is not positive: it is inside out, or empty; triangles are counter-clockwise seen from outside");
        }
        if (holes.empty()) return;
        double bound = 0;  // whatever closes an opening within its hull: two of these differ by no more than its box
        const geometry::Opening* largest = &holes.front();
        for (const geometry::Opening& hole : holes) {
            Matrix3X ends(3, 2 * static_cast<Eigen::Index>(hole.edges.size()));
            for (std::size_t e = 0; e < hole.edges.size(); ++e) {
                ends.col(2 * static_cast<Eigen::Index>(e)) = mesh_.vertices.col(hole.edges[e][0]);
                ends.col(2 * static_cast<Eigen::Index>(e) + 1) = mesh_.vertices.col(hole.edges[e][1]);
            }
            bound += geometry::box_sides(ends).prod();
            if (hole.area.norm() > largest->area.norm()) largest = &hole;
        }
        warn("it is open in " + std::to_string(holes.size()) + (holes.size() == 1 ? " place" : " places") + ", the largest near " +
             place(largest->centre) + "; capped for the mass, " + share(bound, bound));
        closed_ = false;
    }

    void refuse_open() {
        MeshRequirements solid;
        solid.no_self_intersection = false;
        for (Error& error : validate_mesh(mesh_, solid)) {
            if (error.message.find("has no area") == std::string::npos) findings_.errors.push_back(std::move(error));
        }
        if (findings_.errors.empty()) refuse("mesh", "is open too far to be capped");
    }

    /// The share of the lesser of the mass as it is told and as it is meant, if the volume told is too much by `over` or too little by
    /// `under`.
    std::string share(double over, double under) const {
        if (!(over < volume_)) return unbounded;
        return "which changes its mass by at most " + base::percent(std::min(std::max(over / (volume_ - over), under / volume_), 1e6)) +
               " of the smaller of the two, as it is read and as it is meant";
    }

    void look_at_intersections() {
        const auto pairs = self_intersections(mesh_, most_pairs);
        if (pairs.empty()) {
            if (as_solid_ ? closed_ : bounds_a_solid(mesh_)) look_at_nesting();
            return;
        }
        const bool all = count_of(pairs) < most_pairs;
        std::string text = (all ? "" : "at least ") + std::to_string(pairs.size()) + (pairs.size() == 1 ? " pair" : " pairs") +
                           " of triangles intersect, first " + std::to_string(pairs.front().first) + " and " +
                           std::to_string(pairs.front().second) + " near " + place(corner(static_cast<std::size_t>(pairs.front().first))) +
                           "; a rigid body never touches itself";
        if (as_solid_) {
            const auto bound = all && bounds_a_solid(halves_) ? overlap_volume_bound(mesh_, pairs) : std::nullopt;
            text += std::string(", ") + (bound ? share(*bound, 0) : unbounded);
        }
        warn(text);
    }

    void look_at_nesting() {
        for (const Shell& shell : shells_of(mesh_)) {
            const std::string name = "shell \"" + mesh_.shell_names[shell.index] + "\"";
            if (shell.volume_sign == 0 && as_solid_) warn(name + " encloses no volume; no effect on the mass");
            if (shell.volume_sign == 0 || shell.is_oriented()) continue;
            const bool counts_as_hole = shell.depth % 2 == 0;
            if (!as_solid_) {
                warn(name + (counts_as_hole ? " is inside out, so that it counts as a hole"
                                            : " is a solid within a solid, and no cavity: what lies in it lies in material; for a cavity "
                                              "reverse its triangles"));
                continue;
            }
            const double volume = std::abs(geometry::solid_moments(mesh_.vertices, shell.triangles)(3, 3));
            warn(name +
                 (counts_as_hole ? " is inside out, so that it counts as a hole"
                                 : " is a solid within a solid, so that its volume counts twice; for a cavity reverse its triangles") +
                 ", " + (counts_as_hole ? share(0, 2 * volume) : share(2 * volume, 0)));
        }
    }

    const geometry::Mesh& mesh_;
    bool as_solid_;
    bool closed_ = true;
    std::vector<geometry::HalfEdge> halves_;  ///< of a solid
    double volume_ = 0;
    MeshFindings findings_;
};

}  // namespace

MeshFindings judge_mesh(const geometry::Mesh& mesh, bool as_solid) { return Judge(mesh, as_solid).run(); }

}  // namespace fettle::core::solids
