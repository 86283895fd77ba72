// SPDX-License-Identifier: MIT
#include "core/features/regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/features/fit_surface.hpp"

namespace fettle::core::features {

namespace {

constexpr double at_first = 3;             // tolerances, while a region is small and its surface not known well
constexpr std::size_t is_small = 12;       // patches
constexpr double much_larger = 8;          // than a facet: a flat face beside it
constexpr double much_bend = 12;           // tolerances, that a region bends by at least
constexpr std::size_t most_points = 2000;  // that a surface is fitted to

bool is_ruled(SurfaceKind kind) { return kind == SurfaceKind::cylinder || kind == SurfaceKind::cone; }

// The lesser radius of curvature [m].
double curvature_radius(const Surface& surface, const Vector3& x) {
    if (surface.kind == SurfaceKind::torus) return std::max(surface.slope, std::abs(surface.radius - surface.slope));
    if (surface.kind != SurfaceKind::cone) return surface.radius;
    return std::abs(surface.radius + surface.slope * surface.axis.dot(x - surface.point));
}

class Marks {
public:
    explicit Marks(std::size_t count) : at_(count, 0) {}
    void clear() { ++now_; }
    void set(int i) { at_[i] = now_; }
    void unset(int i) { at_[i] = 0; }
    bool operator[](int i) const { return at_[i] == now_; }

private:
    std::vector<unsigned> at_;
    unsigned now_ = 1;
};

// Grows one region after another.
class Growth {
public:
    Growth(const Patches& all, const RegionOptions& options)
        : all_(all),
          options_(options),
          tolerance_(options.tolerance),
          claimed_(all.patches.size(), 0),
          in_(all.patches.size()),
          seen_(all.patches.size()),
          corner_(all.vertices.cols()) {
        for (auto& each : tried_) each.assign(all.patches.size(), 0);
    }

    std::vector<Region> run() {
        std::vector<Region> out;
        // First those that end where others begin; a column of a torus' facets, say, does not.
        std::vector<std::uint8_t> is_vain(all_.patches.size(), 0);
        for (const double open : {0.3, 1.0}) {
            std::vector<std::uint8_t> is_for_later(all_.patches.size(), 0);
            work_ = 0;
            failed_ = 0;
            for (int seed = 0; seed < count_of(all_.patches); ++seed) {
                if (claimed_[seed] != 0 || is_for_later[seed] != 0 || is_vain[seed] != 0 || is_left_out(seed)) continue;
                std::optional<Region> found = best_from(seed);
                if (!found) {
                    is_vain[seed] = 1;
                    ++failed_;
                    continue;
                }
                const bool is_open = open_share(*found) > open;
                constexpr std::size_t many = 64;  // that are not to be found again from each of them
                if (is_open && found->patches.size() < many) continue;
                for (const int patch : found->patches) (is_open ? is_for_later : claimed_)[patch] = 1;
                if (!is_open) out.push_back(std::move(*found));
            }
            for (auto& each : tried_) std::fill(each.begin(), each.end(), std::uint8_t{0});
            if (open < 1) add_coarse(out);
        }
        return out;
    }

private:
    struct Beyond {
        int patch = -1;
        double length = 0, angle = 0;
        Vector3 direction = Vector3::Zero();  // sum of the edges, all one way
    };

    // Facets that touch a sphere or torus have their corners beside it, by less than the facets' own depth, and on no other one exactly.
    void add_coarse(std::vector<Region>& out) {
        constexpr double share = 0.6, open = 0.05;
        constexpr std::size_t few = 24;
        failed_ = 0;
        for (int seed = 0; seed < count_of(all_.patches); ++seed) {
            if (claimed_[seed] != 0 || is_left_out(seed)) continue;
            ++failed_;
            const std::vector<int> ring = ring_of(seed);
            tolerance_ = share * depth_of(seed);
            if (ring.size() < 6 || !(tolerance_ > options_.tolerance)) continue;
            std::optional<Region> best;
            for (const SurfaceKind kind : {SurfaceKind::sphere, SurfaceKind::torus}) take_better(best, tried(kind, ring, seed));
            if (!best || best->patches.size() < few || open_share(*best) > open) continue;
            for (const int patch : best->patches) claimed_[patch] = 1;
            out.push_back(std::move(*best));
        }
        tolerance_ = options_.tolerance;
        for (auto& each : tried_) std::fill(each.begin(), each.end(), std::uint8_t{0});
    }

