#include <algorithm>
#include <utility>

#include "cloud2csg/advanced/cells.hpp"
#include "core/base/run.hpp"
#include "pipeline/extraction_run.hpp"

namespace cloud2csg {

double CellExtraction::trust() const {
  // If most points are near several surfaces, the cells have too little evidence.
  constexpr double k_least_share = 0.6;
  const auto assigned = static_cast<double>(complex.order.size() - complex.unassigned);
  if (!tree || is_constant(*tree) || statistics.speaking_points < k_least_share * assigned) return 0;
  return 1 - statistics.contradicted_share();
}

bool CellExtraction::is_unbounded(const CsgTree& some) const {
  const std::vector<PrimitiveIndex> used = primitives_of(some);
  const PrimitiveIndex last = std::max(supported.original.back(), used.empty() ? 0 : used.back());
  return std::ranges::any_of(complex.unbounded, [&](CellIndex cell) {
    std::vector<bool> is_inside(1 + last);
    for (const PrimitiveIndex p : complex.cells[cell]) is_inside[supported.original[p]] = true;
    return contains(some, is_inside);
  });
}

CellExtraction extract_by_cells(const PointCloud& cloud, const PrimitiveSet& primitives, const NoiseScale& scale,
                                const ExtractOptions& options, const ExtractionRun& run) {
  Stopwatch watch;
  const RunContext search_run = run.search();
  CellExtraction result{.supported = take_all(primitives)};
  SupportedPrimitives& supported = result.supported;
  for (std::size_t before = 0; before != supported.size();) {
    before = supported.size();
    result.complex = find_cells(cloud, supported.primitives,
                                {.tolerances = scale.tolerances,
                                 .noise = scale.noise,
                                 .precision = options.precision,
                                 .samples = options.cell_samples},
                                run.pass());
    supported = without_unsupported(std::move(supported), result.complex.points_of_primitive);
  }
  result.seconds.segment = watch.lap();
  search_run.report("search", 0, 1);
  LabelOptions labelling = options.cell_labels;
  if (cloud.has_sensor_positions()) labelling.absence = std::min(labelling.absence, labelling.absence_in_scans);
  const CellLabels labels = label_cells(result.complex, labelling);
  const std::optional<CellSolution> solution = solve_cells(result.complex, labels, options.cell_solve, search_run);
  result.seconds.search = watch.lap();
  search_run.report("search", 1, 1);
  if (!solution) return result;
  result.tree = renumber(solution->tree, supported.original);
  result.is_complete = solution->is_complete;
  result.statistics = {.cells = result.complex.cells.size(),
                       .patches = result.complex.patches.size(),
                       .open_cells = solution->open_cells.size(),
                       .speaking_points = labels.points,
                       .contradicted_points = solution->cost,
                       .peeled = solution->peeled,
                       .cores = solution->cores,
                       .least_leaves = solution->least_leaves,
                       .is_minimal = solution->is_minimal()};
  result.open_cells = solution->open_cells;
  result.steps = solution->steps;
  return result;
}

double open_volume(const CellExtraction& extraction, const AlignedBox& box, const RunContext& run) {
  const CellVolumes volumes = measure_volumes(extraction.complex, extraction.supported.primitives, box, 5'000, run);
  double open = volumes.elsewhere;
  for (const CellIndex cell : extraction.open_cells) open += volumes.of_cell[cell];
  double all = volumes.elsewhere;
  for (std::size_t cell = 1; cell < volumes.of_cell.size(); ++cell) all += volumes.of_cell[cell];
  return all > 0 ? open / all : 0;
}

}  // namespace cloud2csg
