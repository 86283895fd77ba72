// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>

#include <fettle/fettle.hpp>

int main() {
    const fettle::Vector3 turn(0, 0, std::acos(-1.0) / 2);
    const fettle::Vector3 turned = fettle::core::kinematics::rotation(turn) * fettle::Vector3::UnitX();
    std::printf("fettle %s: x turns to (%g, %g, %g)\n", fettle::version(), turned.x(), turned.y(), turned.z());
    return (turned - fettle::Vector3::UnitY()).norm() < 1e-15 ? 0 : 1;
}
