// SPDX-License-Identifier: MIT
/// What the stepper works on: bodies with mass, hierarchy and prescribed coordinates. Built once by setup/build_model.hpp, const ever
/// after.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/flat_features.hpp"
#include "core/geometry/mesh.hpp"
#include "core/geometry/round_surfaces.hpp"
#include "core/kinematics/path.hpp"
#include "core/linear/free_dofs.hpp"
#include "core/model/mechanism.hpp"
#include "core/scene/scene.hpp"

namespace fettle::core::model {

/// A body's frame is its mesh file's frame, shifted to the reference point c: X = x_file - c. c is the centre of mass of the
/// first design (volume, shell, wires or points, as its MassKind says; the middle of the box where there is no such mass) unless the scene
/// names one, and never follows a parameter; neither do the axes.
struct Body {
    std::string name;
    scene::BodyType type = scene::BodyType::dynamic_body;
    geometry::Mesh mesh;                        ///< vertices relative to c [m]
    Vector3 reference_point = Vector3::Zero();  ///< c in the file's frame [m]
    double density = 0;                         ///< per what `mass_kind` says
    scene::MassKind mass_kind = scene::MassKind::volume;
    bool mass_kind_given = true;                 ///< false: its scene does not say so, its mesh suggests it
    std::optional<double> given_mass;            ///< [kg], of a body whose mass and inertia are given: they follow from no mesh and density
    Matrix4 moments = Matrix4::Zero();           ///< M = integral of rho [X;1][X;1]^T [kg m^2, kg m, kg]; zero if not dynamic
    kinematics::Pose pose_start;                 ///< of the reference point's frame
    Matrix34 velocity_start = Matrix34::Zero();  ///< Pdot = [[omega] R, v]
    scene::PrescribedMotion prescribed;
    scene::PoseScript script;          ///< of c's frame
    Vector3 force = Vector3::Zero();   ///< at c [N]
    Vector3 torque = Vector3::Zero();  ///< [N m]
    scene::Damping damping;            ///< [1/s]
    int material = 0;                  ///< row of Model::friction.mu
    int group = -1;
    double radius = 0;                        ///< largest |X|
    std::vector<double> edge_length_squared;  ///< undeformed, per edge: the mollifier's eps
    std::vector<double> vertex_area;          ///< a third of each adjacent triangle's, per vertex [m^2]
    std::vector<double> edge_area;            ///< the same per edge
    std::shared_ptr<const geometry::BodyHierarchy> hierarchy;
    std::shared_ptr<const geometry::FlatFeatures> flat;
    std::shared_ptr<const geometry::RoundSurfaces> round;  ///< null: contact takes facets as they are
};

/// Does its scene say that it is a shell, wires or points? Then it has no inside, where its mesh is not closed. That a mesh is wide open
/// says nothing of what it is meant to be: a cup without its lid is.
inline bool is_sheet(const Body& body) { return body.mass_kind_given && body.mass_kind != scene::MassKind::volume; }

inline bool is_free(const Body& body, int dof) { return !body.prescribed[dof].has_value(); }

struct Friction {
    MatrixX mu = MatrixX::Zero(1, 1);  ///< coefficient by materials, symmetric
    double eps_v = 1e-3;               ///< [m/s]
    int rounds = 1;                    ///< per step; negative: until normal forces and tangents agree
};

/// Two sides, of bodies a < b, that meet each other with their facets although they are round.
struct FacetSides {
    int a = 0, side_a = 0, b = 0, side_b = 0;  ///< sides: into Body::round's
    auto operator<=>(const FacetSides&) const = default;
};

struct Model {
    std::vector<Body> bodies;
    Vector3 gravity = Vector3::Zero();  ///< [m/s^2]
    double timestep = 0.01;             ///< h [s]
    double end_time = -1;               ///< [s], negative: not given
    double dhat = 1e-3;                 ///< [m]
    double dmin = 0;                    ///< [m]
    double kappa = 0;                   ///< [N/m], or [N/m^3] if area_weighted
    bool adaptive_kappa = false;  ///< may a simulation start from a stiffer kappa and vary it (stepper/step.cpp)? never for a gradient
    bool area_weighted = false;
    double round_reach = 0;  ///< twice the largest distance of a round surface from its mesh; 0: contact takes facets as they are [m]
    std::vector<FacetSides> facet_sides;  ///< ascending (setup/round_contact.hpp)
    double contact_damping_time = 0;      ///< T of contact/contact_damping.hpp [s]; 0: none
    Friction friction;
    Mechanism mechanism;
    std::vector<std::pair<int, int>> ignored;  ///< bodies that the scene wants to pass through each other (a < b), sorted
    scene::Integrator integrator = scene::Integrator::implicit_euler;
    double proximal_weight = 0;     ///< h^2/eps of quasi-static steps [s^2] (choose_proximal_weight.hpp); 0: not quasi-static
    double velocity_tolerance = 0;  ///< [m/s]
    double solve_accuracy = 0;  ///< share of the forces on a body that a solve may leave unbalanced; 0: the tolerance is all that counts
    int max_newton_iterations = 3000;
    bool for_gradient = false;          ///< of a design: each simulation of it is the one that is differentiated, whoever asks for it
                                        ///< (stepper::SimulationOptions::for_gradient)
    double diagonal = 1;                ///< of the bounding box of everything at the start [m]
    double length_unit = 1;             ///< of the scene file [m], for reports
    std::vector<std::string> warnings;  ///< what build_model took with a doubt; for people, no part of a stored model
};

inline double friction_coefficient(const Model& model, int a, int b) {
    return model.friction.mu(model.bodies[a].material, model.bodies[b].material);
}

/// Where a kinematic body's script has c's frame at `time`: its start pose before, the last pose after (scene::scripted_pose).
kinematics::Pose scripted_pose(const Body& body, double time);

/// Why contact does not act between two bodies.
enum class NoContact {
    none,         ///< it does
    same_body,    ///< a body never meets itself
    ignored,      ///< the scene's `ignore`
    one_group,    ///< of bodies of one group (>= 0)
    joined,       ///< a joint joins the two, and does not say that they collide
    none_dynamic  ///< neither is dynamic: static and kinematic bodies never push each other. By type alone: a dynamic body all of whose
                  ///< coordinates are held or driven still meets static ones, and is stopped by them
};
NoContact why_no_contact(const Model& model, int a, int b);

inline bool may_collide(const Model& model, int a, int b) { return why_no_contact(model, a, b) == NoContact::none; }

/// What is solved for: all that no script prescribes.
linear::FreeDofs free_dofs(const Model& model);

}  // namespace fettle::core::model