    // Where very many facets are of no surface, the search begins at one of sixteen alone: surfaces of a few facets among them stay free
    // form.
    bool is_left_out(int seed) const {
        constexpr int very_many = 10'000, share = 16;
        return failed_ > very_many && seed % share != 0;
    }

    // How far the arc over a facet is from it at most, by how its neighbours lean: chord x angle / 8.
    double depth_of(int patch) const {
        double most = 0;
        for (const Beyond& each : beyond(patch)) {
            const double chord = (all_.patches[each.patch].centre - all_.patches[patch].centre).norm();
            most = std::max(most, chord * std::abs(each.angle) / 8);
        }
        return most;
    }

    bool is_smooth(const Crease& crease) const { return std::abs(crease.angle) <= options_.limit; }
    static int other(const Crease& crease, int patch) { return crease.p == patch ? crease.q : crease.p; }

    // Neighbours over smooth creases that no region has, by their first crease.
    std::vector<Beyond> beyond(int patch) const {
        std::vector<Beyond> out;
        for (const int c : all_.patch_creases[patch]) {
            const Crease& crease = all_.creases[c];
            const int q = other(crease, patch);
            if (!is_smooth(crease) || claimed_[q] != 0) continue;
            auto at = std::find_if(out.begin(), out.end(), [&](const Beyond& each) { return each.patch == q; });
            if (at == out.end()) at = out.insert(out.end(), {q, 0, crease.angle, Vector3::Zero()});
            const Vector3 along = all_.vertices.col(crease.b) - all_.vertices.col(crease.a);
            at->length += along.norm();
            at->direction += at->direction.dot(along) < 0 ? Vector3(-along) : along;
        }
        return out;
    }

    // The neighbour that continues a chain of strips over a crease parallel to the last.
    int next_in_chain(int patch, const std::vector<int>& chain, const Vector3& direction, double sign) const {
        int best = -1;
        double most = 0;
        for (const Beyond& each : beyond(patch)) {
            if (each.angle * sign < 0 || std::find(chain.begin(), chain.end(), each.patch) != chain.end()) continue;
            const double share = std::abs(each.direction.dot(direction));
            if (share > most) {
                most = share;
                best = each.patch;
            }
        }
        return best;
    }

    // Strips beside each other, the seed in its place among them: two to each side where there are so many.
    std::vector<int> chain_of(int seed, std::size_t& place) const {
        const std::vector<Beyond> first = beyond(seed);
        place = 0;
        if (first.empty()) return {seed};
        const Beyond& longest =
            *std::max_element(first.begin(), first.end(), [](const Beyond& a, const Beyond& b) { return a.length < b.length; });
        const Vector3 direction = longest.direction.normalized();
        std::vector<int> chain{seed, longest.patch};
        const auto extend = [&](int from, std::size_t most) {
            for (std::size_t k = 0; k < most; ++k) {
                const int next = next_in_chain(from, chain, direction, longest.angle);
                if (next < 0) return;
                chain.push_back(from = next);
            }
        };
        extend(longest.patch, 1);
        std::reverse(chain.begin(), chain.end());
        place = chain.size() - 1;
        extend(seed, 2);
        return chain;
    }

    // The patches round one, without much larger ones: a fillet's facets without the flat faces beside it.
    std::vector<int> ring_of(int seed) const {
        std::vector<int> ring{seed};
        const auto add = [&](int from) {
            for (const Beyond& each : beyond(from)) {
                if (all_.patches[each.patch].area > much_larger * all_.patches[seed].area) continue;
                if (std::find(ring.begin(), ring.end(), each.patch) != ring.end()) continue;
                if (from == seed || shares_vertex(each.patch, seed)) ring.push_back(each.patch);
            }
        };
        add(seed);
        constexpr std::size_t most = 40;
        for (std::size_t k = 1; k < ring.size() && ring.size() < most; ++k) add(ring[k]);
        return ring;
    }

    bool shares_vertex(int p, int q) const {
        const auto a = all_.patch_vertices[p], b = all_.patch_vertices[q];
        auto i = a.begin();
        auto j = b.begin();
        while (i != a.end() && j != b.end()) {
            if (*i == *j) return true;
            *i < *j ? ++i : ++j;
        }
        return false;
    }

    std::vector<Vector3> points_of(SurfaceKind kind, const std::vector<int>& members) const {
        const std::vector<int> corners = corners_on(all_, kind, members, options_.limit);
        const std::size_t stride = corners.size() / most_points + 1;
        std::vector<Vector3> out;
        for (std::size_t k = 0; k < corners.size(); k += stride) out.push_back(all_.vertices.col(corners[k]));
        return out;
    }

