// SPDX-License-Identifier: MIT
// Made with Open CASCADE: STEP files for tests, and places on the exact faces of any STEP file.
//
//     step_samples write FOLDER             box.step, cylinder.step, ... (below)
//     step_samples points FILE COUNT OUT    COUNT places on the faces of all solids, as many of each face as its area has; three doubles
//     each [m]
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_GTransform.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <GProp_GProps.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace {

gp_Ax2 along_x(double x, double y, double z) { return {gp_Pnt(x, y, z), gp_Dir(1, 0, 0)}; }

TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& by) { return BRepBuilderAPI_Transform(shape, by, true).Shape(); }

TopoDS_Shape cylinder(double radius, double height) { return BRepPrimAPI_MakeCylinder(radius, height).Shape(); }

TopoDS_Shape bored_box(double radius) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-10, -10, 0), gp_Pnt(10, 10, 10)).Shape();
    return BRepAlgoAPI_Cut(box, cylinder(radius, 10)).Shape();
}

/// Cut across by a plane that is tilted: its edge is an ellipse.
TopoDS_Shape cut_cylinder() {
    const gp_Dir normal(0.5, 0.3, 1), x(1, 0, -0.5), y = normal.Crossed(x);
    const gp_Pnt corner = gp_Pnt(0, 0, 12).Translated(-30 * (gp_Vec(x) + gp_Vec(y)));
    const TopoDS_Shape block = BRepPrimAPI_MakeBox(gp_Ax2(corner, normal, x), 60, 60, 30).Shape();
    return BRepAlgoAPI_Cut(cylinder(5, 20), block).Shape();
}

/// Two bores that cross: their edge is no circle and no ellipse.
TopoDS_Shape crossed_bores() {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-10, -10, -10), gp_Pnt(10, 10, 10)).Shape();
    const TopoDS_Shape once = BRepAlgoAPI_Cut(box, moved(cylinder(4, 40),
                                                         [] {
                                                             gp_Trsf shift;
                                                             shift.SetTranslation(gp_Vec(0, 0, -20));
                                                             return shift;
                                                         }()))
                                  .Shape();
    return BRepAlgoAPI_Cut(once, BRepPrimAPI_MakeCylinder(along_x(-20, 1, 0), 3, 40).Shape()).Shape();
}

TopoDS_Shape rounded_box() {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(30, 20, 10).Shape();
    BRepFilletAPI_MakeFillet fillet(box);
    for (TopExp_Explorer edges(box, TopAbs_EDGE); edges.More(); edges.Next()) fillet.Add(2, TopoDS::Edge(edges.Current()));
    return fillet.Shape();
}

Handle(Geom_BSplineCurve) wave(double x, double y, double z) {
    TColgp_Array1OfPnt points(1, 9);
    for (int i = 0; i < 9; ++i) points(i + 1) = gp_Pnt(x + 2 * i, y + 1.5 * std::sin(0.9 * i), z);
    return GeomAPI_PointsToBSpline(points).Curve();
}

/// Under a wave: closed by straight edges.
TopoDS_Face wave_face() {
    const Handle(Geom_BSplineCurve) curve = wave(0, 6, 0);
    const gp_Pnt first = curve->StartPoint(), last = curve->EndPoint(), a(0, 0, 0), b(16, 0, 0);
    BRepBuilderAPI_MakeWire wire;
    wire.Add(BRepBuilderAPI_MakeEdge(a, b).Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(b, last).Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(curve).Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(first, a).Edge());
    return BRepBuilderAPI_MakeFace(wire.Wire()).Face();
}

TopoDS_Shape extruded_wave() { return BRepPrimAPI_MakePrism(wave_face(), gp_Vec(0, 0, 7)).Shape(); }
TopoDS_Shape turned_wave() { return BRepPrimAPI_MakeRevol(wave_face(), gp_Ax1(gp_Pnt(0, -4, 0), gp_Dir(1, 0, 0))).Shape(); }

TopoDS_Shape ellipsoid() {
    gp_GTrsf stretch;
    stretch.SetValue(1, 1, 1.0), stretch.SetValue(2, 2, 1.6), stretch.SetValue(3, 3, 0.7);
    return BRepBuilderAPI_GTransform(BRepPrimAPI_MakeSphere(8).Shape(), stretch).Shape();
}

TopoDS_Shape as_splines(const TopoDS_Shape& shape) { return BRepBuilderAPI_NurbsConvert(shape, true).Shape(); }

void write(const std::string& folder, const std::string& name, const TopoDS_Shape& shape, const char* unit = "MM",
           const char* schema = "AP214IS") {
    Interface_Static::SetCVal("write.step.unit", unit);
    Interface_Static::SetCVal("write.step.schema", schema);
    Interface_Static::SetCVal("write.step.product.name", name.c_str());
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    const std::string path = folder + "/" + name + ".step";
    writer.Write(path.c_str());
}

