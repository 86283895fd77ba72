// SPDX-License-Identifier: MIT
#include "core/step_importer/read_step.hpp"

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRep_Tool.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <cmath>
#include <map>

namespace fettle::core::step_importer {
namespace {

constexpr int deepest = 100;  // sub-assemblies within one another
constexpr std::size_t most_solids = 20'000;

std::string text_of(const TCollection_ExtendedString& from) {
    std::string text(static_cast<std::size_t>(from.LengthOfCString()), '\0');
    Standard_PCharacter characters = text.data();
    std::vector<char> buffer(text.size() + 1);
    characters = buffer.data();
    from.ToUTF8CString(characters);
    return buffer.data();
}

std::uint32_t number_of(const Quantity_Color& colour) {
    double red = 0, green = 0, blue = 0;
    colour.Values(red, green, blue, Quantity_TOC_sRGB);
    const auto byte = [](double share) { return static_cast<std::uint32_t>(std::lround(255 * std::min(std::max(share, 0.0), 1.0))); };
    return 0x1000000u | byte(red) << 16 | byte(green) << 8 | byte(blue);
}

class Document {
public:
    explicit Document(const char* path) {
        Message::DefaultMessenger()->ChangePrinters().Clear();
        XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document_);
        Interface_Static::SetCVal("xstep.cascade.unit", "MM");
        reader_.SetColorMode(true);
        reader_.SetNameMode(true);
        const IFSelect_ReturnStatus status = reader_.ReadFile(path);
        model_ = Handle(StepData_StepModel)::DownCast(reader_.Reader().WS()->Model());
        const std::string fault = first_fault();
        if (status != IFSelect_RetDone || model_.IsNull() || model_->NbEntities() == 0)
            throw Fault{"Open CASCADE finds no STEP data in it" + (fault.empty() ? "" : ": " + fault)};
        if (!reader_.Transfer(document_))
            throw Fault{"it has nothing that Open CASCADE can make a shape of" + (fault.empty() ? "" : ": " + fault)};
        check_solids(fault);
        shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
        colours_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
    }

    StepContents contents() {
        TDF_LabelSequence roots;
        shapes_->GetFreeShapes(roots);
        for (int i = 1; i <= roots.Length(); ++i) walk(roots.Value(i), TopLoc_Location(), "", 0, 0);
        if (contents_.solids.empty()) throw Fault{"it has no solids: no volume is bounded by its faces; export solid bodies"};
        return std::move(contents_);
    }

    std::string entity(const TopoDS_Shape& shape) const {
        const Handle(XSControl_TransferReader) transfer = reader_.Reader().WS()->TransferReader();
        const Handle(Standard_Transient) found = transfer->EntityFromShapeResult(shape, 1);
        return found.IsNull() ? "" : label_of(found);
    }

private:
    std::string label_of(const Handle(Standard_Transient) & entity) const {
        const Handle(TCollection_HAsciiString) label = model_->StringLabel(entity);
        return label.IsNull() ? "" : label->ToCString();
    }

    /// What the file's own check says first, with its entity.
    std::string first_fault() const {
        if (model_.IsNull()) return {};
        Interface_CheckIterator checks = reader_.Reader().WS()->ModelCheckList(false);
        for (checks.Start(); checks.More(); checks.Next()) {
            if (!checks.Value()->HasFailed()) continue;
            const Handle(Standard_Transient) entity = checks.Value()->Entity();
            const std::string label = entity.IsNull() || checks.Number() == 0 ? "" : label_of(entity) + ": ";
            return label + checks.Value()->CFail(1, true);
        }
        return {};
    }

    /// Every solid of the file has become one: none is left out in silence.
    void check_solids(const std::string& fault) const {
        const Handle(XSControl_TransferReader) transfer = reader_.Reader().WS()->TransferReader();
        for (int i = 1; i <= model_->NbEntities(); ++i) {
            const Handle(Standard_Transient) entity = model_->Value(i);
            if (!entity->IsKind(STANDARD_TYPE(StepShape_ManifoldSolidBrep))) continue;
            const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer->TransientProcess(), entity);
            if (shape.IsNull() || !TopExp_Explorer(shape, TopAbs_SOLID).More())
                throw Fault{"Open CASCADE makes no solid of " + label_of(entity) + (fault.empty() ? "" : " (" + fault + ")")};
        }
    }