    std::optional<Surface> start(SurfaceKind kind, const std::vector<int>& members) const {
        SurfaceSamples samples;
        samples.points = points_of(kind, members);
        if (count_of(samples.points) <= parameter_count(kind)) return std::nullopt;
        for (const int member : members) {
            samples.centres.push_back(all_.patches[member].centre);
            samples.normals.push_back(all_.patches[member].normal);
            samples.weights.push_back(all_.patches[member].area);
        }
        std::optional<Surface> near = near_surface(kind, samples);
        if (kind == SurfaceKind::cone && !near) {
            near = near_surface(SurfaceKind::cylinder, samples);
            if (near) near->kind = SurfaceKind::cone;
        }
        if (near) near = fitted_surface(*near, samples.points, 2 * tolerance_);
        for (const Vector3& x : samples.points)
            if (near && !(std::abs(signed_distance(*near, x)) <= tolerance_)) return std::nullopt;
        if (near && !(near->radius < 100 * all_.size)) return std::nullopt;
        return near;
    }

    // The surface's normal beside the corners: a coarse facet's middle may be nearer to the other side of a tube.
    Vector3 normal_beside(const Surface& surface, int patch) const {
        Vector3 sum = Vector3::Zero();
        for (const int v : all_.patch_vertices[patch]) sum += normal_at(surface, all_.vertices.col(v));
        return sum.norm() > 0 ? Vector3(sum.normalized()) : sum;
    }

    bool is_hollow(const Surface& surface, int patch) const { return normal_beside(surface, patch).dot(all_.patches[patch].normal) < 0; }

    // Does the facet's plane hold the line of the ruled surface beside it? A step that leans a little does not.
    bool holds_its_line(const Surface& surface, int patch, double tolerance) const {
        const Patch& facet = all_.patches[patch];
        double low = INFINITY, high = -INFINITY;
        for (const int v : all_.patch_vertices[patch]) {
            const double at = surface.axis.dot(all_.vertices.col(v));
            low = std::min(low, at);
            high = std::max(high, at);
        }
        const double length = std::max(high - low, tolerance);
        if (surface.kind == SurfaceKind::cylinder || std::abs(surface.slope) < 1e-9)
            return std::abs(facet.normal.dot(surface.axis)) * length <= 4 * tolerance;
        const Vector3 to_apex = surface.point - surface.radius / surface.slope * surface.axis - facet.centre;
        return std::abs(facet.normal.dot(to_apex)) * std::min(1.0, length / to_apex.norm()) <= 4 * tolerance;
    }

    // Could the patch be a facet of the surface? `in_` marks the region's.
    bool fits(const Surface& surface, bool hollow, int patch, double tolerance) {
        const Patch& facet = all_.patches[patch];
        const Vector3 normal = normal_beside(surface, patch);
        const bool is_speck = facet.area < 64 * tolerance * tolerance;  // its normal says nothing
        if (!is_speck && (hollow ? -1 : 1) * normal.dot(facet.normal) < std::cos(0.6 * options_.limit)) return false;
        if (!is_speck && is_ruled(surface.kind) && !holds_its_line(surface, patch, tolerance)) return false;
        corner_.clear();
        for (const int c : all_.patch_creases[patch]) {
            const Crease& crease = all_.creases[c];
            if (!is_smooth(crease) || !in_[other(crease, patch)]) continue;
            corner_.set(crease.a);
            corner_.set(crease.b);
        }
        const double bulge = 0.05 * curvature_radius(surface, facet.centre), least_cosine = std::cos(0.8 * options_.limit);
        for (const int v : all_.patch_vertices[patch]) {
            const Vector3 x = all_.vertices.col(v);
            const double d = signed_distance(surface, x);
            const bool is_on = is_ruled(surface.kind) ? corner_[v] : all_.is_sharp[v] == 0;
            if (d > tolerance && (is_on || surface.kind != SurfaceKind::torus)) return false;
            if (std::abs(d) > (is_on ? tolerance : bulge + tolerance)) return false;
            const Vector3 there = normal_at(surface, x);
            if (!is_speck && there.squaredNorm() > 0.5 && there.dot(normal) < least_cosine) return false;
        }
        return true;
    }

    std::vector<int> kept(const Surface& surface, bool hollow, const std::vector<int>& members, double tolerance) {
        std::vector<int> out;
        for (const int member : members)
            if (fits(surface, hollow, member, tolerance)) out.push_back(member);
        return out;
    }

