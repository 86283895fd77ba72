// SPDX-License-Identifier: MIT
/// Open CASCADE's curves and surfaces as the shapes that bounds are made of.
#pragma once

#include <Adaptor2d_Curve2d.hxx>
#include <Adaptor3d_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <array>

#include "core/step_importer/surface_bound.hpp"

namespace fettle::core::step_importer {

CurveShape shape_of(const Adaptor3d_Curve& curve);
/// One curve for each of u and v: their distances from a chord are bounded one by one.
std::array<CurveShape, 2> shapes_of(const Adaptor2d_Curve2d& curve);
SurfaceShape shape_of(const BRepAdaptor_Surface& surface);

inline Vector3d vector_of(const gp_XYZ& from) { return {from.X(), from.Y(), from.Z()}; }

}  // namespace fettle::core::step_importer
