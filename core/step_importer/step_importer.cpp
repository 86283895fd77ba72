// SPDX-License-Identifier: MIT
// A program of its own, which the library carries (mesh_files/import_process.cpp): reads a STEP file by Open CASCADE and writes the meshes
// of its solids to stdout, as import_format.hpp says. It may crash, loop and run out of memory with whatever a file makes of Open CASCADE;
// its parent only sees that nothing came.
//
//     step_importer FILE SECONDS BYTES CHORD SURFACE_TOLERANCE      lengths in metres, 0: the usual one; none
#include <Standard_Failure.hxx>
#include <algorithm>
#include <cstring>
#include <new>

#include "core/mesh_files/import_program.hpp"
#include "core/mesh_files/most_placed.hpp"
#include "core/step_importer/body_mesh.hpp"
#include "core/step_importer/gate.hpp"
#include "core/step_importer/occt_shapes.hpp"
#include "core/step_importer/read_step.hpp"

namespace fettle::core::step_importer {
namespace {

using mesh_files::ImportBody;
using mesh_files::ImportHeader;
using mesh_files::ImportPipe;

constexpr double metre = 1e-3;  // of a millimetre

struct TooMuch {};

struct Placed {
    std::vector<double> coordinates;
    std::vector<std::int32_t> corners, polygon_ends, polygon_names, polygon_faces;
    std::vector<std::string> names, face_names;
    std::vector<ImportBody> bodies;
    std::uint64_t placed = 0;  // see most_placed
};

double scale_of(const gp_Trsf& place) { return std::abs(place.ScaleFactor()); }

void place(const BodyMesh& mesh, const PlacedSolid& solid, Placed& to) {
    to.placed += mesh_files::of_a_placing + mesh.places.size() + mesh.triangles.size();
    if (to.placed > mesh_files::most_placed) throw TooMuch();
    const std::size_t first = to.coordinates.size() / 3, first_face = to.face_names.size();
    const double scale = scale_of(solid.place);
    // What placing loses to rounding: of where the solid is put, far below this.
    const double shift = 0x1p-46 * (scale * mesh.largest + vector_of(solid.place.TranslationPart()).norm());
    to.bodies.push_back({first, to.polygon_ends.size(), metre * (scale * mesh.out + shift), metre * (scale * mesh.in + shift),
                         metre * scale * mesh.declared, mesh.is_proven ? 1u : 0u, solid.colour});
    for (const Vector3d& from : mesh.places) {
        gp_XYZ at(from[0], from[1], from[2]);
        solid.place.Transforms(at);
        for (int k = 1; k <= 3; ++k) to.coordinates.push_back(metre * at.Coord(k));
    }
    const bool mirrored = solid.place.VectorialPart().Determinant() < 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        for (const int corner : {a, mirrored ? c : b, mirrored ? b : c}) to.corners.push_back(static_cast<std::int32_t>(first + corner));
        to.polygon_ends.push_back(static_cast<std::int32_t>(to.corners.size()));
        to.polygon_names.push_back(static_cast<std::int32_t>(to.names.size()));
        to.polygon_faces.push_back(static_cast<std::int32_t>(first_face + mesh.triangle_face[t]));
    }
    to.names.push_back(solid.name);
    to.face_names.insert(to.face_names.end(), mesh.face_names.begin(), mesh.face_names.end());
}

int write(const Placed& mesh, const ImportPipe& pipe) {
    ImportHeader header;
    header.mark = mesh_files::import_is_mesh;
    header.vertices = mesh.coordinates.size() / 3;
    header.corners = mesh.corners.size();
    header.polygons = mesh.polygon_ends.size();
    header.names = mesh.names.size();
    header.bodies = mesh.bodies.size();
    header.faces = mesh.face_names.size();
    const bool good = pipe.write(&header, sizeof header) && pipe.write_list(mesh.coordinates) && pipe.write_list(mesh.corners) &&
                      pipe.write_list(mesh.polygon_ends) && pipe.write_list(mesh.polygon_names) && pipe.write_texts(mesh.names) &&
                      pipe.write_list(mesh.bodies) && pipe.write_list(mesh.polygon_faces) && pipe.write_texts(mesh.face_names) &&
                      pipe.write_end();
    return good ? mesh_files::import_written : mesh_files::import_failed;
}

BodyMesh checked_mesh(const StepContents& contents, std::size_t shape, const MeshWishes& wishes, const EntityOf& entity) {
    try {
        BodyMesh mesh = mesh_of(contents.shapes[shape], wishes, entity);
        check_against_solid(contents.shapes[shape], mesh);
        return mesh;
    } catch (Fault& fault) {
        const auto named = std::find_if(contents.solids.begin(), contents.solids.end(),
                                        [&](const PlacedSolid& solid) { return solid.shape == static_cast<int>(shape); });
        throw Fault{"solid `" + named->name + "`" + in_file(entity(contents.shapes[shape])) + ": " + fault.text};
    } catch (const Standard_Failure& failure) {
        throw Fault{"a solid" + in_file(entity(contents.shapes[shape])) + ": Open CASCADE says " + failure.DynamicType()->Name()};
    }
}

int import(char** arguments, const ImportPipe& pipe) {
    try {
        const MeshWishes wishes{std::atof(arguments[4]) / metre, std::atof(arguments[5]) / metre};
        Placed placed;
        read_step(arguments[1], [&](const StepContents& contents, const EntityOf& entity) {
            std::vector<BodyMesh> meshes;
            for (std::size_t i = 0; i < contents.shapes.size(); ++i) meshes.push_back(checked_mesh(contents, i, wishes, entity));
            for (const PlacedSolid& solid : contents.solids) place(meshes[solid.shape], solid, placed);
            // And no more: what Open CASCADE holds goes with the process.
            ::_exit(write(placed, pipe));
        });
        return mesh_files::import_failed;
    } catch (const Fault& fault) {
        return pipe.write_failure(fault.text, mesh_files::import_failed);
    } catch (const TooMuch&) {
        return pipe.write_failure("", mesh_files::import_too_large);
    } catch (const std::bad_alloc&) {
        return pipe.write_failure("", mesh_files::import_out_of_memory);
    } catch (const Standard_Failure& failure) {
        const bool is_memory = std::strcmp(failure.DynamicType()->Name(), "Standard_OutOfMemory") == 0;
        return pipe.write_failure(std::string("Open CASCADE says ") + failure.DynamicType()->Name(),
                                  is_memory ? mesh_files::import_out_of_memory : mesh_files::import_failed);
    } catch (const std::exception& failure) {
        return pipe.write_failure(std::string("Open CASCADE says ") + failure.what(), mesh_files::import_failed);
    }
}

}  // namespace
}  // namespace fettle::core::step_importer

int main(int count, char** arguments) {
    using namespace fettle::core;
    if (count != 6) return mesh_files::import_misused;
    mesh_files::take_limits(arguments);
    // Open CASCADE prints to stdout.
    const mesh_files::ImportPipe pipe(::dup(STDOUT_FILENO));
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    ::_exit(step_importer::import(arguments, pipe));
}