    void mark(const std::vector<int>& members) {
        in_.clear();
        for (const int member : members) in_.set(member);
    }

    // How far the facets' middles are from the surface: of half of the area less, of half more.
    double usual_depth(const Surface& surface, const std::vector<int>& members) const {
        std::vector<std::pair<double, double>> depths;
        double area = 0, below = 0;
        for (const int member : members) {
            depths.emplace_back(std::abs(signed_distance(surface, all_.patches[member].centre)), all_.patches[member].area);
            area += all_.patches[member].area;
        }
        std::sort(depths.begin(), depths.end());
        for (const auto& [depth, of] : depths)
            if ((below += of) >= 0.5 * area) return depth;
        return 0;
    }

    // Facets whose middle is much farther from the surface than that of most of the area: flats cut off a pin, an end cap.
    void drop_wide_facets(const Surface& surface, std::vector<int>& members) const {
        const double most = 3 * usual_depth(surface, members) + 2 * tolerance_;
        std::erase_if(members, [&](int member) { return std::abs(signed_distance(surface, all_.patches[member].centre)) > most; });
    }

    // The same, but not from facets on which it went astray often.
    std::optional<Region> tried(SurfaceKind kind, const std::vector<int>& seeds, int seed) {
        constexpr std::size_t astray = 12, patience = 8;
        constexpr std::uint8_t often = 3;
        std::vector<std::uint8_t>& times = tried_[static_cast<std::size_t>(kind)];
        const bool is_long = work_ > patience * all_.patches.size();  // a mesh of mostly free form
        if (times[seed] >= (is_long ? 1 : often)) return std::nullopt;
        reached_.clear();
        std::optional<Region> out = grown(kind, seeds);
        if (!out && reached_.size() >= astray)
            for (const int member : reached_) times[member] = std::min<std::uint8_t>(times[member] + 1, often);
        work_ += out ? 0 : reached_.size();
        return out;
    }

    // As far as it goes; `members` grow, while the surface is fitted anew whenever they are twice as many.
    std::optional<Region> grown(SurfaceKind kind, const std::vector<int>& seeds) {
        std::optional<Surface> surface = start(kind, seeds);
        if (!surface) return std::nullopt;
        const bool hollow = is_hollow(*surface, seeds.front());
        std::vector<int> members = seeds;
        mark(members);
        members = kept(*surface, hollow, members, at_first * tolerance_);
        if (members.size() != seeds.size()) return std::nullopt;
        constexpr int most_rounds = 40;
        int still = 0;  // rounds without growth, after each of which the surface is fitted anew
        for (int round = 0; round < most_rounds && still < 2; ++round) {
            const std::size_t before = members.size();
            const double tolerance = (before < is_small ? at_first : 1) * tolerance_;
            spread(*surface, hollow, tolerance, members);
            const bool is_whole = members.size() < 2 * before + 2;
            surface = fitted_surface(*surface, points_of(kind, members));
            if (!surface) return std::nullopt;
            if (is_whole) {
                members = kept(*surface, hollow, members, tolerance);
                mark(members);
            }
            if (members.size() < 3) return std::nullopt;
            still = members.size() <= before ? still + 1 : 0;
        }
        reached_ = members;
        return finished(kind, *surface, hollow, std::move(members));
    }

    void spread(const Surface& surface, bool hollow, double tolerance, std::vector<int>& members) {
        const std::size_t most = 2 * members.size() + 2;
        seen_.clear();
        for (std::size_t k = 0; k < members.size() && members.size() < most; ++k)
            for (const int c : all_.patch_creases[members[k]]) {
                const Crease& crease = all_.creases[c];
                const int q = other(crease, members[k]);
                if (!is_smooth(crease) || claimed_[q] != 0 || in_[q] || seen_[q]) continue;
                if (fits(surface, hollow, q, tolerance)) {
                    members.push_back(q);
                    in_.set(q);
                } else if (!is_ruled(surface.kind)) {
                    seen_.set(q);  // of ruled ones what is beside it may yet decide which corners count
                }
            }
    }

