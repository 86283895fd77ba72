// SPDX-License-Identifier: MIT
/// The members of what a simulation and a certification of clearance answer, for records.hpp.
#pragma once

#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/joint_ranges.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/stepper/simulation.hpp"
#include "design/python/records.hpp"

FETTLE_WORDS(fettle::core::stepper::SimulationStatus, "ok", "blocked", "not_held", "not_converged", "energy_gained", "interrupted")
FETTLE_WORDS(fettle::core::clearance::PairStatus, "clear", "violated", "undecided", "contact")
FETTLE_WORDS(fettle::core::certificate::Solids, "unproven", "disjoint", "overlap", "not closed", "not verified")
FETTLE_WORDS(fettle::core::certificate::Primitive, "vertex", "edge", "triangle")

FETTLE_RECORD(fettle::core::stepper::StepReport, "StepReport", field("newton_iterations", &Type::newton_iterations),
              field("friction_rounds", &Type::friction_rounds), field("contacts", &Type::contacts),
              field("minimum_distance", &Type::minimum_distance), field("residual", &Type::residual), field("joint_gap", &Type::joint_gap),
              field("path_joint_gap", &Type::path_joint_gap))
FETTLE_RECORD(fettle::core::stepper::SimulationReport, "SimulationReport", field("status", &Type::status), field("message", &Type::message),
              field("steps", &Type::steps), field("newton_iterations", &Type::newton_iterations),
              field("wall_seconds", &Type::wall_seconds))
FETTLE_RECORD(fettle::core::energy::ContactForce, "ContactForce", field("a", &Type::a), field("b", &Type::b), field("force", &Type::force),
              field("torque", &Type::torque), field("normal", &Type::normal), field("friction", &Type::friction),
              field("distance", &Type::distance), field("contacts", &Type::contacts))
FETTLE_RECORD(fettle::core::stepper::DriveForce, "DriveForce", field("body", &Type::body), field("force", &Type::force),
              field("torque", &Type::torque))
FETTLE_RECORD(fettle::core::stepper::JointForce, "JointForce", field("joint", &Type::joint), field("force", &Type::force),
              field("torque", &Type::torque), field("effort", &Type::effort), field("spring", &Type::spring),
              field("damping", &Type::damping), field("friction", &Type::friction), field("stop", &Type::stop))
FETTLE_RECORD(fettle::core::stepper::StepOutputs, "StepOutputs", field("time", &Type::time), field("kappa", &Type::kappa),
              field("kinetic_energy", &Type::kinetic_energy), field("potential_energy", &Type::potential_energy),
              field("contact_energy", &Type::contact_energy), field("spring_energy", &Type::spring_energy),
              field("supplied_power", &Type::supplied_power), field("dissipated_power", &Type::dissipated_power),
              field("linear_momentum", &Type::linear_momentum), field("angular_momentum", &Type::angular_momentum),
              field("contacts", &Type::contacts), field("drives", &Type::drives), field("joints", &Type::joints))
FETTLE_RECORD(fettle::core::stepper::Simulation, "Simulation", field("trajectory", &Type::trajectory), field("report", &Type::report),
              field("outputs", &Type::outputs))

FETTLE_RECORD(fettle::core::clearance::PairRequest, "PairRequest", field("a", &Type::a), field("b", &Type::b),
              field("minimum", &Type::minimum), field("far", &Type::far), field("may_touch", &Type::may_touch),
              field("touch_depth", &Type::touch_depth))
FETTLE_RECORD(fettle::core::clearance::Witness, "Witness", field("step", &Type::step), field("segment", &Type::segment),
              field("s", &Type::s), field("time", &Type::time), field("kind_a", &Type::kind_a), field("kind_b", &Type::kind_b),
              field("primitive_a", &Type::primitive_a), field("primitive_b", &Type::primitive_b), field("edge_edge", &Type::edge_edge),
              field("vertex_on_a", &Type::vertex_on_a), field("point_a", &Type::point_a), field("point_b", &Type::point_b),
              field("distance", &Type::distance))
FETTLE_RECORD(fettle::core::clearance::MarginInterval, "MarginInterval", field("step", &Type::step), field("segment", &Type::segment),
              field("time_start", &Type::time_start), field("time_end", &Type::time_end), field("lower", &Type::lower),
              field("upper", &Type::upper))
FETTLE_RECORD(fettle::core::clearance::Overlap, "Overlap", field("depth_lower", &Type::depth_lower),
              field("depth_upper", &Type::depth_upper), field("volume_lower", &Type::volume_lower),
              field("volume_upper", &Type::volume_upper), field("time", &Type::time), field("center", &Type::center))
FETTLE_RECORD(fettle::core::clearance::Touch, "Touch", field("area", &Type::area), field("time", &Type::time), field("depth", &Type::depth),
              field("room", &Type::room), field("is_whole", &Type::is_whole))
FETTLE_RECORD(fettle::core::clearance::PairClearance, "PairClearance", field("a", &Type::a), field("b", &Type::b),
              field("minimum", &Type::minimum), field("lower", &Type::lower), field("upper", &Type::upper),
              field("is_bounded", &Type::is_bounded), field("is_far", &Type::is_far), field("status", &Type::status),
              field("witness", &Type::witness), field("complete", &Type::complete), field("intersecting", &Type::intersecting),
              field("solids", &Type::solids), field("overlap", &Type::overlap), field("touch", &Type::touch),
              field("clash_not_before", &Type::clash_not_before), field("clash_time", &Type::clash_time), field("reason", &Type::reason),
              field("sampled", &Type::sampled), field("margin", &Type::margin), field("witnesses", &Type::witnesses),
              field("tolerance", &Type::tolerance), field("coordinates", &Type::coordinates), field("at", &Type::at),
              field("bounds", &Type::bounds))
FETTLE_RECORD(fettle::core::certificate::JointCoordinate, "JointCoordinate", field("joint", &Type::joint),
              field("is_angle", &Type::is_angle), field("scale", &Type::scale), field("offset", &Type::offset))
FETTLE_RECORD(fettle::core::certificate::LinkageCoordinate, "RangeCoordinate", field("start", &Type::start), field("low", &Type::low),
              field("high", &Type::high), field("is_whole_turn", &Type::is_whole_turn), field("joints", &Type::joints))
FETTLE_RECORD(fettle::core::certificate::CertificateFault, "CertificateFault", field("where", &Type::where),
              field("message", &Type::message))
FETTLE_RECORD(fettle::core::certificate::CertificateReport, "CertificateReport", field("faults", &Type::faults),
              field("stale", &Type::stale), field("leaves", &Type::leaves), field("pieces", &Type::pieces))
