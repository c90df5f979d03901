#include "io/step/opencascade/write_files.hpp"

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPConstruct.hxx>
#include <STEPControl_Reader.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <Transfer_FinderProcess.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <fstream>
#include <mutex>
#include <stdexcept>

#include "io/step/opencascade/bodies.hpp"

namespace cloud2csg::brep {
namespace {

/// The kernel keeps one set of file settings a process.
std::mutex& file_settings() {
  static std::mutex mutex;
  return mutex;
}

void name_label(const TDF_Label& label, const std::string& name) {
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), true));
}

TDF_Label add_named(XCAFDoc_ShapeTool& shapes, const NamedShape& shape) {
  const TDF_Label label = shapes.AddShape(shape.shape, false);
  name_label(label, shape.name);
  return label;
}

void fill_document(const Handle(TDocStd_Document) & document, const StepContent& content) {
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label solid = add_named(*shapes, content.part);
  if (content.components.empty()) return;
  const auto add_to = [&](const TDF_Label& assembly, const TDF_Label& member, const std::string& name) {
    name_label(shapes->AddComponent(assembly, member, TopLoc_Location()), name);
  };
  const TDF_Label all = shapes->NewShape();
  name_label(all, content.assembly_name);
  const TDF_Label group = shapes->NewShape();
  const std::string group_name = "primitives";
  name_label(group, group_name);
  for (const NamedShape& component : content.components) add_to(group, add_named(*shapes, component), component.name);
  add_to(all, solid, content.part.name);
  add_to(all, group, group_name);
  shapes->UpdateAssemblies();
}

void name_item(const Handle(Transfer_FinderProcess) & finder, const NamedShape& shape) {
  const Handle(StepRepr_RepresentationItem) item = STEPConstruct::FindEntity(finder, shape.shape);
  if (!item.IsNull()) item->SetName(new TCollection_HAsciiString(shape.name.c_str()));
}

void write_header(STEPCAFControl_Writer& writer, const std::string& name, const std::string& program) {
  APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
  const auto text = [](const std::string& value) { return new TCollection_HAsciiString(value.c_str()); };
  header.SetName(text(name));
  header.SetOriginatingSystem(text(program));
  header.SetDescriptionValue(1, text("a CSG tree as a boundary representation"));
}

}  // namespace

void write_step_file(const std::filesystem::path& file, const StepContent& content) {
  const std::lock_guard lock(file_settings());
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetIVal("write.surfacecurve.mode", 1);
  const Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  fill_document(document, content);
  STEPCAFControl_Writer writer;
  if (!writer.Transfer(document, STEPControl_AsIs))
    throw std::runtime_error("the kernel cannot turn the solid into STEP");
  const Handle(Transfer_FinderProcess) finder = writer.ChangeWriter().WS()->TransferWriter()->FinderProcess();
  for (const NamedShape& face : content.faces) name_item(finder, face);
  for (TopExp_Explorer solids(content.part.shape, TopAbs_SOLID); solids.More(); solids.Next()) {
    name_item(finder, {.shape = solids.Current(), .name = content.part.name});
  }
  write_header(writer, content.part.name, content.program);
  if (writer.Write(file.c_str()) != IFSelect_RetDone) throw std::runtime_error("the kernel cannot write the file");
}

StepReading read_step_file(const std::filesystem::path& file) {
  const std::lock_guard lock(file_settings());
  STEPControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone || reader.TransferRoots() == 0) return {};
  const TopoDS_Shape shape = reader.OneShape();
  return {.is_valid = is_valid(shape), .volume = volume_of(shape), .solids = bodies_of(shape).size()};
}

void write_brep_file(const std::filesystem::path& file, const TopoDS_Shape& shape) {
  std::ofstream stream(file, std::ios::binary);
  BRepTools::Write(shape, stream);
  stream.flush();
  if (!stream) throw std::runtime_error("the file cannot be written");
}

}  // namespace cloud2csg::brep
