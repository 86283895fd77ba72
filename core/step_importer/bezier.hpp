// SPDX-License-Identifier: MIT
/// Rational Bezier pieces of curves and surfaces, and bounds of their derivatives by control nets (Piegl and Tiller, The NURBS Book, 3.3
/// and 4.3: a derivative is again a Bezier form, and a form with positive weights lies in the hull of its control points).
///
/// Numbers are plain doubles: what rounding does to a bound is far below the share of the size that body_mesh.hpp adds.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fettle::core::step_importer {

using Pole = Eigen::Vector4d;  ///< (w x, w y, w z, w), w > 0

/// A piece of a curve over [from, to], degree poles.size() - 1.
struct BezierCurve {
    std::vector<Pole> poles;
    double from = 0, to = 1;
};

/// A piece of a surface over [u0, u1] x [v0, v1]; pole (i, j) of u and v is poles[i * (v_degree + 1) + j].
struct BezierPatch {
    int u_degree = 0, v_degree = 0;
    std::vector<Pole> poles;
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
};

/// Largest norms over a range.
struct CurveSuprema {
    double first = 0, second = 0;  ///< of C', C''
    double jump = 0;               ///< sum over the joints of pieces within the range of the jumps of C'
};
struct SurfaceSuprema {
    double u = 0, v = 0, uu = 0, uv = 0, vv = 0;  ///< of S_u, S_v, S_uu, S_uv, S_vv
    double jump_u = 0, jump_v = 0;                ///< of S_u across lines u = const, of S_v across lines v = const, where pieces meet
};

/// Over [from, to]; pieces in the order of their parameter. What lies beyond them counts as the nearest piece goes on: the range is cut.
/// Contract: from <= to, pieces not empty.
CurveSuprema suprema(const std::vector<BezierCurve>& pieces, double from, double to);

/// A grid of pieces: (i, j) of u and v is pieces[i * v_count + j].
struct PatchGrid {
    std::vector<BezierPatch> pieces;
    int v_count = 0;
    double u_period = 0, v_period = 0;  ///< 0: none
};
/// Over [u0, u1] x [v0, v1], reduced by the periods.
SurfaceSuprema suprema(const PatchGrid& grid, double u0, double u1, double v0, double v1);

}  // namespace fettle::core::step_importer