/// A plate and pins: two in a sub-assembly that is placed twice, the second time turned, and one pin mirrored... by its shape, which is
/// what STEP has: colours of parts, an accented name.
void write_assembly(const std::string& folder) {
    Interface_Static::SetCVal("write.step.unit", "MM");
    Interface_Static::SetCVal("write.step.schema", "AP242DIS");
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
    const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
    const auto part = [&](const TopoDS_Shape& shape, const char* name, const Quantity_Color& colour) {
        const TDF_Label label = shapes->AddShape(shape, false);
        TDataStd_Name::Set(label, TCollection_ExtendedString(name, true));
        colours->SetColor(label, colour, XCAFDoc_ColorSurf);
        return label;
    };
    const auto group = [&](const char* name) {
        const TDF_Label label = shapes->NewShape();
        TDataStd_Name::Set(label, TCollection_ExtendedString(name, true));
        return label;
    };
    const auto at = [](double x, double y, double z, double degrees = 0) {
        gp_Trsf turn, shift;
        turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), degrees * M_PI / 180);
        shift.SetTranslation(gp_Vec(x, y, z));
        return TopLoc_Location(shift * turn);
    };
    const TDF_Label plate = part(BRepPrimAPI_MakeBox(60, 40, 5).Shape(), "plate", Quantity_Color(1, 0, 0, Quantity_TOC_sRGB));
    const TDF_Label pin = part(cylinder(2, 10), "pin", Quantity_Color(0, 0, 1, Quantity_TOC_sRGB));
    const TDF_Label pair = group("paire-\u00e9"), whole = group("whole");
    shapes->AddComponent(pair, pin, at(0, 0, 0));
    shapes->AddComponent(pair, pin, at(10, 0, 0));
    shapes->AddComponent(whole, plate, at(0, 0, 0));
    shapes->AddComponent(whole, pair, at(10, 10, 5.5));
    shapes->AddComponent(whole, pair, at(40, 10, 5.5, 90));
    shapes->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    writer.Transfer(document, STEPControl_AsIs);
    writer.Write((folder + "/assembly.step").c_str());
}

void write_all(const std::string& folder) {
    write(folder, "box", BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "MM", "AP203");
    write(folder, "box_inch", BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "INCH");
    write(folder, "cylinder", cylinder(5, 20));
    write(folder, "cone", BRepPrimAPI_MakeCone(6, 2, 15).Shape());
    write(folder, "pointed_cone", BRepPrimAPI_MakeCone(6, 0, 15).Shape());
    write(folder, "sphere", BRepPrimAPI_MakeSphere(7).Shape());
    write(folder, "torus", BRepPrimAPI_MakeTorus(12, 3).Shape());
    write(folder, "bored_box", bored_box(3.25));
    write(folder, "cut_cylinder", cut_cylinder());
    write(folder, "crossed_bores", crossed_bores());
    write(folder, "rounded_box", rounded_box());
    write(folder, "extruded_wave", extruded_wave());
    write(folder, "turned_wave", turned_wave());
    write(folder, "ellipsoid", ellipsoid(), "MM", "AP242DIS");
    write(folder, "spline_cylinder", as_splines(cylinder(5, 20)));
    write(folder, "spline_sphere", as_splines(BRepPrimAPI_MakeSphere(7).Shape()));
    write(folder, "spline_torus", as_splines(BRepPrimAPI_MakeTorus(12, 3).Shape()));
    write(folder, "spline_bored_box", as_splines(bored_box(3.25)));
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
    write(folder, "open_shell", TopExp_Explorer(box, TopAbs_FACE).Current());
    write_assembly(folder);
}

/// So many of each face, of a total.
void add_points(const TopoDS_Face& face, long count, std::mt19937_64& random, std::vector<double>& to) {
    const BRepAdaptor_Surface surface(face);
    BRepTopAdaptor_FClass2d region(face, 1e-9);
    std::uniform_real_distribution<double> u(surface.FirstUParameter(), surface.LastUParameter()),
        v(surface.FirstVParameter(), surface.LastVParameter());
    for (long found = 0, tried = 0; found < count && tried < 50 * count + 1000; ++tried) {
        const gp_Pnt2d uv(u(random), v(random));
        if (region.Perform(uv) != TopAbs_IN) continue;
        const gp_Pnt at = surface.Value(uv.X(), uv.Y());
        for (int k = 1; k <= 3; ++k) to.push_back(1e-3 * at.Coord(k));
        ++found;
    }
}

int write_points(const char* path, long count, const char* out) {
    STEPControl_Reader reader;
    if (reader.ReadFile(path) != IFSelect_RetDone) return 1;
    reader.TransferRoots();
    std::vector<TopoDS_Face> faces;
    std::vector<double> areas;
    double total = 0;
    const TopoDS_Shape shape = reader.OneShape();
    for (TopExp_Explorer each(shape, TopAbs_FACE); each.More(); each.Next()) {
        GProp_GProps area;
        BRepGProp::SurfaceProperties(each.Current(), area);
        faces.push_back(TopoDS::Face(each.Current()));
        areas.push_back(std::abs(area.Mass()));
        total += areas.back();
    }
    std::mt19937_64 random(7);
    std::vector<double> points;
    for (std::size_t i = 0; i < faces.size(); ++i)
        add_points(faces[i], 1 + static_cast<long>(static_cast<double>(count) * areas[i] / total), random, points);
    std::ofstream(out, std::ios::binary)
        .write(reinterpret_cast<const char*>(points.data()), static_cast<std::streamsize>(points.size() * sizeof(double)));
    return 0;
}

}  // namespace

int main(int count, char** words) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    STEPControl_Writer first;  // it sets what "write.step" options there are
    if (count == 3 && std::strcmp(words[1], "write") == 0) {
        write_all(words[2]);
        return 0;
    }
    if (count == 5 && std::strcmp(words[1], "points") == 0) return write_points(words[2], std::atol(words[3]), words[4]);
    return 3;
}
