// SPDX-License-Identifier: MIT
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>

#include "core/parts/triangulation.hpp"
#include "core/step_importer/occt_shapes.hpp"
#include "core/step_importer/solid_mesh.hpp"

namespace fettle::core::step_importer {
namespace {

Vector3d place_of(const Poly_Triangulation& triangulation, int node, const TopLoc_Location& location) {
    return vector_of(triangulation.Node(node + 1).Transformed(location.Transformation()).XYZ());
}

/// What of Open CASCADE's mesh is one node: nodes of faces that stand at one vertex, or at one place of an edge.
class Joined {
public:
    Joined(const TopoDS_Shape& solid, const std::set<int>& own, const EntityOf& entity) : own_(own), entity_(entity) {
        TopExp::MapShapes(solid, TopAbs_EDGE, edges_);
        TopExp::MapShapes(solid, TopAbs_VERTEX, vertices_);
        at_vertex_.assign(static_cast<std::size_t>(vertices_.Extent()) + 1, -1);
        mesh_.lines.resize(static_cast<std::size_t>(edges_.Extent()));
        int number = 0;
        for (TopExp_Explorer faces(solid, TopAbs_FACE); faces.More(); faces.Next()) add_face(TopoDS::Face(faces.Current()), ++number);
        for (const int face : left_out_) mesh_face(mesh_.faces[static_cast<std::size_t>(face)], face);
    }
    SolidMesh take() && { return std::move(mesh_); }

private:
    void add_face(const TopoDS_Face& shape, int number) {
        TopLoc_Location location;
        const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(shape, location);
        FaceMesh face;
        face.face = shape;
        face.number = number;
        face.adaptor.Initialize(shape);
        face.shape = shape_of(face.adaptor);
        face.is_reversed = shape.Orientation() == TopAbs_REVERSED;
        if (triangulation.IsNull() || triangulation->NbTriangles() == 0 || own_.count(number) != 0) {
            left_out_.push_back(static_cast<int>(mesh_.faces.size()));
            mesh_.faces.push_back(face);
            return;
        }
        if (!triangulation->HasUVNodes()) throw Fault{told_face(face, entity_) + " has triangles without parameters"};
        for (int i = 0; i < triangulation->NbNodes(); ++i) {
            const gp_Pnt2d uv = triangulation->UVNode(i + 1);
            face.uv.emplace_back(uv.X(), uv.Y());
        }
        face.node.assign(face.uv.size(), -1);
        for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
            int a = 0, b = 0, c = 0;
            triangulation->Triangle(i).Get(a, b, c);
            face.triangles.push_back({a - 1, b - 1, c - 1});
        }
        mesh_.faces.push_back(face);
        // Where a face is turned its edges are turned, too, and the two sides of a seam change places: not here.
        for (TopExp_Explorer edges(shape.Oriented(TopAbs_FORWARD), TopAbs_EDGE); edges.More(); edges.Next())
            add_use(TopoDS::Edge(edges.Current()), *triangulation, triangulation, location);
        FaceMesh& last = mesh_.faces.back();
        for (std::size_t i = 0; i < last.node.size(); ++i)
            if (last.node[i] < 0) last.node[i] = add_place(place_of(*triangulation, static_cast<int>(i), location));
    }

    void add_use(const TopoDS_Edge& edge, const Poly_Triangulation& nodes, const Handle(Poly_Triangulation) & triangulation,
                 const TopLoc_Location& location) {
        FaceMesh& face = mesh_.faces.back();
        const Handle(Poly_PolygonOnTriangulation) polygon = BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
        if (polygon.IsNull() || !polygon->HasParameters())
            throw Fault{told_face(face, entity_) + " has an edge" + in_file(entity_(edge)) + " that Open CASCADE leaves without nodes",
                        true};
        EdgeLine& line = mesh_.lines[static_cast<std::size_t>(edges_.FindIndex(edge)) - 1];
        EdgeLine::Use use = use_of(edge, face, static_cast<int>(mesh_.faces.size()) - 1);
        use.nodes = nodes_along(edge, use, *polygon, triangulation, location, face);
        if (line.uses.empty())
            begin_line(edge, line, [&] {
                for (int i = 1; i <= polygon->NbNodes(); ++i) line.parameters.push_back(polygon->Parameters()->Value(i));
                return [&](std::size_t k) { return place_of(nodes, use.nodes[k], location); };
            });
        if (line.nodes.size() != use.nodes.size())
            throw Fault{told_face(face, entity_) + " and its neighbour have other nodes on their edge" + in_file(entity_(edge))};
        for (std::size_t k = 0; k < use.nodes.size(); ++k) face.node[static_cast<std::size_t>(use.nodes[k])] = line.nodes[k];
        line.uses.push_back(std::move(use));
    }

