// SPDX-License-Identifier: MIT
/// Play of a fit: least distance of two bodies as assembled [m], certified. For a pin in a bore, drawn concentric, this is the radial play
/// (half the diametral one), as long as the fit is where the two are closest.
#pragma once

#include "fettle/design/objectives/objective.hpp"

namespace fettle::design::objectives {

class Play : public Objective {
public:
    Play(int a, int b) : a_(a), b_(b) {}
    Quantity value(const Simulated& simulated) const override;
    void add_seeds(const Simulated& simulated, const Quantity& quantity, double scale, Seeds& seeds) const override;
    double unit(double length_unit) const override { return length_unit; }

private:
    int a_, b_;
};

}  // namespace fettle::design::objectives
