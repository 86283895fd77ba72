// SPDX-License-Identifier: MIT
/// Plain description of a scene, SI units, meshes resolved: what a file said, before anything is computed from it.
/// Readers: scene_files/scene_reader.hpp (*.scene.json), paper_scenes/fixture_reader.hpp (the source paper's files). Next stage:
/// setup/build_model.hpp.
///
///     core::scene::Scene scene;
///     scene.gravity = {0, 0, -9.81};
///     scene.end_time = 0.5;
///     core::scene::Body& ball = scene.bodies.emplace_back();
///     ball.name = "ball";
///     ball.density = 1240;
///     if (auto mesh = core::mesh_files::read_mesh("ball.stl", {.unit = 1e-3})) ball.mesh = std::move(mesh).value();
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/expression/formula.hpp"
#include "core/geometry/mesh.hpp"
#include "core/kinematics/path.hpp"
#include "core/scene/angles.hpp"
#include "core/scene/inertial.hpp"
#include "core/scene/mechanism.hpp"

namespace fettle::core::scene {

enum class BodyType { dynamic_body, static_body, kinematic_body };

/// A prescribed coordinate as a function of time, relative to its start: u(t) = rate * t + table(t), where the table is
/// piecewise linear through (times[i], values[i]) and constant outside. After `stop_time` (if any) u stays as it is.
struct MotionCurve {
    double rate = 0;                  ///< [m/s] or [rad/s]
    std::vector<double> times;        ///< [s], strictly increasing; empty: no table
    std::vector<double> values;       ///< [m] or [rad]
    std::optional<double> stop_time;  ///< [s]
};
double motion_value(const MotionCurve& curve, double time);

/// A degree of freedom: free, or prescribed (held where it is if the curve is zero). Order: px py pz rx ry rz, world axes.
/// Rotations are components of the rotation vector of each time step.
using PrescribedMotion = std::array<std::optional<MotionCurve>, 6>;

/// Poses at times, for a kinematic body: from its start pose at time 0 through poses[k] at times[k], each stretch straight in its own
/// chart (q linear, R = exp(s [theta]) R_k). After the last one the body goes on with its linear and angular velocity.
struct PoseScript {
    std::vector<double> times;            ///< [s], strictly increasing, > 0
    std::vector<kinematics::Pose> poses;  ///< of the file's frame
    bool empty() const { return times.empty(); }
};
/// At `time`, from `start` at time 0; before 0 the start, after the last time the last pose. Each stretch turns the shorter way round.
kinematics::Pose scripted_pose(const PoseScript& script, const kinematics::Pose& start, double time);

/// What `density` is per: decides the mass integral of a dynamic body.
enum class MassKind {
    volume,  ///< closed mesh, or nearly (geometry/mass_moments.hpp) in a lenient scene [kg/m^3]
    area,    ///< triangles as a shell [kg/m^2]
    length,  ///< all edges as wires [kg/m]
    vertex   ///< all vertices as points [kg each]
};

/// Coulomb friction. The coefficient of two bodies: that of their pair of materials if one is listed, else the geometric mean of their own
/// (Body::mu, else their material's, else `mu`).
struct Friction {
    struct Pair {
        std::string material_a, material_b;
        double mu = 0;
    };
    double mu = 0;                            ///< default
    std::map<std::string, double> materials;  ///< mu of a material against itself
    std::vector<Pair> pairs;
    double eps_v = 1e-3;  ///< static speed bound [m/s]: below it friction is smoothed
    int rounds = 2;       ///< solves per step, each with normal forces and tangents of the one before; negative: until they agree; 0: off