    std::optional<Region> finished(SurfaceKind kind, Surface surface, bool hollow, std::vector<int> members) {
        for (int round = 0; round < 4; ++round) {
            const std::size_t before = members.size();
            mark(members);
            members = kept(surface, hollow, members, tolerance_);
            drop_wide_facets(surface, members);
            if (members.size() < 3) return std::nullopt;
            if (members.size() == before && round > 0) break;
            const std::optional<Surface> again = fitted_surface(surface, points_of(kind, members));
            if (!again) return std::nullopt;
            surface = *again;
        }
        std::sort(members.begin(), members.end());
        Region out{surface, hollow, std::move(members), 0, 0};
        for (const int v : corners_on(all_, kind, out.patches, options_.limit))
            out.residual = std::max(out.residual, std::abs(signed_distance(surface, all_.vertices.col(v))));
        for (const int member : out.patches) out.area += all_.patches[member].area;
        if (out.residual > tolerance_ || !is_significant(out)) return std::nullopt;
        return out;
    }

    // Is it more than what any few facets would fit?
    bool is_significant(const Region& region) const {
        const Surface& surface = region.surface;
        const std::vector<int> corners = corners_on(all_, surface.kind, region.patches, options_.limit);
        if (corners.size() < least_corners(surface.kind)) return false;
        const double bend = bend_of(region, corners);
        if (!(bend > much_bend * tolerance_)) return false;
        constexpr std::size_t many = 24;  // facets, whose corners are near by no chance; of a few they are much nearer than facets are deep
        if (!options_.is_noise && region.patches.size() < many && region.residual > 0.25 * usual_depth(surface, region.patches))
            return false;
        if (surface.kind == SurfaceKind::sphere) return region.patches.size() >= 6;
        if (surface.kind == SurfaceKind::cone && !is_tapered(region)) return false;
        const auto [u, v] = across_of(surface.axis);
        std::vector<double> angles;  // about the axis; of a torus about its tube's middle
        for (const int corner : corners) {
            const Vector3 d = all_.vertices.col(corner) - surface.point;
            const double z = surface.axis.dot(d), across = (d - z * surface.axis).norm();
            angles.push_back(surface.kind == SurfaceKind::torus ? std::atan2(z, across - surface.radius) : std::atan2(d.dot(v), d.dot(u)));
        }
        constexpr std::size_t few_lines = 4, many_lines = 7;
        const double round = surface.kind == SurfaceKind::torus ? surface.slope : surface.radius;
        const std::vector<double> lines = distinct(std::move(angles), 4 * tolerance_ / std::max(round, 4 * tolerance_));
        if (lines.size() < few_lines) return false;
        if (lines.size() < many_lines && !(bend > 100 * std::max(region.residual, 0.2 * tolerance_))) return false;
        return lines.size() > few_lines || are_even(lines);
    }

    // A cone that tapers by less than the tolerance is a cylinder, or nothing.
    bool is_tapered(const Region& region) const {
        double low = INFINITY, high = -INFINITY;
        for (const int member : region.patches)
            for (const int v : all_.patch_vertices[member]) {
                const double at = region.surface.axis.dot(all_.vertices.col(v));
                low = std::min(low, at);
                high = std::max(high, at);
            }
        return std::abs(region.surface.slope) * (high - low) > 4 * tolerance_;
    }

    static std::vector<double> distinct(std::vector<double> angles, double same) {
        std::sort(angles.begin(), angles.end());
        std::vector<double> out;
        for (std::size_t k = 0; k < angles.size(); ++k)
            if (k == 0 || angles[k] - angles[k - 1] > same) out.push_back(angles[k]);
        return out;
    }

    // The corners of two flat faces that lean against a third alike are always on a circle.
    static bool are_even(const std::vector<double>& lines) {
        std::vector<double> gaps;
        for (std::size_t k = 0; k < lines.size(); ++k)
            gaps.push_back(k > 0 ? lines[k] - lines[k - 1] : lines[0] - lines.back() + 2 * std::numbers::pi);
        gaps.erase(std::max_element(gaps.begin(), gaps.end()));  // what is not covered
        const auto [least, largest] = std::minmax_element(gaps.begin(), gaps.end());
        return *largest <= 1.3 * *least;
    }

    // A few corners lie on some surface by chance.
    static std::size_t least_corners(SurfaceKind kind) {
        return kind == SurfaceKind::cylinder ? 6 : 2 * static_cast<std::size_t>(parameter_count(kind));
    }