    static std::string name_of(const TDF_Label& label) {
        Handle(TDataStd_Name) name;
        return label.FindAttribute(TDataStd_Name::GetID(), name) ? text_of(name->Get()) : "";
    }

    template <class Of>
    std::uint32_t colour_of(const Of& of) const {
        Quantity_Color colour;
        for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
            if (colours_->GetColor(of, type, colour)) return number_of(colour);
        return 0;
    }

    /// The name of a label; where Open CASCADE calls it after its kind, that of the product around it.
    static std::string product_name(const TDF_Label& label, const std::string& around) {
        const std::string own = name_of(label);
        for (const char* kind : {"", "COMPOUND", "COMPSOLID", "SOLID", "SHELL"})
            if (own == kind) return around;
        return own;
    }

    void walk(const TDF_Label& label, const TopLoc_Location& around, const std::string& name_around, std::uint32_t colour, int depth) {
        if (depth > deepest) throw Fault{"its assemblies contain each other"};
        if (const std::uint32_t own = colour_of(label); own != 0 && colour == 0) colour = own;
        if (shapes_->IsReference(label)) {
            TDF_Label referred;
            shapes_->GetReferredShape(label, referred);
            return walk(referred, around * shapes_->GetLocation(label), name_around, colour, depth + 1);
        }
        const std::string name = product_name(label, name_around);
        if (shapes_->IsAssembly(label)) {
            TDF_LabelSequence components;
            shapes_->GetComponents(label, components);
            for (int i = 1; i <= components.Length(); ++i) walk(components.Value(i), around, name, colour, depth + 1);
            return;
        }
        const TopoDS_Shape shape = shapes_->GetShape(label);
        for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next())
            add(TopoDS::Solid(solids.Current()), name, around, colour);
        for (TopExp_Explorer shells(shape, TopAbs_SHELL, TopAbs_SOLID); shells.More(); shells.Next())
            add_shell(shells.Current(), name, around, colour);
        if (const TopExp_Explorer faces(shape, TopAbs_FACE, TopAbs_SHELL); faces.More())
            throw Fault{"part `" + name + "` has a face" + in_file(entity(faces.Current())) +
                        " that belongs to no solid; export solid bodies alone"};
    }

    void add_shell(const TopoDS_Shape& shell, const std::string& name, const TopLoc_Location& around, std::uint32_t colour) {
        if (!BRep_Tool::IsClosed(shell))
            throw Fault{"part `" + name + "` has an open shell" + in_file(entity(shell)) +
                        ", which bounds no solid; export solid bodies alone"};
        add(BRepBuilderAPI_MakeSolid(TopoDS::Shell(shell)).Solid(), name, around, colour);
    }

    void add(const TopoDS_Solid& solid, const std::string& name, const TopLoc_Location& around, std::uint32_t colour) {
        if (contents_.solids.size() >= most_solids) throw Fault{"it places more than " + std::to_string(most_solids) + " solids"};
        const TopoDS_Solid own = TopoDS::Solid(solid.Located(TopLoc_Location()));
        const auto [known, fresh] = known_.try_emplace({own.TShape().get(), own.Orientation()}, static_cast<int>(contents_.shapes.size()));
        if (fresh) {
            contents_.shapes.push_back(own);
            own_colours_.push_back(colour_of(TopoDS_Shape(solid)));  // a search among all labels
        }
        const std::uint32_t its = own_colours_[static_cast<std::size_t>(known->second)];
        contents_.solids.push_back({name, known->second, (around * solid.Location()).Transformation(), colour != 0 ? colour : its});
    }

    Handle(TDocStd_Document) document_;
    STEPCAFControl_Reader reader_;
    Handle(StepData_StepModel) model_;
    Handle(XCAFDoc_ShapeTool) shapes_;
    Handle(XCAFDoc_ColorTool) colours_;
    std::map<std::pair<const void*, int>, int> known_;
    std::vector<std::uint32_t> own_colours_;  // of the shapes
    StepContents contents_;
};

}  // namespace

void read_step(const char* path, const Visit& visit) {
    Document document(path);
    visit(document.contents(), [&](const TopoDS_Shape& shape) { return document.entity(shape); });
}

}  // namespace fettle::core::step_importer
