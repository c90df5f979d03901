#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "quality/task.hpp"

namespace cloud2csg::bench {

enum class Defect {
  none,
  noise,          ///< sigma of 0.5 % of the diagonal
  patches,        ///< a fifth of the points is missing, in balls
  outliers,       ///< a twentieth of the points is anywhere, with random normals
  many_outliers,  ///< three tenths of the points are outliers
  turned,         ///< a fifth of the normals is flipped
  spurious,       ///< an additional shifted and scaled copy of a primitive
  missing,
};
inline constexpr std::array k_defects{Defect::none,          Defect::noise,  Defect::patches,  Defect::outliers,
                                      Defect::many_outliers, Defect::turned, Defect::spurious, Defect::missing};
/// As in the tables.
[[nodiscard]] std::string_view to_string(Defect defect);

struct DefectOptions {
  std::size_t points = 10'000;  ///< before points are removed or added
  double noise = 0.01;          ///< for all defects except Defect::noise
  std::uint64_t seed = 1;
};

/// A task with the defect whose truth is the model.
[[nodiscard]] Task make_defective_task(const Model& model, Defect defect, const DefectOptions& options);

/// IoU of the true tree without the missing primitive; 1 for other defects.
[[nodiscard]] double iou_of_given(const Model& model, const Task& task);

}  // namespace cloud2csg::bench
