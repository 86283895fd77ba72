// SPDX-License-Identifier: MIT
/// How prescribed coordinates are driven to their targets where contact is in the way: the share of what remains that an iteration takes,
/// the weight nu of the remainder in the exact penalty E + nu |remaining| that the search descends on (newton.hpp), and whether the way
/// is blocked.
#pragma once

namespace fettle::core::solver {

class PrescribedDrive {
public:
    /// Share of the remainder for the next iteration to take, in [0, 1]; 0 while what is pushed is given time.
    double share() const { return resting_ > 0 ? 0 : share_; }
    /// nu, in units of the potential per metre.
    double penalty() const { return penalty_; }

    /// Before a search: nu so large that the penalty falls along a direction of slope g . step that takes `taken` of what remains
    /// (> 0) [m], and no smaller than `least`. It never falls.
    void outweigh(double slope, double taken, double least);

    /// After a search that went `fraction` of the way.
    /// @param arrived  nothing remains.
    /// @param relaxed  what is pushed has given way: a full step that moved it little.
    void adapt(double fraction, bool arrived, bool relaxed);

    /// After a search that found no step at all: raises nu. @return false if driving less has been tried to the end.
    bool try_less();

    /// After a search: counts those in a row that came closer by hardly anything. @param taken  share of what remained.
    void count_stalls(double taken);
    bool is_stalled() const;

private:
    double share_ = 1;
    double penalty_ = 0;
    int resting_ = 0;  // iterations that leave the prescribed coordinates where they are
    int stalled_ = 0;
};

}  // namespace fettle::core::solver
