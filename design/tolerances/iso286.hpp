// SPDX-License-Identifier: MIT
/// Limits of size of a tolerance class at a nominal size, such as 25 H7 or 25 g6: ISO 286-1, from its published tables (they are rounded,
/// so that no formula gives them all). General tolerances are iso2768.hpp.
///
/// A class is a letter and a grade. The grade n gives the width IT_n of the interval, the letter its place:
///   shafts  c d e f g h     upper deviation es = -table,            lower es - IT_n
///           js              -IT_n / 2 to +IT_n / 2
///           k m n p r s     lower deviation ei = +table,            upper ei + IT_n     (k of IT8 and coarser: ei = 0)
///   holes   C D E F G H     lower deviation EI = -es of the shaft,  upper EI + IT_n
///           JS              -IT_n / 2 to +IT_n / 2
///           K M N P R S     upper deviation ES = -table + Delta,    lower ES - IT_n
///   Delta = IT_n - IT_(n-1) over 3 mm for K, M, N up to IT8 and for P, R, S up to IT7, else 0. It makes fits such as H7/p6 and P7/h6
///   equal.
/// Single values of the standard: M6 over 250 up to 315 mm has ES = -9 um (by the rule -11); N9 and coarser over 3 mm have ES = 0; K has
/// ES = 0 in all grades up to 3 mm.
/// js and JS are exact halves, 25 js7 is +-10.5 um. For grades 7 to 11 the standard permits, and does not ask for, odd widths to be rounded
/// down to an even one, and many printed tables do so (25 js7: +-10 um): their limits lie up to 0.5 um within ours.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "design/tolerances/deviation_limits.hpp"

namespace fettle::design::tolerances {

/// @param tolerance_class  "H7", "g6", "js9", "JS9": IT5 to IT14, the letters above. Capital letters are holes.
/// @param nominal          [m], over 0 up to 0.5.
/// Errors: no letter and grade (parse); a letter, a grade or a size that is not covered (out_of_range); infinity or NaN (not_finite); a
/// combination that the standard does not give (out_of_range): grade 14 up to 1 mm, N9 and coarser up to 1 mm, K9 and coarser over 3 mm.
Result<DeviationLimits> iso286_limits(std::string_view tolerance_class, double nominal, const std::string& where);

}  // namespace fettle::design::tolerances
