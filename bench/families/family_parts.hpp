#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/families/family.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

/// Builds a model part by part; its tree is the union of the parts' trees.
class FamilyBuilder {
 public:
  /// Returns the leaf of the new primitive. Its id is the type's name and a number.
  CsgTree add(Shape shape, const Pose& pose);
  void add_part(CsgTree tree) { parts_.push_back(std::move(tree)); }

  [[nodiscard]] std::size_t size() const { return primitives_.size(); }
  /// Unites the parts in a balanced tree of logarithmic depth.
  [[nodiscard]] Model finish(std::string description);

 private:
  PrimitiveSet primitives_;
  std::vector<CsgTree> parts_;
};

class SpiralPath {
 public:
  /// `spacing` between places, `pitch` between turns. The first turn is wide, so places turn little between neighbours.
  SpiralPath(double spacing, double pitch);

  /// The next place: local x along the path, z up.
  Pose next();

 private:
  double spacing_;
  double pitch_;
  double angle_;
};

/// A rotation about a random axis by an angle in +-`most_deg`.
[[nodiscard]] Eigen::Quaterniond random_tilt(double most_deg, RandomStream& random);
[[nodiscard]] Eigen::Quaterniond random_orientation(RandomStream& random);
/// Each coordinate in +-`reach`.
[[nodiscard]] Eigen::Vector3d random_shift(double reach, RandomStream& random);

[[nodiscard]] RandomStream family_stream(Family family, const FamilyOptions& options, std::size_t part);

void build_chain(FamilyBuilder& builder, const FamilyOptions& options);
void build_grid(FamilyBuilder& builder, const FamilyOptions& options);
void build_plates(FamilyBuilder& builder, const FamilyOptions& options);
void build_panel(FamilyBuilder& builder, const FamilyOptions& options);
void build_clusters(FamilyBuilder& builder, const FamilyOptions& options);
void build_nests(FamilyBuilder& builder, const FamilyOptions& options);

}  // namespace cloud2csg
