#include "cloud2csg/sample.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

PointCloud with_noise(PointCloud cloud, double sigma, std::uint64_t seed) {
  constexpr std::uint64_t k_noise_stage = 0x6e6f6973;
  RandomStream random(seed, k_noise_stage);
  for (std::vector<double>* axis : {&cloud.positions.x, &cloud.positions.y, &cloud.positions.z}) {
    for (double& value : *axis) value += sigma * random.normal();
  }
  return cloud;
}

}  // namespace cloud2csg