    /// The face's nodes along an edge; of a seam, whose two sides the mesher and the edge may tell apart otherwise, those that are on the
    /// edge's own curve in (u, v).
    static std::vector<int> nodes_along(const TopoDS_Edge& edge, const EdgeLine::Use& use, const Poly_PolygonOnTriangulation& polygon,
                                        const Handle(Poly_Triangulation) & triangulation, const TopLoc_Location& location,
                                        const FaceMesh& face) {
        const auto nodes_of = [](const Poly_PolygonOnTriangulation& of) {
            std::vector<int> nodes;
            for (int i = 1; i <= of.NbNodes(); ++i) nodes.push_back(of.Nodes()(i) - 1);
            return nodes;
        };
        const auto distance = [&](const std::vector<int>& nodes) {
            double sum = 0;
            for (std::size_t k = 0; k < nodes.size(); ++k) {
                const gp_Pnt2d uv = use.curve.Value(polygon.Parameters()->Value(static_cast<int>(k) + 1));
                sum += (Vector2d(uv.X(), uv.Y()) - face.uv[static_cast<std::size_t>(nodes[k])]).norm();
            }
            return sum;
        };
        std::vector<int> nodes = nodes_of(polygon);
        const Handle(Poly_PolygonOnTriangulation) other =
            BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(edge.Reversed()), triangulation, location);
        if (other.IsNull() || other->NbNodes() != polygon.NbNodes()) return nodes;
        std::vector<int> others = nodes_of(*other);
        return distance(others) < distance(nodes) ? others : nodes;
    }

    /// A face that Open CASCADE leaves out: its edges' nodes, joined by a constrained Delaunay triangulation in (u, v).
    void mesh_face(FaceMesh& face, int index) {
        const TopoDS_Face forward = TopoDS::Face(face.face.Oriented(TopAbs_FORWARD));
        parts::PlaneRegion region;
        std::size_t used = 0, of_face = 0;
        for (TopExp_Explorer edges(forward, TopAbs_EDGE); edges.More(); edges.Next()) ++of_face;
        for (TopExp_Explorer wires(forward, TopAbs_WIRE); wires.More(); wires.Next()) {
            std::vector<int> loop;
            for (BRepTools_WireExplorer edges(TopoDS::Wire(wires.Current()), forward); edges.More(); edges.Next(), ++used)
                add_to_loop(edges.Current(), face, index, loop);
            if (loop.size() < 2) continue;
            // Its end is its beginning.
            EdgeLine::Use& last = mesh_.lines[last_line_].uses.back();
            std::replace(last.nodes.begin(), last.nodes.end(), loop.back(), loop.front());
            loop.pop_back();
            face.uv.pop_back();
            face.node.pop_back();
            region.loops.push_back(std::move(loop));
        }
        // Lengths in space for those of parameters, so that triangles are well shaped.
        gp_Pnt place;
        gp_Vec u, v;
        face.adaptor.D1((face.uv.front()[0] + face.uv.back()[0]) / 2, (face.uv.front()[1] + face.uv.back()[1]) / 2, place, u, v);
        const Vector2d scale(std::max(u.Magnitude(), 1e-9), std::max(v.Magnitude(), 1e-9));
        for (const Vector2d& uv : face.uv) region.points.push_back(uv.cwiseProduct(scale));
        if (used == of_face && !region.loops.empty()) face.triangles = parts::triangulated(region).triangles;
        if (face.triangles.empty())
            throw Fault{
                told_face(face, entity_) + " is left without triangles by Open CASCADE, and its edges bound no region of the surface",
                face.number};
    }

    void add_to_loop(const TopoDS_Edge& edge, FaceMesh& face, int index, std::vector<int>& loop) {
        last_line_ = static_cast<std::size_t>(edges_.FindIndex(edge)) - 1;
        EdgeLine& line = mesh_.lines[last_line_];
        if (line.uses.empty()) begin_line(edge, line);
        EdgeLine::Use use = use_of(edge, face, index);
        const int count = static_cast<int>(line.parameters.size());
        const bool is_forward = edge.Orientation() != TopAbs_REVERSED;
        use.nodes.resize(static_cast<std::size_t>(count));
        for (int i = 0; i < count; ++i) {
            const std::size_t k = static_cast<std::size_t>(is_forward ? i : count - 1 - i);
            if (i > 0 || loop.empty()) {
                const gp_Pnt2d uv = use.curve.Value(line.parameters[k]);
                face.uv.emplace_back(uv.X(), uv.Y());
                face.node.push_back(line.nodes[k]);
                loop.push_back(static_cast<int>(face.uv.size()) - 1);
            }
            use.nodes[k] = loop.back();
        }
        line.uses.push_back(std::move(use));
    }

    EdgeLine::Use use_of(const TopoDS_Edge& edge, const FaceMesh& face, int index) const {
        EdgeLine::Use use;
        use.face = index;
        use.curve.Initialize(edge, TopoDS::Face(face.face.Oriented(TopAbs_FORWARD)));
        use.shapes = shapes_of(use.curve);
        return use;
    }

