// SPDX-License-Identifier: MIT
#include "core/step_importer/occt_shapes.hpp"

#include <Geom2dConvert.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <gp_Circ.hxx>
#include <gp_Circ2d.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Elips.hxx>
#include <gp_Elips2d.hxx>
#include <gp_Hypr.hxx>
#include <gp_Hypr2d.hxx>
#include <gp_Parab.hxx>
#include <gp_Parab2d.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>
#include <optional>

namespace fettle::core::step_importer {
namespace {

/// Where the poles of each piece begin (from 1), for a spline whose inner knots have been given the multiplicity of its degree: at knot k
/// stands pole m_1 + ... + m_k - degree. Nothing: not all of them have it.
template <class Multiplicity>
std::optional<std::vector<int>> begins_of_pieces(int first, int last, int degree, const Multiplicity& multiplicity) {
    std::vector<int> begins;
    int sum = 0;
    for (int k = 1; k <= last; ++k) {
        sum += multiplicity(k);
        if (k >= first && multiplicity(k) < degree) return std::nullopt;
        if (k >= first && k < last) begins.push_back(sum - degree);
    }
    return begins;
}

template <class Curve, class PoleOf>
std::vector<BezierCurve> pieces_of(const Curve& given, const PoleOf& pole_of) {
    const auto curve = Curve::DownCast(given->Copy());
    if (curve->IsPeriodic()) curve->SetNotPeriodic();
    const int degree = curve->Degree();
    if (curve->NbKnots() > 2) curve->IncreaseMultiplicity(2, curve->NbKnots() - 1, degree);
    const int first = curve->FirstUKnotIndex(), last = curve->LastUKnotIndex();
    const auto begins = begins_of_pieces(first, last, degree, [&](int k) { return curve->Multiplicity(k); });
    std::vector<BezierCurve> pieces;
    for (int k = first; begins && k < last; ++k) {
        BezierCurve piece;
        piece.from = curve->Knot(k), piece.to = curve->Knot(k + 1);
        for (int i = 0; i <= degree; ++i) piece.poles.push_back(pole_of(*curve, (*begins)[static_cast<std::size_t>(k - first)] + i));
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

CurveShape spline(std::vector<BezierCurve> pieces, double period) {
    CurveShape shape;
    if (pieces.empty()) return shape;
    shape.kind = CurveShape::Kind::spline;
    shape.pieces = std::move(pieces);
    shape.period = period;
    return shape;
}

CurveShape spline(const Handle(Geom_BSplineCurve) & curve) {
    const auto pole = [](const Geom_BSplineCurve& of, int i) {
        Pole out;
        const double weight = of.Weight(i);
        out << weight * vector_of(of.Pole(i).XYZ()), weight;
        return out;
    };
    return spline(pieces_of(curve, pole), curve->IsPeriodic() ? curve->Period() : 0);
}

std::array<CurveShape, 2> splines(const Handle(Geom2d_BSplineCurve) & curve) {
    std::array<CurveShape, 2> shapes;
    for (int axis = 0; axis < 2; ++axis) {
        const auto pole = [&](const Geom2d_BSplineCurve& of, int i) {
            const double weight = of.Weight(i);
            return Pole(weight * of.Pole(i).Coord(axis + 1), 0, 0, weight);
        };
        shapes[axis] = spline(pieces_of(curve, pole), curve->IsPeriodic() ? curve->Period() : 0);
    }
    return shapes;
}

PatchGrid grid_of(const Handle(Geom_BSplineSurface) & given) {
    PatchGrid grid;
    if (given->IsUPeriodic()) grid.u_period = given->UPeriod();
    if (given->IsVPeriodic()) grid.v_period = given->VPeriod();
    const auto surface = Handle(Geom_BSplineSurface)::DownCast(given->Copy());
    if (surface->IsUPeriodic()) surface->SetUNotPeriodic();
    if (surface->IsVPeriodic()) surface->SetVNotPeriodic();
    const int p = surface->UDegree(), q = surface->VDegree();
    if (surface->NbUKnots() > 2) surface->IncreaseUMultiplicity(2, surface->NbUKnots() - 1, p);
    if (surface->NbVKnots() > 2) surface->IncreaseVMultiplicity(2, surface->NbVKnots() - 1, q);
    const int u_first = surface->FirstUKnotIndex(), v_first = surface->FirstVKnotIndex();
    const auto rows = begins_of_pieces(u_first, surface->LastUKnotIndex(), p, [&](int k) { return surface->UMultiplicity(k); });
    const auto columns = begins_of_pieces(v_first, surface->LastVKnotIndex(), q, [&](int k) { return surface->VMultiplicity(k); });
    if (!rows || !columns) return {};
    grid.v_count = static_cast<int>(columns->size());
    for (int r = 0; r < static_cast<int>(rows->size()); ++r) {
        for (int c = 0; c < grid.v_count; ++c) {
            BezierPatch patch{p,
                              q,
                              {},
                              surface->UKnot(u_first + r),
                              surface->UKnot(u_first + r + 1),
                              surface->VKnot(v_first + c),
                              surface->VKnot(v_first + c + 1)};
            for (int i = 0; i <= p; ++i) {
                for (int j = 0; j <= q; ++j) {
                    const int row = (*rows)[static_cast<std::size_t>(r)] + i, column = (*columns)[static_cast<std::size_t>(c)] + j;
                    const double weight = surface->Weight(row, column);
                    Pole pole;
                    pole << weight * vector_of(surface->Pole(row, column).XYZ()), weight;
                    patch.poles.push_back(pole);
                }
            }
            grid.pieces.push_back(std::move(patch));
        }
    }
    return grid;
}

/// Points whose hull has the curve in it.
std::vector<Vector3d> hull_of(const Adaptor3d_Curve& curve, const CurveShape& shape) {
    std::vector<Vector3d> hull;
    const double from = curve.FirstParameter(), to = curve.LastParameter();
    if (shape.kind == CurveShape::Kind::spline) {
        for (const BezierCurve& piece : shape.pieces)
            for (const Pole& pole : piece.poles) hull.push_back(pole.head<3>() / pole[3]);
        return hull;
    }
    if (shape.kind == CurveShape::Kind::unknown || !(to - from < 1e6)) return {};
    if (shape.kind == CurveShape::Kind::line) return {vector_of(curve.Value(from).XYZ()), vector_of(curve.Value(to).XYZ())};
    // In a box about the middle: what the speed reaches.
    const auto most = suprema(shape, from, to);
    const Vector3d middle = vector_of(curve.Value((from + to) / 2).XYZ());
    const double reach = most->first * (to - from) / 2;
    for (int k = 0; k < 8; ++k)
        hull.push_back(middle + reach * Vector3d((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1));
    return hull;
}

constexpr double recognised = 1e-6;  // [mm]

void add_samples(const BRepAdaptor_Surface& surface, std::vector<Vector3d>& places, std::vector<Vector3d>& normals) {
    constexpr int count = 4;
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            const auto between = [](double from, double to, int k) { return from + (to - from) * (k + 0.5) / count; };
            gp_Pnt place;
            gp_Vec u, v;
            surface.D1(between(surface.FirstUParameter(), surface.LastUParameter(), i),
                       between(surface.FirstVParameter(), surface.LastVParameter(), j), place, u, v);
            const Vector3d normal = vector_of(u.Crossed(v).XYZ());
            if (!(normal.norm() > 0)) continue;
            places.push_back(vector_of(place.XYZ()));
            normals.push_back(normal.normalized());
        }
    }
}

void set_axis(const gp_Ax1& axis, SurfaceShape& shape) {
    shape.point = vector_of(axis.Location().XYZ());
    shape.axis = vector_of(axis.Direction().XYZ());
}

}  // namespace

CurveShape shape_of(const Adaptor3d_Curve& curve) {
    using Kind = CurveShape::Kind;
    switch (curve.GetType()) {
        case GeomAbs_Line:
            return {Kind::line, 1, 0, {}, 0};
        case GeomAbs_Circle:
            return {Kind::circle, curve.Circle().Radius(), 0, {}, 0};
        case GeomAbs_Ellipse:
            return {Kind::ellipse, curve.Ellipse().MajorRadius(), curve.Ellipse().MinorRadius(), {}, 0};
        case GeomAbs_Parabola:
            return {Kind::parabola, curve.Parabola().Focal(), 0, {}, 0};
        case GeomAbs_Hyperbola:
            return {Kind::hyperbola, curve.Hyperbola().MajorRadius(), curve.Hyperbola().MinorRadius(), {}, 0};
        case GeomAbs_BezierCurve:
            return spline(GeomConvert::CurveToBSplineCurve(curve.Bezier()));
        case GeomAbs_BSplineCurve:
            return spline(curve.BSpline());
        default:
            return {};
    }
}

std::array<CurveShape, 2> shapes_of(const Adaptor2d_Curve2d& curve) {
    using Kind = CurveShape::Kind;
    const auto both = [](Kind kind, double a, double b = 0) {
        const CurveShape one{kind, a, b, {}, 0};
        return std::array<CurveShape, 2>{one, one};
    };
    switch (curve.GetType()) {
        case GeomAbs_Line:
            return both(Kind::line, 1);
        case GeomAbs_Circle:
            return both(Kind::circle, curve.Circle().Radius());
        case GeomAbs_Ellipse:
            return both(Kind::ellipse, curve.Ellipse().MajorRadius(), curve.Ellipse().MinorRadius());
        case GeomAbs_Parabola:
            return both(Kind::parabola, curve.Parabola().Focal());
        case GeomAbs_Hyperbola:
            return both(Kind::hyperbola, curve.Hyperbola().MajorRadius(), curve.Hyperbola().MinorRadius());
        case GeomAbs_BezierCurve:
            return splines(Geom2dConvert::CurveToBSplineCurve(curve.Bezier()));
        case GeomAbs_BSplineCurve:
            return splines(curve.BSpline());
        default:
            return {};
    }
}

SurfaceShape shape_of(const BRepAdaptor_Surface& surface) {
    using Kind = SurfaceShape::Kind;
    SurfaceShape shape;
    switch (surface.GetType()) {
        case GeomAbs_Plane:
            shape.kind = Kind::plane;
            set_axis(surface.Plane().Axis(), shape);
            break;
        case GeomAbs_Cylinder:
            shape.kind = Kind::cylinder;
            set_axis(surface.Cylinder().Axis(), shape);
            shape.radius = surface.Cylinder().Radius();
            break;
        case GeomAbs_Cone:
            shape.kind = Kind::cone;
            set_axis(surface.Cone().Axis(), shape);
            break;
        case GeomAbs_Sphere:
            shape.kind = Kind::sphere;
            shape.point = vector_of(surface.Sphere().Location().XYZ());
            shape.radius = surface.Sphere().Radius();
            break;
        case GeomAbs_Torus:
            shape.kind = Kind::torus;
            set_axis(surface.Torus().Axis(), shape);
            shape.radius = surface.Torus().MajorRadius(), shape.minor = surface.Torus().MinorRadius();
            break;
        case GeomAbs_SurfaceOfExtrusion:
            shape.kind = Kind::extrusion;
            shape.profile = shape_of(*surface.BasisCurve());
            break;
        case GeomAbs_SurfaceOfRevolution:
            shape.kind = Kind::revolution;
            set_axis(surface.AxeOfRevolution(), shape);
            shape.profile = shape_of(*surface.BasisCurve());
            shape.profile_hull = hull_of(*surface.BasisCurve(), shape.profile);
            break;
        case GeomAbs_BezierSurface:
            shape.grid = grid_of(GeomConvert::SurfaceToBSplineSurface(surface.Bezier()));
            break;
        case GeomAbs_BSplineSurface:
            shape.grid = grid_of(surface.BSpline());
            break;
        default:
            break;
    }
    if (shape.grid.pieces.empty()) return shape;
    shape.kind = Kind::spline;
    std::vector<Vector3d> places, normals;
    add_samples(surface, places, normals);
    recognise(shape, places, normals, recognised);
    return shape;
}

}  // namespace fettle::core::step_importer
