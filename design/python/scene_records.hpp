// SPDX-License-Identifier: MIT
/// The members of what describes a scene (core/scene/), for records.hpp. A mesh's connectivity is no member: it is built from triangles and
/// loose edges.
#pragma once

#include <pybind11/numpy.h>

#include "core/base/units.hpp"
#include "core/scene/scene.hpp"
#include "design/python/arguments.hpp"
#include "design/python/records.hpp"
#include "design/shapes/mesh_program.hpp"

namespace fettle::design::python {

/// The Python `Mesh`: vertices n x 3, triangles m x 3, loose edges k x 2. The vertices of a mesh that is moved here are not copied.
pybind11::object mesh_to_python(core::geometry::Mesh mesh);
core::geometry::Mesh mesh_from_python(pybind11::handle mesh);

/// A numpy array that owns what it is made from, n x 3, without a copy.
pybind11::array rows_of(Matrix3X&& columns);
/// 3 x n from an array n x 3. Throws RaisedErrors with `what` where it has another shape.
Matrix3X columns_of(pybind11::handle rows, const std::string& where, const char* what);
/// m x width integers.
template <std::size_t width>
pybind11::array_t<int> index_rows(const std::vector<std::array<int, width>>& rows) {
    pybind11::array_t<int> out({rows.size(), width});
    if (!rows.empty()) std::copy_n(rows.front().data(), rows.size() * width, out.mutable_data());
    return out;
}
template <std::size_t width>
std::vector<std::array<int, width>> rows_from(pybind11::handle rows, const std::string& where, const char* what) {
    const auto array = pybind11::array_t<int, pybind11::array::c_style | pybind11::array::forcecast>::ensure(rows);
    if (!array || (array.size() > 0 && (array.ndim() != 2 || array.shape(1) != static_cast<pybind11::ssize_t>(width))))
        refuse(ErrorCode::wrong_type, where, what);
    std::vector<std::array<int, width>> out(static_cast<std::size_t>(array.size()) / width);
    if (!out.empty()) std::copy_n(array.data(), array.size(), out.front().data());
    return out;
}

}  // namespace fettle::design::python

FETTLE_WORDS(fettle::core::base::Dimension, "number", "length", "area", "volume", "angle", "time", "mass", "force", "torque", "energy",
             "speed", "angular_speed", "acceleration", "density", "stiffness", "angular_stiffness", "angular_acceleration", "power",
             "impulse", "angular_impulse")
FETTLE_WORDS(fettle::core::scene::BodyType, "dynamic", "static", "kinematic")
FETTLE_WORDS(fettle::core::scene::MassKind, "volume", "area", "length", "vertex")
FETTLE_WORDS(fettle::core::scene::MeshPolicy, "strict", "tolerant", "lenient")
FETTLE_WORDS(fettle::core::scene::Integrator, "implicit_euler", "bdf2", "newmark", "quasi_static")
FETTLE_WORDS(fettle::core::scene::CurveKind, "linear", "cubic", "trapezoid", "control_points")
FETTLE_WORDS(fettle::core::scene::JointKind, "ball", "revolute", "prismatic", "cylindrical", "planar", "fixed", "screw", "gear", "rack")
FETTLE_WORDS(fettle::core::scene::AssembleSide, "left", "right", "ahead", "behind")
FETTLE_WORDS(fettle::core::scene::MotorKind, "motion", "effort")
FETTLE_WORDS(fettle::core::scene::Orientation::Kind, "angles", "vector")

FETTLE_RECORD(fettle::core::geometry::Deviation, "Deviation", field("outside", &Type::out), field("inside", &Type::in),
              field("outside_is_proven", &Type::out_is_proven), field("inside_is_proven", &Type::in_is_proven),
              field("declared", &Type::declared))
FETTLE_RECORD(fettle::core::kinematics::Pose, "Pose", field("rotation", &Type::rotation), field("position", &Type::position))
FETTLE_RECORD(fettle::core::scene::MotionCurve, "MotionCurve", field("rate", &Type::rate), field("times", &Type::times),
              field("values", &Type::values), field("stop_time", &Type::stop_time))
FETTLE_RECORD(fettle::core::scene::PoseScript, "PoseScript", field("times", &Type::times), field("poses", &Type::poses))
FETTLE_RECORD(fettle::core::scene::Friction::Pair, "FrictionPair", field("material_a", &Type::material_a),
              field("material_b", &Type::material_b), field("mu", &Type::mu))
FETTLE_RECORD(fettle::core::scene::Friction, "Friction", field("mu", &Type::mu), field("materials", &Type::materials),
              field("pairs", &Type::pairs), field("eps_v", &Type::eps_v), field("rounds", &Type::rounds))
FETTLE_RECORD(fettle::core::scene::Damping, "Damping", field("linear", &Type::linear), field("angular", &Type::angular))
FETTLE_RECORD(fettle::core::scene::MeshProgram, "MeshProgram", path_field("command", &Type::command),
              path_field("directory", &Type::directory), field("format", &Type::format), field("unit", &Type::unit),
              field("time_limit", &Type::time_limit))
FETTLE_RECORD(fettle::core::scene::ShapeSpec, "ShapeSpec", field("part", &Type::part), field("dimensions", &Type::dimensions),
              field("counts", &Type::counts), field("program", &Type::program), field("chord", &Type::chord),
              field("angles", &Type::angles), field("numbers", &Type::numbers))
