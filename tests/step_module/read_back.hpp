#pragma once

#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_Product.hxx>
#include <StepShape_AdvancedFace.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <filesystem>
#include <set>
#include <string>

/// What OpenCASCADE's own readers find in a file.
namespace cloud2csg::test {

struct ReadBack {
  bool is_valid = false;
  double volume = 0;
  std::size_t solids = 0;
  std::set<std::string> products = {};
  std::set<std::string> faces = {};
};

inline ReadBack measured(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  ReadBack found{.is_valid = BRepCheck_Analyzer(shape).IsValid(), .volume = properties.Mass()};
  for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next()) ++found.solids;
  return found;
}

inline ReadBack read_step(const std::filesystem::path& file) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) return {};
  reader.TransferRoots();
  ReadBack found = measured(reader.OneShape());
  const Handle(Interface_InterfaceModel) model = reader.Model();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (const auto face = Handle(StepShape_AdvancedFace)::DownCast(entity); !face.IsNull()) {
      found.faces.insert(face->Name()->ToCString());
    } else if (const auto product = Handle(StepBasic_Product)::DownCast(entity); !product.IsNull()) {
      found.products.insert(product->Name()->ToCString());
    }
  }
  return found;
}

inline ReadBack read_brep(const std::filesystem::path& file) {
  TopoDS_Shape shape;
  const BRep_Builder builder;
  if (!BRepTools::Read(shape, file.c_str(), builder)) return {};
  return measured(shape);
}

}  // namespace cloud2csg::test
