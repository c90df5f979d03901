#pragma once

#include <cstddef>

/// A number type that counts operations, for the primitives' formulas, which are templates over the number type.
namespace cloud2csg::bench {

struct OperationCount {
  std::size_t plain = 0;  ///< additions, multiplications, comparisons, selections, minima, sign changes: one each
  std::size_t divisions = 0;
  std::size_t roots = 0;
};

struct CountingTag {
  OperationCount* count = nullptr;
};

struct CountedMask {
  OperationCount* count;
};

struct Counted {
  OperationCount* count;

  [[nodiscard]] Counted after_plain() const {
    ++count->plain;
    return *this;
  }
  friend Counted operator+(Counted a, Counted /*b*/) { return a.after_plain(); }
  friend Counted operator-(Counted a, Counted /*b*/) { return a.after_plain(); }
  friend Counted operator*(Counted a, Counted /*b*/) { return a.after_plain(); }
  friend Counted operator/(Counted a, Counted /*b*/) {
    ++a.count->divisions;
    return a;
  }
  friend CountedMask operator<(Counted a, Counted /*b*/) { return {a.after_plain().count}; }
  friend CountedMask operator>(Counted a, Counted /*b*/) { return {a.after_plain().count}; }
  friend CountedMask operator>=(Counted a, Counted /*b*/) { return {a.after_plain().count}; }
};

/// Constants are made once for many points and cost nothing.
inline Counted broadcast(CountingTag tag, double /*value*/) {
  return {tag.count};
}
inline Counted tiny_square(CountingTag tag) {
  return {tag.count};
}
inline Counted square_root(Counted a) {
  ++a.count->roots;
  return a;
}
inline Counted absolute(Counted a) {
  return a.after_plain();
}
inline Counted negated(Counted a) {
  return a.after_plain();
}
inline Counted smaller(Counted a, Counted /*b*/) {
  return a.after_plain();
}
inline Counted larger(Counted a, Counted /*b*/) {
  return a.after_plain();
}
inline Counted with_sign_of(Counted magnitude, Counted /*sign*/) {
  return magnitude.after_plain();
}
inline Counted select(CountedMask /*condition*/, Counted yes, Counted /*no*/) {
  return yes.after_plain();
}
inline Counted select_or_zero(CountedMask /*condition*/, Counted yes) {
  return yes.after_plain();
}
inline Counted zero_or_select(CountedMask /*condition*/, Counted no) {
  return no.after_plain();
}
inline CountedMask both(CountedMask a, CountedMask /*b*/) {
  ++a.count->plain;
  return a;
}
inline CountedMask either(CountedMask a, CountedMask /*b*/) {
  ++a.count->plain;
  return a;
}

}  // namespace cloud2csg::bench
