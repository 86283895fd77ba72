// SPDX-License-Identifier: MIT
#include "design/tolerances/process_clearance.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"
#include "design/tolerances/known_processes.hpp"

namespace fettle::design::tolerances {

namespace {

std::string in_millimetres(double metres) { return core::base::formatted("%g", metres / 1e-3); }

}  // namespace

Result<double> part_tolerance(const Process& process, double size, const std::string& where) {
    FETTLE_ASSERT(process.clearance.has_value(), "a process that says what parts need");
    FETTLE_ASSERT(size >= 0, "the size of a part");
    const std::vector<SizeBand>& bands = process.clearance->bands;
    if (bands.empty()) {
        const Result<ProcessDeviation> length = process_deviation(process, FeatureKind::length, size, where);
        if (!length) return length.errors();
        return std::max(std::abs(length->limits.lower), std::abs(length->limits.upper)) / 2;
    }
    for (const SizeBand& band : bands) {
        if (size <= band.up_to) return band.tolerance;
    }
    return Error{ErrorCode::out_of_range, where,
                 "a part of " + in_millimetres(size) + " mm: what is published for " + process.name + " ends at " +
                     in_millimetres(bands.back().up_to) + " mm; say what you need with --minimum, or for one pair with --pairs A:B=0.5mm"};
}

Result<double> required_clearance(const Process& process, double size_a, double size_b, const std::string& where) {
    if (!process.clearance)
        return Error{ErrorCode::unsupported, where,
                     "process \"" + process.name +
                         "\" says nothing of the clearance that parts need; say what you need with --minimum, or in a profile of your own "
                         "with `minimum_gap`"};
    const Result<double> a = part_tolerance(process, size_a, where), b = part_tolerance(process, size_b, where);
    if (!a) return a.errors();
    if (!b) return b.errors();
    return process.clearance->minimum + (*a + *b);
}

std::string borrowed_clearance(const Process& process) {
    if (!process.clearance || (process.clearance->minimum_of.empty() && process.clearance->bands_of.empty())) return {};
    const ClearanceNeed& need = *process.clearance;
    const std::string gap = "the smallest gap (" + in_millimetres(need.minimum) + " mm)", faces = "what faces may be off by";
    const bool both = !need.minimum_of.empty() && !need.bands_of.empty();
    return (both                      ? gap + " and " + faces + " are those of " + need.minimum_of
            : need.minimum_of.empty() ? faces + " is that of " + need.bands_of
                                      : gap + " is that of " + need.minimum_of) +
           ", since no coupon shows " + (both ? "them" : "it") +
           ": once you know what your parts need, say `minimum_gap` and `part_tolerance` in " + process.name +
           ".process.json, or --minimum";
}

std::string clearance_table() {
    std::string text = "Required clearance per side = minimum + tolerance of one part + tolerance of the other [mm, per side]:\n";
    for (const Process& process : known_processes()) {
        if (!process.clearance) continue;
        const ClearanceNeed& need = *process.clearance;
        text += "  " + process.name + "  minimum " + in_millimetres(need.minimum) + " (" + need.source + ")\n       a part";
        for (const SizeBand& band : need.bands)
            text += std::string(&band == &need.bands.front() ? " " : ", ") + "up to " + in_millimetres(band.up_to) + ": " +
                    in_millimetres(band.tolerance);
        text += "\n       (half of " + need.bands.front().source + ", then of " + need.bands.back().source + ")\n";
    }
    return text;
}

}  // namespace fettle::design::tolerances
