#pragma once
// Lanes as plain numbers one after the other, with the functions of std::experimental::simd that the kernels
// use; see lane_step.hpp.

#include <experimental/simd>

namespace gnomon::beam::linear {
namespace {

namespace stdx = std::experimental;

struct TwoFlags {
  bool a, b;
};

/// Members rather than an array, so that each stays in a register of its own.
struct TwoNumbers {
  double a, b;

  TwoNumbers() = default;
  TwoNumbers(double x) : a(x), b(x) {}
  TwoNumbers(double x, double y) : a(x), b(y) {}
  template <class Flags>
  TwoNumbers(const double* values, Flags) : a(values[0]), b(values[1]) {}
  template <class Flags>
  void copy_to(double* values, Flags) const {
    values[0] = a, values[1] = b;
  }
  double operator[](int k) const { return k == 0 ? a : b; }
  TwoNumbers operator-() const { return {-a, -b}; }
  TwoNumbers& operator+=(const TwoNumbers& y) { return *this = *this + y; }
  TwoNumbers& operator-=(const TwoNumbers& y) { return *this = *this - y; }
  TwoNumbers& operator*=(const TwoNumbers& y) { return *this = *this * y; }

  friend TwoNumbers operator+(const TwoNumbers& x, const TwoNumbers& y) { return {x.a + y.a, x.b + y.b}; }
  friend TwoNumbers operator-(const TwoNumbers& x, const TwoNumbers& y) { return {x.a - y.a, x.b - y.b}; }
  friend TwoNumbers operator*(const TwoNumbers& x, const TwoNumbers& y) { return {x.a * y.a, x.b * y.b}; }
  friend TwoNumbers operator/(const TwoNumbers& x, const TwoNumbers& y) { return {x.a / y.a, x.b / y.b}; }
  friend TwoFlags operator==(const TwoNumbers& x, const TwoNumbers& y) { return {x.a == y.a, x.b == y.b}; }
};

inline TwoNumbers sqrt(const TwoNumbers& x) { return {__builtin_sqrt(x.a), __builtin_sqrt(x.b)}; }
inline TwoNumbers max(const TwoNumbers& x, const TwoNumbers& y) {
  return {x.a < y.a ? y.a : x.a, x.b < y.b ? y.b : x.b};
}
inline double hmax(const TwoNumbers& x) { return x.a < x.b ? x.b : x.a; }
inline double reduce(const TwoNumbers& x) { return x.a + x.b; }

/// Those of the numbers that flags choose.
struct ChosenNumbers {
  const TwoFlags& flags;
  TwoNumbers& numbers;
  void operator=(const TwoNumbers& values) {
    if (flags.a) numbers.a = values.a;
    if (flags.b) numbers.b = values.b;
  }
};
inline ChosenNumbers where(const TwoFlags& flags, TwoNumbers& numbers) { return {flags, numbers}; }

template <int lanes>
struct PlainLanes;
template <>
struct PlainLanes<2> {
  using type = TwoNumbers;
};
template <int lanes>
using Lanes = typename PlainLanes<lanes>::type;

}  // namespace
}  // namespace gnomon::beam::linear