    /// An edge that no meshed face has: its ends, and what makes a turn of it more than a line there and back.
    void begin_line(const TopoDS_Edge& edge, EdgeLine& line) {
        constexpr int pieces = 4;
        begin_line(edge, line, [&] {
            double from = 0, to = 0;
            BRep_Tool::Range(edge, from, to);
            const int count = line.is_degenerate || line.shape.kind == CurveShape::Kind::line ? 1 : pieces;
            for (int k = 0; k <= count; ++k) line.parameters.push_back(k == count ? to : from + (to - from) * k / count);
            const auto place = [&](std::size_t k) {
                return line.is_degenerate ? vector_of(BRep_Tool::Pnt(TopExp::FirstVertex(edge)).XYZ())
                                          : vector_of(line.curve.Value(line.parameters[k]).XYZ());
            };
            return place;
        });
    }

    /// @param parameters  sets the line's, and returns the places at them
    template <class Parameters>
    void begin_line(const TopoDS_Edge& edge, EdgeLine& line, const Parameters& parameters) {
        line.is_degenerate = BRep_Tool::Degenerated(edge);
        line.tolerance = BRep_Tool::Tolerance(edge);
        if (!line.is_degenerate) {
            line.curve.Initialize(edge);
            line.shape = shape_of(line.curve);
        }
        const auto place = parameters();
        const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
        const std::size_t last = line.parameters.size() - 1;
        line.nodes.push_back(at_vertex(TopExp::FirstVertex(forward), place(0)));
        for (std::size_t k = 1; k < last; ++k) line.nodes.push_back(line.is_degenerate ? line.nodes[0] : add_place(place(k)));
        line.nodes.push_back(at_vertex(TopExp::LastVertex(forward), place(last)));
    }

    int at_vertex(const TopoDS_Vertex& vertex, const Vector3d& place) {
        if (vertex.IsNull()) return add_place(place);
        int& node = at_vertex_[static_cast<std::size_t>(vertices_.FindIndex(vertex))];
        if (node < 0) node = add_place(place);
        return node;
    }
    int add_place(const Vector3d& place) {
        mesh_.places.push_back(place);
        return static_cast<int>(mesh_.places.size()) - 1;
    }

    const std::set<int>& own_;
    const EntityOf& entity_;
    TopTools_IndexedMapOfShape edges_, vertices_;
    std::vector<int> at_vertex_, left_out_;
    std::size_t last_line_ = 0;
    SolidMesh mesh_;
};

/// Its triangles lie side by side in (u, v), or about the axis: all are seen from one side.
void check_folds(const SolidMesh& mesh, FaceMesh& face, const EntityOf& entity) {
    constexpr double rounding = 1e-9;
    int positive = 0, negative = 0;
    for (const auto& t : face.triangles) {
        const auto c = mesh.corners(face, t);
        const Vector3d e = c[1].place - c[0].place, f = c[2].place - c[0].place, normal = e.cross(f);
        const double size = std::max({e.squaredNorm(), f.squaredNorm(), (f - e).squaredNorm()});
        if (normal.norm() <= rounding * size) continue;
        double least = 0, most = 0;
        if (face.shape.is_radial()) {
            for (const Corner& corner : c) {
                const double seen = normal.dot(ray_at(face.shape, corner.place));
                least = std::min(least, seen), most = std::max(most, seen);
            }
        } else if (face.shape.kind == SurfaceShape::Kind::plane) {
            const double seen = normal.dot(face.shape.axis);
            least = std::min(least, seen), most = std::max(most, seen);
        } else {
            const Vector2d a = c[1].uv - c[0].uv, b = c[2].uv - c[0].uv;
            const double seen = a[0] * b[1] - a[1] * b[0];
            least = std::min(least, seen), most = std::max(most, seen);
            if (std::abs(seen) <= rounding * std::abs(a[0] * b[1]) + rounding * std::abs(a[1] * b[0])) continue;
        }
        positive += most > rounding * size ? 1 : 0;
        negative += least < -rounding * size ? 1 : 0;
    }
    if (positive > 0 && negative > 0) throw Fault{told_face(face, entity) + " has triangles that are folded over each other", face.number};
    // As the solid has it, normals of a face that is turned are turned.
    face.faces_out = (positive > 0) != face.is_reversed;
    face.faces_in = !face.faces_out;
}

}  // namespace

std::string in_file(const std::string& entity) { return entity.empty() ? "" : " (" + entity + ")"; }

std::string told_face(const FaceMesh& face, const EntityOf& entity) {
    const std::string number = entity(face.face);
    return "face " + std::to_string(face.number) + (number.empty() ? ", a " : " (" + number + "), a ") + name_of(face.shape.kind) + ",";
}

SolidMesh joined_mesh(const TopoDS_Shape& solid, const std::set<int>& own, const EntityOf& entity) {
    return Joined(solid, own, entity).take();
}

void check_folds(SolidMesh& mesh, const EntityOf& entity) {
    for (FaceMesh& face : mesh.faces) check_folds(mesh, face, entity);
}

}  // namespace fettle::core::step_importer
