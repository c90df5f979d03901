#pragma once

#include "cloud2csg/advanced/brep.hpp"
#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

/// Answers the kernel's questions about a model.
class ModelHost : public KernelHost {
 public:
  /// All arguments but `names` must outlive this. `names` replace the tokens in STEP files.
  ModelHost(const KernelJob& job, const Model& model, const AlignedBox& extent, const BrepOptions& options,
            const RunContext& run, std::vector<std::string> names = {});

  [[nodiscard]] KernelSolid solid_of(PrimitiveIndex primitive) const override;
  [[nodiscard]] std::optional<VolumeEstimate> volume_of(std::size_t node) const override;
  [[nodiscard]] Facets facets_of(std::size_t node) const override;
  [[nodiscard]] PrimitiveIndex primitive_at(const std::vector<Eigen::Vector3d>& points) const override;
  void name_step(const std::filesystem::path& file) const override;
  [[nodiscard]] const RunContext& run() const override { return run_; }

 private:
  [[nodiscard]] Facets facets_of(const Model& part) const;

  const KernelJob& job_;
  const PrimitiveSet& primitives_;
  const AlignedBox& extent_;  ///< in the model's frame
  const BrepOptions& options_;
  const RunContext& run_;
  RunContext quiet_;  ///< stops with the run, reports nothing
  std::vector<PrimitiveIndex> used_;
  std::vector<std::string> names_;
};

}  // namespace cloud2csg::brep
