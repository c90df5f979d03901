#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "paper/objective/class_table.hpp"
#include "paper/objective/rank_kernels.hpp"

namespace cloud2csg {

/// A set of primitives by which points are grouped one by one. Tables of subsets are made of its classes, of which
/// there are far fewer than points; therefore points of one class also belong to the same primitives of the set.
struct Root {
  std::vector<PrimitiveIndex> primitives;
  std::vector<PrimitiveIndex> owners;      ///< points that belong to one of these
  std::size_t stride = 1;                  ///< every k-th point
  bool all_points = false;                 ///< also those that belong to none of the owners
  bool without_strangers = false;          ///< not those inside of a primitive that is not in the set
  std::optional<AlignedBox> region = {};   ///< only the points in it
  bool has_member_word = false;            ///< whether keys end with a word that tells to whom the points belong
  std::vector<std::size_t> requests = {};  ///< that are answered from it

  [[nodiscard]] KeyLayout layout() const { return KeyLayout(primitives.size()); }
  [[nodiscard]] std::size_t key_words() const { return layout().words + (has_member_word ? 1 : 0); }
};

/// The roots for all requests. Each request is answered by one of them. O(sum of the set sizes x roots that share a
/// primitive).
[[nodiscard]] std::vector<Root> plan_roots(std::span<const RankClassesRequest> requests);

/// By class of a root, the primitives of its set that the points are inside of: bit k for the k-th.
[[nodiscard]] std::vector<std::uint32_t> inside_words(const Root& root, const ClassTable& classes);

/// Groups the classes of a root by the order of the request's primitives. `inside`: its inside_words().
[[nodiscard]] ClassTable project(const Root& root, const ClassTable& classes, std::span<const std::uint32_t> inside,
                                 const RankClassesRequest& request);

}  // namespace cloud2csg
