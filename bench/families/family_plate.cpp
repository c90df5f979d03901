#include <algorithm>
#include <array>
#include <utility>

#include "bench/families/family_parts.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_columns = 3;
constexpr std::size_t k_rows = 2;
constexpr double k_cell = 1.2;  ///< distance between centres of features

enum class Feature { hole, boss, hollow_boss, pin_in_hole };
constexpr std::array<std::size_t, 4> k_primitives_of{1, 1, 2, 3};

/// A plate with a lattice of features, in its own frame: z = 0 is the middle of its thickness.
class PlateBuilder {
 public:
  PlateBuilder(FamilyBuilder& builder, Pose place, RandomStream& random)
      : builder_(builder), random_(random), frame_(std::move(place)), top_(random.uniform(0.2, 0.3)) {
    frame_.position += random_shift(0.03, random);
    frame_.orientation = frame_.orientation * random_tilt(1, random);
    const double width = random.uniform(2.6, 2.8);
    body_ = builder.add(Box{.size = {4.6, width, 2 * top_}}, frame_);
  }

  void add(Feature feature, std::size_t cell) {
    const double x = k_cell * (static_cast<double>(cell % k_columns) - 0.5 * (k_columns - 1));
    const std::size_t row = cell / k_columns;
    const double y = k_cell * (static_cast<double>(row) - 0.5 * (k_rows - 1));
    middle_ = Vector3d(x, y, 0) + random_shift(0.04, random_);
    switch (feature) {
      case Feature::hole: {
        const double above = uniform(0.1, 0.2);
        const double below = uniform(0.1, 0.2);
        cuts_.push_back(upright(uniform(0.25, 0.46), -top_ - below, top_ + above));
        break;
      }
      case Feature::boss: {
        const double above = uniform(0.4, 0.8);
        body_ = unite(body_, upright(uniform(0.28, 0.46), -0.4 * top_, top_ + above));
        break;
      }
      case Feature::hollow_boss: {
        const double radius = uniform(0.36, 0.46);
        const double height = top_ + uniform(0.4, 0.8);
        body_ = unite(body_, upright(radius, -0.4 * top_, height));
        cuts_.push_back(upright(radius * uniform(0.45, 0.65), -top_ - 0.15, height + 0.15));
        break;
      }
      case Feature::pin_in_hole: {
        const double floor = uniform(-0.2, 0.1) * top_;
        cuts_.push_back(upright(uniform(0.42, 0.46), floor, top_ + 0.15));
        const double height = top_ + uniform(0.2, 0.5);
        const double radius = uniform(0.22, 0.26);
        const CsgTree pin = upright(radius, -0.5 * top_, height);
        pins_.push_back(subtract(pin, upright(radius * uniform(0.5, 0.6), 0.5 * top_, height + 0.15)));
        break;
      }
    }
  }

  [[nodiscard]] CsgTree finish() const {
    CsgTree tree = cuts_.empty() ? body_ : subtract(body_, unite_all(cuts_));
    for (const CsgTree& pin : pins_) tree = unite(tree, pin);
    return tree;
  }

 private:
  double uniform(double low, double high) { return random_.uniform(low, high); }

  /// A cylinder at the feature's place from z = low to high.
  CsgTree upright(double radius, double low, double high) {
    const Pose local{.position = {middle_.x(), middle_.y(), 0.5 * (low + high)}};
    return builder_.add(Cylinder{.radius = radius, .height = high - low}, compose(frame_, local));
  }

  FamilyBuilder& builder_;
  RandomStream& random_;
  Pose frame_;
  double top_;  ///< half of the thickness
  Vector3d middle_ = Vector3d::Zero();
  CsgTree body_;
  std::vector<CsgTree> cuts_;
  std::vector<CsgTree> pins_;
};

}  // namespace

void build_plates(FamilyBuilder& builder, const FamilyOptions& options) {
  // Each plate extends 0.1 beyond the midpoint to the next one; that area has no features.
  SpiralPath path(4.4, 3.6);
  for (std::size_t part = 0; builder.size() < options.primitives; ++part) {
    RandomStream random = family_stream(Family::plate, options, part);
    PlateBuilder plate(builder, path.next(), random);
    for (std::size_t cell = 0; cell < k_columns * k_rows && builder.size() < options.primitives; ++cell) {
      std::size_t feature = random.below(k_primitives_of.size());
      while (k_primitives_of[feature] > options.primitives - builder.size()) --feature;
      plate.add(static_cast<Feature>(feature), cell);
    }
    builder.add_part(plate.finish());
  }
}

}  // namespace cloud2csg