FETTLE_RECORD(fettle::core::scene::Curve, "Curve", field("kind", &Type::kind), field("rate", &Type::rate), field("times", &Type::times),
              field("values", &Type::values), field("stop_time", &Type::stop_time))
FETTLE_RECORD(fettle::core::scene::Attachment, "Attachment", field("body", &Type::body), field("point", &Type::point),
              field("axis", &Type::axis))
FETTLE_RECORD(fettle::core::scene::CoordinateForces, "CoordinateForces", field("stiffness", &Type::stiffness), field("rest", &Type::rest),
              field("preload", &Type::preload), field("damping", &Type::damping), field("friction", &Type::friction),
              field("limits", &Type::limits))
FETTLE_RECORD(fettle::core::scene::Assemble, "Assemble", field("side", &Type::side), field("from_", &Type::from), field("to", &Type::to))
FETTLE_RECORD(fettle::core::scene::Joint, "Joint", field("name", &Type::name), field("where", &Type::where), field("kind", &Type::kind),
              field("a", &Type::a), field("b", &Type::b), field("pitch", &Type::pitch), field("swing", &Type::swing),
              field("of", &Type::of), field("ratio", &Type::ratio), field("forces", &Type::forces), field("collide", &Type::collide),
              field("assemble", &Type::assemble))
FETTLE_RECORD(fettle::core::scene::Spring, "Spring", field("name", &Type::name), field("where", &Type::where), field("joint", &Type::joint),
              field("a", &Type::a), field("b", &Type::b), field("forces", &Type::forces))
FETTLE_RECORD(fettle::core::scene::Motor, "Motor", field("name", &Type::name), field("where", &Type::where), field("joint", &Type::joint),
              field("kind", &Type::kind), field("curve", &Type::curve))
FETTLE_RECORD(fettle::core::scene::PointLoad, "PointLoad", field("name", &Type::name), field("where", &Type::where),
              field("body", &Type::body), field("point", &Type::point), field("force", &Type::force))
FETTLE_RECORD(fettle::core::scene::Mechanism, "Mechanism", field("joints", &Type::joints), field("springs", &Type::springs),
              field("motors", &Type::motors), field("loads", &Type::loads))

namespace pybind11::detail {

template <>
class type_caster<fettle::core::geometry::Mesh> {
public:
    PYBIND11_TYPE_CASTER(fettle::core::geometry::Mesh, const_name("fettle.Mesh"));
    bool load(handle source, bool) {
        if (!isinstance(source, fettle::design::python::record_class("Mesh"))) return false;
        value = fettle::design::python::mesh_from_python(source);
        return true;
    }
    static handle cast(fettle::core::geometry::Mesh source, return_value_policy, handle) {
        return fettle::design::python::mesh_to_python(std::move(source)).release();
    }
};

}  // namespace pybind11::detail

FETTLE_RECORD(fettle::core::scene::Inertial, "Inertial", field("mass", &Type::mass), field("centre", &Type::centre),
              field("inertia", &Type::inertia))
FETTLE_RECORD(fettle::core::scene::Orientation, "Orientation", field("kind", &Type::kind), field("numbers", &Type::numbers))
FETTLE_RECORD(fettle::core::scene::Variable, "Variable", field("name", &Type::name), field("formula", &Type::formula),
              field("value", &Type::value))
FETTLE_RECORD(fettle::core::scene::BoundNumber, "BoundNumber", field("place", &Type::place), field("formula", &Type::formula))
FETTLE_RECORD(fettle::core::scene::Body, "Body", field("name", &Type::name), field("where", &Type::where), field("type", &Type::type),
              field("mesh", &Type::mesh), field("shape", &Type::shape), field("mesh_policy", &Type::mesh_policy),
              field("density", &Type::density), field("density_given", &Type::density_given), field("mass_kind", &Type::mass_kind),
              field("mass_kind_given", &Type::mass_kind_given), field("inertial", &Type::inertial), field("material", &Type::material),
              field("mu", &Type::mu), field("pose", &Type::pose), field("orientation", &Type::orientation),
              field("linear_velocity", &Type::linear_velocity), field("angular_velocity", &Type::angular_velocity),
              field("prescribed", &Type::prescribed), field("script", &Type::script), field("force", &Type::force),
              field("torque", &Type::torque), field("damping", &Type::damping), field("reference_point", &Type::reference_point),
              field("group", &Type::group))
FETTLE_RECORD(fettle::core::scene::Scene, "Scene", path_field("path", &Type::path), field("length_unit", &Type::length_unit),
              field("bodies", &Type::bodies), field("gravity", &Type::gravity), field("timestep", &Type::timestep),
              field("end_time", &Type::end_time), field("dhat", &Type::dhat), field("dmin", &Type::dmin), field("kappa", &Type::kappa),
              field("area_weighted", &Type::area_weighted), field("round_contact", &Type::round_contact),
              field("contact_damping_time", &Type::contact_damping_time), field("friction", &Type::friction),
              field("mechanism", &Type::mechanism), field("integrator", &Type::integrator),
              field("velocity_tolerance", &Type::velocity_tolerance), field("max_newton_iterations", &Type::max_newton_iterations),
              field("variables", &Type::variables), field("numbers", &Type::numbers), field("ignore", &Type::ignore),
              field("warnings", &Type::warnings))
