// SPDX-License-Identifier: MIT
/// The processes that fettle knows by name: fdm, sla, sls, mjf, cnc, laser. A start for a first part; their sources differ by two to three
/// times and rarely say whether they mean three standard deviations, a radius or a diameter: measure the machine (`fettle coupon`).
///
///   +-t in mm, of a diameter, width, thickness, length or height; bias: how much larger than drawn it comes out [mm]
///   fdm    0.3 up to 100 mm, 0.5% of larger ones; holes -0.2          Layer X (all of it: holes 0.1 to 0.3 small); KapyCAD (holes).
///                                                                     Makelab: 0.2 of small features, 0.5 over 200 mm
///   sla    0.1 up to 100 mm, 0.2% of larger ones                      Layer X (0.1; 0.05 where fine); Makelab (0.1 of small features,
///                                                                     0.2 over 100 mm). Forge Labs: 0.25
///   sls    0.2 up to 100 mm, 0.2% of larger ones;                     Layer X; Xometry (small holes and gaps tighter than drawn, to be
///          holes, slots, gaps -0.15                                   offset by 0.006 inch)
///   mjf    0.3, 0.2% of sizes over 150 mm;                          Makelab (0.3); the rest taken from sls, the same powder
///          holes, slots, gaps -0.15
///   cnc    ISO 2768-1 class m, angles too                             what holds where a drawing says nothing; metals are often made to f
///   laser  0.13; the line is cut in its middle, the kerf is 0.2:      Big Blue Saw (0.005 inch); Snijlab, Ponoko (kerf about 0.2); Cut
///          pins, walls -0.2, holes, slots, gaps +0.2; no heights      Laser Cut (0.08 to 0.45)
/// Uncertain: where no bias stands there is one that nobody publishes, and heights are taken to be as exact as lengths. How much the
/// features of one print share is published nowhere: half of the variance is taken; of machined features, which are cut one by one, none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "design/tolerances/process.hpp"

namespace fettle::design::tolerances {

const std::vector<Process>& known_processes();

/// Null: none of this name.
const Process* find_known_process(std::string_view name);
std::vector<std::string_view> known_process_names();

}  // namespace fettle::design::tolerances
