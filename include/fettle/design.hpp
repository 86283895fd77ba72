// SPDX-License-Identifier: MIT
/// Designs: parameters, quantities and requirements, their gradients, their optimisation, in the order in which one meets them.
#pragma once

// A design as data, and what one derives from for shapes and quantities of one's own.
#include "fettle/design/description/design.hpp"
#include "fettle/design/description/quantity.hpp"
#include "fettle/design/description/shape.hpp"
// Parts by their files: those of the library, by name, and one's own.
#include "fettle/design/shapes/file_part.hpp"
#include "fettle/design/shapes/part_library.hpp"
// Read from its file; scenes with such parts.
#include "fettle/design/reading/design_reader.hpp"
#include "fettle/design/reading/scene_shapes.hpp"
// The quantities that are there.
#include "fettle/design/quantities/clearance.hpp"
#include "fettle/design/quantities/contact_force.hpp"
#include "fettle/design/quantities/energy.hpp"
#include "fettle/design/quantities/expression.hpp"
#include "fettle/design/quantities/joint_load.hpp"
#include "fettle/design/quantities/marker_path.hpp"
#include "fettle/design/quantities/marker_speed.hpp"
#include "fettle/design/quantities/mass.hpp"
#include "fettle/design/quantities/stroke.hpp"
// Values and gradients of it; optimised; gradients compared with differences.
#include "fettle/design/problem/design_problem.hpp"
#include "fettle/design/gradient_audit/difference_check.hpp"
#include "fettle/design/studies/optimise_design.hpp"
#include "fettle/design/studies/optimise_file.hpp"
// What `fettle clearance` asks: which pairs count, groups, findings.
#include "fettle/design/clearance/read_subject.hpp"
#include "fettle/design/clearance/report.hpp"
// Other programs' files.
#include "fettle/design/exports/export_files.hpp"
#include "fettle/design/urdf/urdf_scene.hpp"
#include "fettle/design/urdf/urdf_writer.hpp"
#include "fettle/adjoint.hpp"
