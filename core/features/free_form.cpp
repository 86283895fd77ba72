// SPDX-License-Identifier: MIT
#include "core/features/free_form.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::features {

namespace {

constexpr std::size_t few_faces = 8;  // that lean against each other as facets do, and are flat faces all the same: chamfers

class FreeForm {
public:
    FreeForm(const Patches& all, double limit) : all_(all), limit_(limit) {}

    std::vector<std::uint8_t> find(const std::vector<Region>& regions) {
        region_.assign(all_.patches.size(), -1);
        for (int r = 0; r < count_of(regions); ++r)
            for (const int member : regions[r].patches) region_[member] = r;
        std::vector<std::uint8_t> out(all_.patches.size(), 0), seen(all_.patches.size(), 0);
        for (int seed = 0; seed < count_of(all_.patches); ++seed) {
            if (seen[seed] != 0 || region_[seed] >= 0) continue;
            std::vector<int> members{seed};
            seen[seed] = 1;
            for (std::size_t k = 0; k < members.size(); ++k)
                for_smooth(members[k], [&](int q) {
                    if (seen[q] == 0) members.push_back(q);
                    seen[q] = 1;
                });
            if (members.size() <= few_faces) continue;
            for (const int member : members) out[member] = is_large(member) ? 0 : 1;
        }
        return out;
    }

    // How much of the border leads smoothly into free form: of all of it, and of what is ruled of the sides.
    bool is_unbounded(const std::vector<Region>& regions, int index, const std::vector<std::uint8_t>& free) const {
        const Region& region = regions[index];
        constexpr double third = 1.0 / 3;
        const bool is_ruled = region.surface.kind == SurfaceKind::cylinder || region.surface.kind == SurfaceKind::cone;
        double open = 0, border = 0, open_side = 0, side = 0;
        for (const int member : region.patches)
            for (const int c : all_.patch_creases[member]) {
                const Crease& crease = all_.creases[c];
                const int q = crease.p == member ? crease.q : crease.p;
                if (region_[q] == index) continue;
                const Vector3 along = all_.vertices.col(crease.b) - all_.vertices.col(crease.a);
                const double length = along.norm(), across = is_ruled ? std::abs(along.dot(region.surface.axis)) : 0;
                border += length;
                side += across;
                if (std::abs(crease.angle) > limit_ || (free[q] == 0 && !is_next_column(region, regions, region_[q]))) continue;
                open += length;
                open_side += across;
            }
        return open > third * border || open_side > third * side;
    }

private:
    // A cylinder as wide whose axis leans: both are columns of the facets of a tube that bends.
    static bool is_next_column(const Region& region, const std::vector<Region>& regions, int next) {
        if (next < 0 || regions[next].surface.kind != SurfaceKind::cylinder || region.surface.kind != SurfaceKind::cylinder) return false;
        constexpr double leaning = 0.01, alike = 0.1;
        const Surface &a = region.surface, &b = regions[next].surface;
        return a.axis.cross(b.axis).norm() > leaning && std::abs(a.radius - b.radius) < alike * a.radius;
    }

    template <class Visit>
    void for_smooth(int patch, const Visit& visit) const {
        for (const int c : all_.patch_creases[patch]) {
            const Crease& crease = all_.creases[c];
            const int q = crease.p == patch ? crease.q : crease.p;
            if (std::abs(crease.angle) <= limit_ && region_[q] < 0) visit(q);
        }
    }

    // A flat face beside facets.
    bool is_large(int patch) const {
        constexpr double much = 10;
        std::vector<double> areas;
        for_smooth(patch, [&](int q) { areas.push_back(all_.patches[q].area); });
        if (areas.empty()) return true;
        const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
        std::nth_element(areas.begin(), middle, areas.end());
        return all_.patches[patch].area > much * *middle;
    }

    const Patches& all_;
    double limit_;
    std::vector<int> region_;
};

}  // namespace

std::vector<std::uint8_t> drop_unbounded(const Patches& patches, std::vector<Region>& regions, const RegionOptions& options) {
    FreeForm form(patches, options.limit);
    std::vector<std::uint8_t> free = form.find(regions);
    constexpr int most_rounds = 4;  // one that is dropped leaves others open
    for (int round = 0; round < most_rounds; ++round) {
        std::vector<Region> left;
        for (int r = 0; r < count_of(regions); ++r)
            if (!form.is_unbounded(regions, r, free)) left.push_back(regions[r]);
        if (left.size() == regions.size()) break;
        regions = std::move(left);
        free = form.find(regions);
    }
    return free;
}

}  // namespace fettle::core::features
