// SPDX-License-Identifier: MIT
#include "core/solver/prescribed_drive.hpp"

#include <algorithm>

namespace fettle::core::solver {
namespace {

constexpr double smallest_share = 1e-4;
constexpr double short_search = 0.25;  // where less than this was possible, drive less
constexpr int longest_rest = 12;       // iterations
constexpr double stalled_step = 1e-3;  // a step this short, again and again, means that the way is blocked
constexpr int stalled_iterations = 50;

}  // namespace

void PrescribedDrive::outweigh(double slope, double taken, double least) { penalty_ = std::max({penalty_, 2 * slope / taken, least}); }

// What is pushed must have time to give way: drive less where little was possible, more where much was.
void PrescribedDrive::adapt(double fraction, bool arrived, bool relaxed) {
    if (resting_ > 0) {
        resting_ = relaxed ? 0 : resting_ - 1;
    } else if (!arrived) {
        share_ = fraction < short_search ? std::max(smallest_share, 0.25 * share_) : std::min(1.0, 2 * share_);
        resting_ = fraction < short_search ? longest_rest : 0;
    }
}

bool PrescribedDrive::try_less() {
    if (share_ <= smallest_share) return false;
    penalty_ *= 10;
    return true;
}

void PrescribedDrive::count_stalls(double taken) { stalled_ = taken < stalled_step ? stalled_ + 1 : 0; }

bool PrescribedDrive::is_stalled() const { return stalled_ >= stalled_iterations; }

}  // namespace fettle::core::solver
