// SPDX-License-Identifier: MIT
#include "tests/support/solid_oracle.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

namespace fettle::tests::support {

std::string fault_of_solid(const core::geometry::Mesh& mesh) {
    namespace processing = CGAL::Polygon_mesh_processing;
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
    Surface surface;
    for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v)
        surface.add_vertex({mesh.vertices(0, v), mesh.vertices(1, v), mesh.vertices(2, v)});
    for (const auto& t : mesh.triangles) {
        const auto vertex = [&](std::size_t k) { return Surface::Vertex_index(static_cast<Surface::size_type>(t[k])); };
        if (surface.add_face(vertex(0), vertex(1), vertex(2)) == Surface::null_face()) return "is no surface";
    }
    if (!CGAL::is_closed(surface)) return "is open";
    if (processing::does_self_intersect(surface)) return "crosses itself";
    if (!processing::does_bound_a_volume(surface)) return "is inside out somewhere";
    return {};
}

}  // namespace fettle::tests::support
