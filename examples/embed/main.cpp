// From a cloud to an OpenSCAD file, and to any other that cloud2csg writes.
#include <cloud2csg/error.hpp>
#include <cloud2csg/export.hpp>
#include <cloud2csg/input.hpp>
#include <cloud2csg/reconstruct.hpp>
#include <iostream>

int main(int argc, char** argv) {
  namespace c2c = cloud2csg;
  if (argc != 3) {
    std::cerr << "usage: embed CLOUD OUTPUT\n";
    return 2;
  }
  try {
    const c2c::Input input = c2c::read_cloud_or_mesh(argv[1]);
    const c2c::Reconstruction found = c2c::reconstruct(input.cloud);
    c2c::export_model(argv[2], {.primitives = found.solids, .tree = found.tree});
    std::cout << found.solids.size() << " solids in a tree of " << found.tree.size() << " nodes\n";
  } catch (const c2c::Error& error) {
    std::cerr << "embed: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