    /// Index in `pairs` of two materials, in either order; -1 if they are not listed together or one has no name.
    int pair_of(const std::string& material_a, const std::string& material_b) const;
};

/// How a step follows from those before it (docs/method/energy.md#integrators). Dynamics: first order and dissipative; second order; second
/// order and energy keeping. Quasi-static: each step is an equilibrium, without velocities.
enum class Integrator { implicit_euler, bdf2, newmark, quasi_static };

/// Resistance to a body's motion in proportion to its mass: force - linear m v at its centre of mass, torque - angular I omega about it.
struct Damping {
    double linear = 0;   ///< [1/s]
    double angular = 0;  ///< [1/s]
};

/// How strictly a mesh is taken (model/check_scene.hpp).
enum class MeshPolicy {
    strict,    ///< a perfect solid or nothing: what parts of files are, and everything on request
    tolerant,  ///< what does no harm to a rigid body is a warning: meshes of our own format
    lenient    ///< as the source paper's program: the reader has said what there is to say
};

/// A command that writes a mesh when it is given dimensions: {out} in its words stands for the file to write, {NAME} for a dimension.
struct MeshProgram {
    std::vector<std::string> command = {};  ///< program and arguments
    std::string directory = {};             ///< that it runs in; empty: the working directory
    std::string format = "stl";             ///< of the file that it writes: stl, obj, off, ply or 3mf
    double unit = 1;                        ///< of the numbers that it is given and writes [m]
    double time_limit = 300;                ///< [s]
    bool operator==(const MeshProgram&) const = default;
};

/// A mesh of someone else, which gets dimensions by handles (core/features/handle.hpp).
struct HandledMeshSpec {
    std::shared_ptr<const geometry::Mesh> mesh;  ///< as read and mended [m]
    std::string source;                          ///< file, unit and whatever else decides what `mesh` and `targets` are
    std::string handles;                         ///< by name, as JSON; numbers count in `unit`
    std::map<std::string, std::shared_ptr<const geometry::Mesh>> targets = {};  ///< of handles that go towards another mesh, by name
    double unit = 1;                                                            ///< [m]
    double wall = 0;  ///< that must be left behind features that are changed [m]; 0: some
    bool operator==(const HandledMeshSpec& other) const {
        return source == other.source && handles == other.handles && unit == other.unit && wall == other.wall;
    }
};

/// A part that is made from dimensions, by its file, by a program or by handles of a mesh (design/shapes/); core makes none, see
/// read_options.hpp.
struct ShapeSpec {
    std::string part;                          ///< of the library, a file, or the text of one; empty: something else makes the part
    std::map<std::string, double> dimensions;  ///< lengths [m], but for those that are listed below
    std::map<std::string, int> counts;         ///< numbers of teeth, holes, facets
    std::optional<MeshProgram> program = {};
    double chord = 0;                      ///< of a part: largest distance of a facet from what it stands for [m]; 0: not by this
    std::vector<std::string> angles = {};  ///< dimensions of a part that are no lengths: angles [rad], plain numbers
    std::vector<std::string> numbers = {};
    std::optional<HandledMeshSpec> handled = {};
    bool operator==(const ShapeSpec&) const = default;
};

struct Body {
    std::string name;
    std::string where;  ///< file and JSON pointer, for messages
    BodyType type = BodyType::dynamic_body;
    geometry::Mesh mesh;             ///< vertices in the file's frame, scaled, [m]
    std::optional<ShapeSpec> shape;  ///< what `mesh` was made from, if it was made from dimensions
    MeshPolicy mesh_policy = MeshPolicy::strict;
    double density = 1000;      ///< per what `mass_kind` says
    bool density_given = true;  ///< false: the file names none, and `density` stands for nothing (a static or kinematic body)
    MassKind mass_kind = MassKind::volume;
    bool mass_kind_given = true;                 ///< false: the file has no word for it, and `mass_kind` is what the mesh suggests
    std::optional<Inertial> inertial;            ///< given, in place of density times what the mesh has
    std::string material;                        ///< for friction; empty: none named
    std::optional<double> mu;                    ///< its own friction coefficient
    kinematics::Pose pose;                       ///< of the file's frame at the start: world = rotation * x + position
    Orientation orientation;                     ///< that `pose` has its rotation from, as written
    Vector3 linear_velocity = Vector3::Zero();   ///< of the reference point (model/model.hpp) at the start [m/s]
    Vector3 angular_velocity = Vector3::Zero();  ///< world axes [rad/s]
    PrescribedMotion prescribed;                 ///< static: all held; kinematic: all prescribed; dynamic: fixed DOFs and motors
    PoseScript script;                           ///< kinematic only; then `prescribed` is what follows it
    Vector3 force = Vector3::Zero();             ///< constant, world, at the reference point [N]
    Vector3 torque = Vector3::Zero();            ///< constant, world [N m]
    Damping damping;                             ///< dynamic only
    std::optional<Vector3> reference_point;      ///< in the file's frame [m]; default see model/model.hpp
    int group = -1;                              ///< bodies of one group (>= 0) never collide
    /// A rotation vector, world axes, by which a design turns the body about its file frame's origin; `pose` has it already.
    Vector3 turn = Vector3::Zero();
};

/// A named number of a file. What follows from others has a formula of them; the rest is constant, and a design can move it by its name.
struct Variable {
    std::string name;
    expression::Formula formula = expression::constant_formula(0);  ///< over the variables that are constant
    double value = 0;                                               ///< SI
};

/// A number that follows from variables; in a scene it has their values already.
struct BoundNumber {
    std::string place;  ///< place.hpp
    expression::Formula formula = expression::constant_formula(0);
};

struct Scene {
    std::string path;        ///< of the file; empty when made in memory
    double length_unit = 1;  ///< of the file [m]; for reports only, everything here is SI
    std::vector<Body> bodies;
    Vector3 gravity = Vector3::Zero();  ///< [m/s^2]
    double timestep = 0.01;             ///< h [s]
    std::optional<double> end_time;     ///< [s]
    std::optional<double> dhat;         ///< activation distance [m]; default 1e-3 of moving_diagonal
    double dmin = 0;                    ///< minimum separation [m]
    std::optional<double> kappa;  ///< barrier stiffness [N/m]; default: choose_kappa's, varied from step to step (docs/method/contact.md)
    bool area_weighted = false;   ///< barrier per vertex and edge area: pressure does not depend on the mesh; kappa in [N/m^3]
    std::optional<bool> round_contact;  ///< do facets push like the smooth surface that they stand for? default: yes, wherever they can
                                        ///< (setup/round_contact.hpp)
    double contact_damping_time = 0;    ///< of contacts against kappa [s] (docs/method/contact.md); 0: none
    Friction friction;
    Mechanism mechanism;  ///< joints, springs, motors, loads at points
    Integrator integrator = Integrator::implicit_euler;
    std::optional<double> velocity_tolerance;  ///< Newton stops below this speed of any point [m/s]; default 1e-2 moving_diagonal / s
    int max_newton_iterations = 3000;
    std::vector<Variable> variables;
    std::vector<BoundNumber> numbers;  ///< that follow from variables, or from inputs that the reader was given; one for a place
    /// "a:b": pairs of bodies that pass through each other and are not judged; `*` stands for any letters ("finger*:palm").
    std::vector<std::string> ignore;
    std::vector<std::string> warnings;  ///< what a lenient reader accepted
};

/// Diagonal of the bounding box of everything at the start [m]; 0 for an empty scene.
double bounding_diagonal(const Scene& scene);

/// The same of the bodies that are not static; 0 if there are none.
double moving_diagonal(const Scene& scene);

}  // namespace fettle::core::scene
