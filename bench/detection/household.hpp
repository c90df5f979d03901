#pragma once

#include <string>
#include <vector>

#include "cloud2csg/model.hpp"
#include "detection/scene.hpp"

namespace cloud2csg::bench {

/// A question about a household thing, and its name in the table.
struct HouseholdQuestion {
  std::string name;
  Question question;
  double size;  ///< height, depth or radius of the tested surface, in sigma
};

/// A box or can of length 1.
struct HouseholdThing {
  std::string name;
  Model model;
  std::vector<Surface> surfaces;
  std::vector<HouseholdQuestion> questions;
};

[[nodiscard]] std::vector<HouseholdThing> household_things();

/// Vertices of a mesh of the thing, with noise, smoothed: as from a program that joins the views of a depth camera.
/// The map from noisy to smoothed vertices is known and linear, so the oracle sees the noisy ones.
[[nodiscard]] Scene scan_thing(const HouseholdThing& thing, std::uint64_t seed);

}  // namespace cloud2csg::bench
