#pragma once

#include "cloud2csg/advanced/cells.hpp"
#include "core/tree/interner.hpp"

namespace cloud2csg {

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = cell.size();
    for (const PrimitiveIndex p : cell) hash = mix(hash ^ p);
    return hash;
  }
};

}  // namespace cloud2csg
