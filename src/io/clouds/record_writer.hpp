#pragma once

#include <span>

#include "cloud2csg/point_cloud.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {

/// Which numbers each point becomes, and how they are written.
struct RecordFormat {
  bool binary;            ///< little endian, else text: a row a point, the shortest that reads back to the same number
  bool double_precision;  ///< else float
  bool normals;           ///< after the coordinates
  bool sensor_positions;  ///< after these
  std::span<const Colour> colours = {};  ///< one a point, after these, as three bytes
};

/// Writes all points in large blocks. @throws Error when a number is not finite or out of a float's range.
void write_records(AtomicFile& out, const PointCloud& cloud, const RecordFormat& format);

}  // namespace cloud2csg
