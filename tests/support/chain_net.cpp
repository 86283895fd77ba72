// SPDX-License-Identifier: MIT
#include "tests/support/chain_net.hpp"

#include <cstdio>

namespace fettle::tests::support {

std::string chain_net_scene(int n, const std::string& mesh) {
    constexpr double pitch_x = 1.65, pitch_z = 1.6;
    std::string bodies;
    const auto add = [&](double column, double row, const char* rotation, bool fixed) {
        char body[256];
        std::snprintf(body, sizeof body,
                      R"(%s{"mesh": "%s", "position": [%.17g, 0, %.17g], "rotation": %s, "density": 7680, "is_dof_fixed": %s})",
                      bodies.empty() ? "\n" : ",\n", mesh.c_str(), pitch_x * column, pitch_z * row, rotation, fixed ? "true" : "false");
        bodies += body;
    };
    const auto on_border = [n](int i) { return i == 0 || i == n - 1; };
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            if (!on_border(row) || !on_border(column)) add(column, row, "[90, 90, 0]", on_border(row) || on_border(column));
            if (!on_border(row) && column + 1 < n) add(column + 0.5, row, "[0, 0, 90]", false);
            if (!on_border(column) && row + 1 < n) add(column, row + 0.5, "[90, 0, 90]", false);
        }
    return R"({"scene_type": "distance_barrier_rb_problem", "timestep": 0.01, "max_time": 20, "rigid_body_problem": )"
           R"({"gravity": [0, -9.81, 0], "rigid_bodies": [)" +
           bodies + "]}}\n";
}

}  // namespace fettle::tests::support