    // How thick the layer between two parallel planes is that holds it [m].
    double bend_of(const Region& region, const std::vector<int>& corners) const {
        const Vector3 normal = [&] {
            Vector3 sum = Vector3::Zero();
            for (const int member : region.patches) sum += all_.patches[member].area * all_.patches[member].normal;
            return sum.norm() > 1e-6 * region.area ? Vector3(sum.normalized()) : Vector3::UnitZ();
        }();
        double low = INFINITY, high = -INFINITY;
        for (const int corner : corners) {
            const double height = normal.dot(all_.vertices.col(corner));
            low = std::min(low, height);
            high = std::max(high, height);
        }
        return high - low;
    }

    // The share of the region's border that goes on smoothly into facets of no region, of about the same size: it may be more than this.
    double open_share(const Region& region) {
        mark(region.patches);
        const double usual = region.area / static_cast<double>(region.patches.size());
        double open = 0, border = 0;
        for (const int member : region.patches)
            for (const int c : all_.patch_creases[member]) {
                const Crease& crease = all_.creases[c];
                const int q = other(crease, member);
                if (in_[q]) continue;
                const double length = (all_.vertices.col(crease.a) - all_.vertices.col(crease.b)).norm();
                border += length;
                if (is_smooth(crease) && claimed_[q] == 0 && all_.patches[q].area < much_larger * usual) open += length;
            }
        return border > 0 ? open / border : 0;
    }

    // The simpler one unless the other has clearly more of the mesh.
    static void take_better(std::optional<Region>& best, std::optional<Region> other) {
        constexpr double clearly = 1.1;
        if (other && (!best || other->area > clearly * best->area)) best = std::move(other);
    }

    std::optional<Region> best_from(int seed) {
        constexpr double closed = 0.02;
        std::optional<Region> best;
        const auto is_done = [&] { return best && open_share(*best) <= closed; };
        std::size_t place = 0;
        const std::vector<int> chain = chain_of(seed, place);
        for (const SurfaceKind kind : {SurfaceKind::cylinder, SurfaceKind::cone}) {
            take_better(best, from_chain(kind, chain, place));
            if (is_done()) return best;
        }
        const std::vector<int> ring = ring_of(seed);
        if (ring.size() >= 4)
            for (const SurfaceKind kind : {SurfaceKind::sphere, SurfaceKind::cylinder, SurfaceKind::cone, SurfaceKind::torus}) {
                if (best && is_ruled(kind)) continue;
                take_better(best, tried(kind, ring, seed));
                if (is_done()) return best;
            }
        return best;
    }

    // From three strips beside each other, the seed among them, whichever fit.
    std::optional<Region> from_chain(SurfaceKind kind, const std::vector<int>& chain, std::size_t place) {
        constexpr std::size_t few = 3;
        std::optional<Region> best;
        for (const std::size_t first : {place - 1, place, place - 2}) {
            if (first > place || first + few > chain.size()) continue;
            const auto from = chain.begin() + static_cast<std::ptrdiff_t>(first);
            if ((best = tried(kind, {from, from + few}, chain[place]))) return best;
        }
        return best;
    }

    const Patches& all_;
    RegionOptions options_;
    double tolerance_;  // now
    std::vector<std::uint8_t> claimed_;
    std::array<std::vector<std::uint8_t>, 5> tried_;  // by kind, how often
    Marks in_, seen_, corner_;
    std::vector<int> reached_;  // by the last growth
    int failed_ = 0;            // seeds from which no region was found
    std::size_t work_ = 0;      // facets reached by growths that came to nothing
};

}  // namespace

std::vector<int> corners_on(const Patches& patches, SurfaceKind kind, const std::vector<int>& members, double limit) {
    std::vector<int> sorted = members, corners;
    std::sort(sorted.begin(), sorted.end());
    const auto add = [&](bool within) {
        for (const int member : sorted)
            for (const int c : patches.patch_creases[member]) {
                const Crease& crease = patches.creases[c];
                if (std::abs(crease.angle) > limit) continue;
                if (within && (crease.p != member || !std::binary_search(sorted.begin(), sorted.end(), crease.q))) continue;
                for (const int v : {crease.a, crease.b})
                    if (is_ruled(kind) || patches.is_sharp[v] == 0) corners.push_back(v);
            }
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    };
    add(true);
    if (count_of(corners) < 2 * parameter_count(kind)) add(false);
    if (count_of(corners) < 2 * parameter_count(kind) && !is_ruled(kind)) {
        for (const int member : sorted)
            corners.insert(corners.end(), patches.patch_vertices[member].begin(), patches.patch_vertices[member].end());
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    }
    return corners;
}

std::vector<Region> curved_regions(const Patches& patches, const RegionOptions& options) { return Growth(patches, options).run(); }

}  // namespace fettle::core::features
