// SPDX-License-Identifier: MIT
#include "core/step_importer/gate.hpp"

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/step_importer/occt_shapes.hpp"

namespace fettle::core::step_importer {
namespace {

constexpr double asked_of_integrals = 1e-4, of_integration = 1e-6;  // relative: asked of each face; allowed of the whole

struct Measures {
    double volume = 0, area = 0;
    Vector3d centroid = Vector3d::Zero(), low = Vector3d::Zero(), high = Vector3d::Zero();
};

Measures measures_of(const BodyMesh& mesh) {
    Measures out;
    const Vector3d origin = mesh.places.front();
    Vector3d moment = Vector3d::Zero();
    for (const auto& t : mesh.triangles) {
        const Vector3d a = mesh.places[t[0]] - origin, b = mesh.places[t[1]] - origin, c = mesh.places[t[2]] - origin;
        const double volume = a.dot(b.cross(c)) / 6;
        out.volume += volume;
        moment += volume * (a + b + c) / 4;
        out.area += (b - a).cross(c - a).norm() / 2;
    }
    out.centroid = origin + moment / out.volume;
    out.low = out.high = origin;
    for (const auto& t : mesh.triangles) {
        for (const int node : t) {
            out.low = out.low.cwiseMin(mesh.places[node]);
            out.high = out.high.cwiseMax(mesh.places[node]);
        }
    }
    return out;
}

/// Open CASCADE's integrals over the exact faces. Each is off by a thousandth and more somewhere: fixed Gauss points on splines of many
/// knots, adaptive ones where edges are splines; those of Gauss and Kronrod are right, and know the volume alone in good time.
enum class Integrals { fixed, adaptive, kronrod };

Measures measures_of(const TopoDS_Solid& solid, Integrals integrals) {
    Measures out;
    GProp_GProps volume, area;
    if (integrals == Integrals::kronrod) {
        BRepGProp::VolumePropertiesGK(solid, volume, asked_of_integrals, false, false, false, false);
    } else if (integrals == Integrals::fixed) {
        BRepGProp::VolumeProperties(solid, volume);
        BRepGProp::SurfaceProperties(solid, area);
    } else {
        BRepGProp::VolumeProperties(solid, volume, of_integration);
        BRepGProp::SurfaceProperties(solid, area, of_integration);
    }
    out.volume = volume.Mass();
    out.area = area.Mass();
    out.centroid = vector_of(volume.CentreOfMass().XYZ());
    return out;
}

std::string told(const char* what, double mesh, double solid, double allowed) {
    char text[200];
    std::snprintf(text, sizeof text, "its mesh and its faces disagree: %s %.9g and %.9g, where %.3g is allowed", what, mesh, solid,
                  allowed);
    return text;
}

}  // namespace

namespace {

/// What the mesh may differ by.
struct Allowed {
    double volume = 0, area = 0, centroid = 0;
};

/// Which of the measures agree.
struct Agreement {
    bool volume = false, area = false, centroid = false;
    bool all() const { return volume && area && centroid; }
};

void compare(const Measures& own, const Measures& exact, Integrals integrals, const Allowed& allowed, Agreement& to) {
    to.volume = to.volume || std::abs(own.volume - std::abs(exact.volume)) <= allowed.volume;
    if (integrals == Integrals::kronrod) return;
    to.area = to.area || std::abs(own.area - exact.area) <= allowed.area;
    to.centroid = to.centroid || (own.centroid - exact.centroid).norm() <= allowed.centroid;
}

std::string box_fault(const Measures& own, const TopoDS_Solid& solid, double allowed) {
    Bnd_Box box;
    BRepBndLib::AddOptimal(solid, box, false, false);
    double low[3], high[3];
    box.Get(low[0], low[1], low[2], high[0], high[1], high[2]);
    for (int k = 0; k < 3; ++k) {
        if (!(std::abs(own.low[k] - low[k]) <= allowed)) return told("box [mm]", own.low[k], low[k], allowed);
        if (!(std::abs(own.high[k] - high[k]) <= allowed)) return told("box [mm]", own.high[k], high[k], allowed);
    }
    return {};
}

}  // namespace

void check_against_solid(const TopoDS_Solid& solid, BodyMesh& mesh) {
    Measures own = measures_of(mesh), exact = measures_of(solid, Integrals::fixed);
    if (own.volume < 0 && exact.volume < 0) {  // inside out, both
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
        std::swap(mesh.out, mesh.in);
        own.volume = -own.volume, exact.volume = -exact.volume;
    }
    const double size = (own.high - own.low).norm(), volume = mesh.volume_allowance + of_integration * std::abs(own.volume);
    const Allowed allowed{volume, mesh.area_allowance + of_integration * own.area, volume / std::abs(own.volume) * size};
    Agreement agree;
    compare(own, exact, Integrals::fixed, allowed, agree);
    for (const Integrals each : {Integrals::adaptive, Integrals::kronrod})
        if (!agree.all()) compare(own, measures_of(solid, each), each, allowed, agree);
    if (!agree.volume) throw Fault{told("volume [mm^3]", own.volume, exact.volume, allowed.volume)};
    if (!agree.area) throw Fault{told("area [mm^2]", own.area, exact.area, allowed.area)};
    if (!agree.centroid) throw Fault{told("distance of centroids [mm]", (own.centroid - exact.centroid).norm(), 0, allowed.centroid)};
    if (const std::string fault = box_fault(own, solid, std::max(mesh.out, mesh.in) + 1e-6 * size); !fault.empty()) throw Fault{fault};
}

}  // namespace fettle::core::step_importer
