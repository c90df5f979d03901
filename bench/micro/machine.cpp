#include "micro/machine.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "core/base/random.hpp"
#include "core/base/run.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "micro/machine.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::bench::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// Independent chains: enough to hide the latency of operations, few enough for 16 registers.
constexpr std::size_t k_chains = 12;
using Floats = hn::ScalableTag<float>;
using Bytes = hn::ScalableTag<std::int8_t>;

/// Steps between two jumps, where g++ copies the registers of all chains.
constexpr std::size_t k_steps_a_round = 8;

/// Applies `step` to all chains, k_steps_a_round times per round. The result uses all chains, so none is optimised out.
template <class Tag, class Step>
HWY_INLINE auto run_chains(Tag tag, std::size_t rounds, hn::TFromD<Tag> first, const Step& step) {
  std::array<hn::Vec<Tag>, k_chains> chains;
  for (auto& chain : chains) chain = hn::Set(tag, first);
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < k_steps_a_round; ++i) {
      for (auto& chain : chains) chain = step(chain);
    }
  }
  auto all = chains[0];
  for (const auto& chain : chains) all = hn::Xor(all, chain);
  return hn::GetLane(all);
}

double multiply_and_add(std::size_t rounds, float first) {
  const Floats d;
  const auto factor = hn::Set(d, 0.75F * first);
  const auto summand = hn::Set(d, 0.25F * first);
  return static_cast<double>(run_chains(d, rounds, first, [&](auto x) { return x * factor + summand; }));
}
double fused_multiply_add(std::size_t rounds, float first) {
  const Floats d;
  const auto factor = hn::Set(d, 0.75F * first);
  const auto summand = hn::Set(d, 0.25F * first);
  return static_cast<double>(run_chains(d, rounds, first, [&](auto x) { return hn::MulAdd(x, factor, summand); }));
}
double divide(std::size_t rounds, float first) {
  const Floats d;
  const auto dividend = hn::Set(d, 1.5F * first);
  return static_cast<double>(run_chains(d, rounds, first, [&](auto x) { return dividend / x; }));
}
double take_roots(std::size_t rounds, float first) {
  return static_cast<double>(run_chains(Floats(), rounds, 1.5F * first, [](auto x) { return hn::Sqrt(x); }));
}
double take_extrema(std::size_t rounds, float first) {
  const Bytes d;
  const auto low = hn::Set(d, static_cast<std::int8_t>(-first));
  const auto high = hn::Set(d, static_cast<std::int8_t>(first));
  return run_chains(d, rounds, std::int8_t{5}, [&](auto x) { return hn::Max(hn::Min(x, high), low); });
}

double read_all(std::span<const float> values) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  std::array<hn::Vec<Floats>, 4> chains;
  for (auto& chain : chains) chain = hn::Zero(d);
  for (std::size_t i = 0; i < values.size(); i += 4 * lanes) {
    for (std::size_t k = 0; k < chains.size(); ++k) {
      chains[k] = hn::Xor(chains[k], hn::Load(d, &values[i + k * lanes]));
    }
  }
  return static_cast<double>(hn::GetLane(hn::Xor(hn::Xor(chains[0], chains[1]), hn::Xor(chains[2], chains[3]))));
}

void write_all(std::span<float> values, float value) {
  const Floats d;
  const auto all = hn::Set(d, value);
  for (std::size_t i = 0; i < values.size(); i += hn::Lanes(d)) hn::Store(all, d, &values[i]);
}

double gather_all(const float* table, std::span<const std::int32_t> places) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  auto sum = hn::Zero(d);
  for (std::size_t i = 0; i < places.size(); i += hn::Lanes(d)) {
    sum = sum + hn::GatherIndex(d, table, hn::Load(di, &places[i]));
  }
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum)));
}

std::size_t float_lanes() {
  return hn::Lanes(Floats());
}

const char* target_name() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace
}  // namespace cloud2csg::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <benchmark/benchmark.h>

