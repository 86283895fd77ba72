// SPDX-License-Identifier: MIT
/// Joints, springs, motors and loads as the stepper works on them: measures, rows over them, terms of them. docs/method/joints.md.
/// Made by build_mechanism.hpp.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/constraint/branch.hpp"
#include "core/constraint/row.hpp"
#include "core/measure/measure.hpp"
#include "core/scene/mechanism.hpp"

namespace fettle::core::model {

/// What of a scene's mechanism something was made from: a place in one of its lists. Derivatives go back by it (adjoint/model).
struct Origin {
    enum class List { joint, spring, motor, load };
    List list = List::joint;
    int index = -1;
};

enum class LawKind {
    spring,   ///< 1/2 c (m - reference)^2
    damper,   ///< the force -c dm/dt
    force,    ///< -f(t) m, f the curve
    stop,     ///< a barrier against sign (m - reference) < 0, c in N/m
    friction  ///< Coulomb friction of the force c against dm/dt
};

/// A stop is closed: it does nothing up to its limit, resists beyond it, and gives way by less than this share of dhat.
inline constexpr double stop_give = 0.1;

/// An energy of one measure. Its value: energy/measure_terms.hpp.
struct MeasureTerm {
    LawKind kind = LawKind::spring;
    int measure = 0;
    double coefficient = 0;
    double reference = 0;
    double sign = 1;     ///< stop: 1 a lower one, -1 an upper one
    double length = 1;   ///< [m] that one unit of the measure is worth: 1 of lengths, a lever of angles
    scene::Curve curve;  ///< force
    std::string name;    ///< of the joint, spring or motor
    Origin origin;
};

struct Joint {
    std::string name;
    scene::JointKind kind = scene::JointKind::revolute;
    int a = measure::world, b = measure::world;  ///< bodies; of gears and racks the world
    int frame_a = -1, frame_b = -1;              ///< none of gears and racks
    int coordinate = -1;                         ///< measure; -1: the joint has none
    bool is_motor = false;                       ///< a row of a motor's: what `name` is
    Origin origin;
};

/// The start before bodies were put where their joints are met; empty where there are no joints.
struct WrittenStart {
    std::vector<kinematics::Pose> poses;
    /// (v, omega) per body, of prescribed coordinates what their curves say; none in quasi-statics, or without rows.
    std::vector<Vector6> velocities;
    std::vector<bool> is_velocity_changed;  ///< per body: did its velocity have to change?
};

struct Mechanism {
    measure::MeasureSet set;
    std::vector<Origin> ends;                ///< of frames 2 k, end a, and 2 k + 1, end b
    std::vector<constraint::Row> rows;       ///< independent at the start; Row::owner is a place in `joints`
    std::vector<constraint::Row> dependent;  ///< what follows from `rows` there: looked at after each step, not solved for (row_choice.hpp)
    std::vector<MeasureTerm> terms;
    std::vector<Joint> joints;                       ///< and the motors that drive coordinates
    std::vector<std::pair<int, int>> not_colliding;  ///< bodies that joints join, (a < b), sorted
    std::vector<constraint::Branch> branches;        ///< on which side loops are assembled; Branch::joint is a place in `joints`
    std::vector<double> angles_start;                ///< of the measures, at the start: the turns nearest to the start as written
    WrittenStart written;
    bool empty() const { return rows.empty() && terms.empty() && joints.empty(); }
};

}  // namespace fettle::core::model
