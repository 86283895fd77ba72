// SPDX-License-Identifier: MIT
/// Mass of one or more bodies [kg]: density times volume of their closed meshes, static bodies included.
#pragma once

#include <vector>

#include "fettle/design/objectives/objective.hpp"

namespace fettle::design::objectives {

class Mass : public Objective {
public:
    /// Contract: the bodies' meshes are closed.
    explicit Mass(std::vector<int> bodies) : bodies_(std::move(bodies)) {}
    Quantity value(const Simulated& simulated) const override;
    void add_seeds(const Simulated& simulated, const Quantity& quantity, double scale, Seeds& seeds) const override;
    double unit(double) const override { return 1e-3; }

private:
    std::vector<int> bodies_;
};

}  // namespace fettle::design::objectives
