// SPDX-License-Identifier: MIT
/// Nets of chain links of any size, after the paper's chain-net-4x4: how cost grows with the number of contacts.
#pragma once

#include <string>

namespace fettle::tests::support {

/// The text of a scene of the paper's format: n x n rings in the plane y = 0 without the four corners, those on the border fixed, a link
/// between each two neighbours that are not both on one side of the border. n = 4 gives chain/chain-net/chain-net-4x4.json, body for body
/// and number for number. Contract: n >= 3. Bodies: n^2 - 4 + 2 (n - 2) (n - 1).
/// @param mesh  the link's, relative to a meshes/ folder above the file: "wrecking-ball/link.obj", "codimensional/edges/link.obj"
std::string chain_net_scene(int n, const std::string& mesh = "wrecking-ball/link.obj");

}  // namespace fettle::tests::support
