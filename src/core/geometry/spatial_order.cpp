#include "core/geometry/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/parallel.hpp"

namespace cloud2csg {
namespace {

/// Bits of a cell's number that one pass sorts by.
constexpr int k_digit_bits = 11;
/// The fewest points for a thread of their own.
constexpr std::size_t k_least_part = 65'536;

/// Bits along each axis that leave some points of a surface in each cell.
int bits_for(std::size_t count) {
  const double side = std::sqrt(static_cast<double>(count));
  return std::clamp(static_cast<int>(std::bit_width(static_cast<std::size_t>(side))) - 2, 1, MortonCurve::k_most_bits);
}

/// Stable radix sort of points by cell, the lowest digit first.
class CellSort {
 public:
  /// Precondition: cells are below 2^(digits * k_digit_bits).
  CellSort(std::size_t count, int digits, const RunContext& run)
      : run_(run),
        count_(count),
        digits_(digits),
        parts_(std::clamp<std::size_t>(count / k_least_part, 1, static_cast<std::size_t>(usable_threads(run)))),
        places_(parts_),
        keys_(count),
        sorted_(count) {}

  template <class CellOf>
  std::vector<std::uint32_t> order_by(const CellOf& cell_of) {
    std::vector<std::uint32_t> order(count_);
    for_each_part([&](std::size_t part, std::size_t begin, std::size_t end) {
      places_[part].assign(k_digits, 0);
      for (std::size_t i = begin; i < end; ++i) {
        keys_[i] = {cell_of(i), static_cast<std::uint32_t>(i)};
        ++places_[part][digit_of(keys_[i], 0)];
      }
    });
    for (int digit = 0; digit < digits_; ++digit) {
      if (digit > 0) count_digits(digit);
      turn_counts_to_places();
      if (digit + 1 < digits_) {
        distribute(digit, [this](std::size_t place, const Key& key) { sorted_[place] = key; });
        std::swap(keys_, sorted_);
      } else {
        distribute(digit, [&order](std::size_t place, const Key& key) { order[place] = key.index; });
      }
    }
    return order;
  }

 private:
  struct Key {
    std::uint32_t cell, index;
  };
  static constexpr std::size_t k_digits = std::size_t{1} << k_digit_bits;

  static std::size_t digit_of(const Key& key, int digit) {
    return key.cell >> static_cast<unsigned>(digit * k_digit_bits) & (k_digits - 1);
  }

  template <class Work>
  void for_each_part(const Work& work) const {
    for_each_index(parts_, run_,
                   [&](std::size_t part) { work(part, count_ * part / parts_, count_ * (part + 1) / parts_); });
  }

  void count_digits(int digit) {
    for_each_part([&](std::size_t part, std::size_t begin, std::size_t end) {
      places_[part].assign(k_digits, 0);
      for (std::size_t i = begin; i < end; ++i) ++places_[part][digit_of(keys_[i], digit)];
    });
  }

  void turn_counts_to_places() {
    std::uint32_t place = 0;
    for (std::size_t digit = 0; digit < k_digits; ++digit) {
      for (std::vector<std::uint32_t>& counts : places_) place += std::exchange(counts[digit], place);
    }
  }

  template <class Put>
  void distribute(int digit, const Put& put) {
    for_each_part([&](std::size_t part, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) put(places_[part][digit_of(keys_[i], digit)]++, keys_[i]);
    });
  }

  const RunContext& run_;
  std::size_t count_;
  int digits_;
  std::size_t parts_;
  std::vector<std::vector<std::uint32_t>> places_;  // by part and digit: counts, then where the next key goes
  std::vector<Key> keys_, sorted_;
};

}  // namespace

MortonCurve::MortonCurve(Eigen::Vector3d corner, double edge, int bits)
    : corner_(std::move(corner)),
      bits_(bits),
      last_step_((1 << bits) - 1),
      cells_a_unit_((1 << bits) / std::max(edge, 1e-300)) {
  for (std::uint32_t step = 0; step < std::uint32_t{1} << static_cast<unsigned>(bits); ++step) {
    for (unsigned bit = 0; bit < k_most_bits; ++bit) spread_[step] |= (step >> bit & 1U) << (3 * bit);
  }
}

std::vector<std::uint32_t> spatial_order(PointsView positions, const MortonCurve& curve, const RunContext& run) {
  const auto cell_of = [&](std::size_t i) { return curve.cell_of(positions.x[i], positions.y[i], positions.z[i]); };
  const int digits = (3 * curve.bits() + k_digit_bits - 1) / k_digit_bits;
  return CellSort(positions.size(), digits, run).order_by(cell_of);
}

std::vector<std::uint32_t> spatial_order(PointsView positions, const AlignedBox& box, const RunContext& run) {
  const MortonCurve curve(box.min(), box.sizes().maxCoeff(), bits_for(positions.size()));
  return spatial_order(positions, curve, run);
}

}  // namespace cloud2csg