namespace cloud2csg::bench {
namespace {

HWY_EXPORT(multiply_and_add);
HWY_EXPORT(fused_multiply_add);
HWY_EXPORT(divide);
HWY_EXPORT(take_roots);
HWY_EXPORT(take_extrema);
HWY_EXPORT(read_all);
HWY_EXPORT(write_all);
HWY_EXPORT(gather_all);
HWY_EXPORT(float_lanes);
HWY_EXPORT(target_name);

/// Short, so that some run without interruption; many, since wide vectors are slow until the voltage has risen.
constexpr std::size_t k_tries = 100;
constexpr std::size_t k_rounds = 5000;
/// Each try of a memory loop moves at least this much.
constexpr std::size_t k_bytes_a_try = std::size_t{2} << 20U;
/// Whole vectors of every instruction set, four at a time.
constexpr std::size_t k_padding = 256;

template <class Work>
double least_seconds(const Work& work) {
  work();
  double least = 1e9;
  for (std::size_t i = 0; i < k_tries; ++i) {
    const Stopwatch watch;
    work();
    least = std::min(least, watch.seconds());
  }
  return least;
}

/// Elements per second of a kernel with this many operations per round and chain of vectors.
double chain_rate(double (*kernel)(std::size_t, float), double bytes_an_element, double operations) {
  float first = 1.0F;
  benchmark::DoNotOptimize(first);
  const double seconds = least_seconds([&] { benchmark::DoNotOptimize(kernel(k_rounds, first)); });
  const double vector_bytes = 4.0 * static_cast<double>(HWY_DYNAMIC_DISPATCH(float_lanes)());
  constexpr double k_vectors = 12.0 * 8.0 * static_cast<double>(k_rounds);  // chains x steps x rounds
  return operations * k_vectors * vector_bytes / bytes_an_element / seconds;
}

std::size_t padded_floats(std::size_t bytes) {
  return (bytes / sizeof(float) + k_padding - 1) / k_padding * k_padding;
}

/// Bytes per second of `pass`, which reads or writes all bytes once.
template <class Pass>
double memory_rate(std::size_t bytes, const Pass& pass) {
  const std::size_t passes = k_bytes_a_try / std::max<std::size_t>(1, bytes) + 1;
  const double seconds = least_seconds([&] {
    for (std::size_t i = 0; i < passes; ++i) {
      pass();
      benchmark::ClobberMemory();
    }
  });
  return static_cast<double>(passes * bytes) / seconds;
}

}  // namespace

ArithmeticRates measure_arithmetic() {
  constexpr double k_float = sizeof(float);
  return {.single = chain_rate(HWY_DYNAMIC_DISPATCH(multiply_and_add), k_float, 2),
          .fused = chain_rate(HWY_DYNAMIC_DISPATCH(fused_multiply_add), k_float, 1),
          .single_division = chain_rate(HWY_DYNAMIC_DISPATCH(divide), k_float, 1),
          .single_root = chain_rate(HWY_DYNAMIC_DISPATCH(take_roots), k_float, 1),
          .byte_extremum = chain_rate(HWY_DYNAMIC_DISPATCH(take_extrema), 1, 2)};
}

double measure_reading(std::size_t footprint) {
  const AlignedVector<float> values(padded_floats(footprint), 1.0F);
  return memory_rate(values.size() * sizeof(float),
                     [&] { benchmark::DoNotOptimize(HWY_DYNAMIC_DISPATCH(read_all)(values)); });
}

double measure_writing(std::size_t footprint) {
  AlignedVector<float> values(padded_floats(footprint), 1.0F);
  return memory_rate(values.size() * sizeof(float), [&] { HWY_DYNAMIC_DISPATCH(write_all)(values, 2.0F); });
}

double measure_gathering(std::size_t rows, std::size_t row) {
  const std::size_t padded_rows = (rows + k_padding - 1) / k_padding * k_padding;
  const AlignedVector<float> table(padded_rows * row, 1.0F);
  RandomStream random(1);
  AlignedVector<std::int32_t> places;
  for (std::size_t i = 0; i < padded_rows; ++i)
    places.push_back(static_cast<std::int32_t>(i * row + random.below(row)));
  const double passes = memory_rate(padded_rows * row * sizeof(float), [&] {
    benchmark::DoNotOptimize(HWY_DYNAMIC_DISPATCH(gather_all)(table.data(), places));
  });
  return passes / static_cast<double>(row * sizeof(float));
}

const char* instruction_set() {
  return HWY_DYNAMIC_DISPATCH(target_name)();
}

}  // namespace cloud2csg::bench
#endif  // HWY_ONCE
