#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "quality/task.hpp"

namespace cloud2csg::bench {

enum class Defect {
  none,
  noise,          ///< sigma of half a percent of the diagonal
  patches,        ///< a fifth of the points is gone, in balls
  outliers,       ///< a twentieth of the points is anywhere, with any normal
  many_outliers,  ///< three tenths of them
  turned,         ///< a fifth of the normals leads the other way
  spurious,       ///< one primitive more: a copy of one, shifted and scaled
  missing,        ///< one primitive less
};
inline constexpr std::array k_defects{Defect::none,          Defect::noise,  Defect::patches,  Defect::outliers,
                                      Defect::many_outliers, Defect::turned, Defect::spurious, Defect::missing};
/// As in the tables.
[[nodiscard]] std::string_view to_string(Defect defect);

struct DefectOptions {
  std::size_t points = 10'000;  ///< before some are taken or added
  double noise = 0.01;          ///< of all but Defect::noise
  std::uint64_t seed = 1;       ///< of cloud, defect and search
};

/// A task whose truth is the model, with the defect.
[[nodiscard]] Task make_defective_task(const Model& model, Defect defect, const DefectOptions& options);

/// IoU of the true tree without the missing primitive; 1 for other defects.
[[nodiscard]] double iou_of_given(const Model& model, const Task& task);

}  // namespace cloud2csg::bench
