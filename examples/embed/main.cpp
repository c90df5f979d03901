// From a cloud to an OpenSCAD file, and to any other that cloud2csg writes.
#include <cloud2csg/cloud2csg.hpp>
#include <iostream>

int main(int argc, char** argv) {
  namespace c2c = cloud2csg;
  if (argc != 3) {
    std::cerr << "usage: embed CLOUD OUTPUT\n";
    return 2;
  }
  try {
    const c2c::Input input = c2c::read_cloud_or_mesh(argv[1]);
    const c2c::Extraction found = c2c::reconstruct(input.cloud);
    c2c::export_model(argv[2], found.model);
    std::cout << found.model.primitives.size() << " solids in a tree of " << found.model.tree->size() << " nodes\n";
  } catch (const c2c::Error& error) {
    std::cerr << "embed: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
