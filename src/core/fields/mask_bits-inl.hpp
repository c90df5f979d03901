// Included once per instruction set (Highway's foreach_target), hence no ordinary include guard.
#if defined(CLOUD2CSG_FIELDS_MASK_BITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOUD2CSG_FIELDS_MASK_BITS_INL
#undef CLOUD2CSG_FIELDS_MASK_BITS_INL
#else
#define CLOUD2CSG_FIELDS_MASK_BITS_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>

/// Turns comparisons of vectors into words of a BlockMask.
HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The bits of at most 16 lanes. Reads them byte by byte, because a wider load would have to wait for the store.
template <class Tag, class Mask>
HWY_INLINE std::uint64_t bits_of(Tag tag, Mask mask) {
  static_assert(hn::MaxLanes(Tag()) <= 16);
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(tag, mask, bytes.data());
  return bytes[0] | std::uint64_t{bytes[1]} << 8U;
}

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
