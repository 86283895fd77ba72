// SPDX-License-Identifier: MIT
/// Designs: parameters, quantities and requirements, their gradients, their optimisation, in the order in which one meets them.
#pragma once

// A design as data, and what one derives from for shapes and quantities of one's own.
#include "design/description/design.hpp"
#include "design/description/quantity.hpp"
#include "design/description/shape.hpp"
// Parts by their files: those of the library, by name, and one's own.
#include "design/shapes/file_part.hpp"
#include "design/shapes/part_library.hpp"
// Read from its file; scenes with such parts.
#include "design/reading/design_reader.hpp"
#include "design/reading/scene_shapes.hpp"
// The quantities that are there.
#include "design/quantities/clearance.hpp"
#include "design/quantities/contact_force.hpp"
#include "design/quantities/energy.hpp"
#include "design/quantities/expression.hpp"
#include "design/quantities/joint_load.hpp"
#include "design/quantities/marker_path.hpp"
#include "design/quantities/marker_speed.hpp"
#include "design/quantities/mass.hpp"
#include "design/quantities/stroke.hpp"
// Values and gradients of it; optimised; gradients compared with differences.
#include "design/problem/design_problem.hpp"
#include "design/gradient_audit/difference_check.hpp"
#include "design/studies/optimise_design.hpp"
#include "design/studies/optimise_file.hpp"
#include "design/studies/tolerance_study.hpp"
// What `fettle clearance` asks: which pairs count, groups, findings.
#include "design/clearance/read_subject.hpp"
#include "design/clearance/report.hpp"
// Other programs' files.
#include "design/exports/export_files.hpp"
#include "design/urdf/urdf_scene.hpp"
#include "design/urdf/urdf_writer.hpp"
#include "fettle/adjoint.hpp"
