#pragma once
// The numbers of as many bodies as an instruction works on at once, times two. Like step.hpp this is compiled
// once for each instruction set, so all of it has internal linkage: the linker must not take a function made
// for one set for that of another. For the same reason it uses little of the standard library.

#include <cstddef>
#include <experimental/simd>

#include "integrators/ensemble/bodies.hpp"

namespace gnomon::ensemble {
namespace {

/// Two vector registers, because the operations of one body wait for one another: with a second, independent
/// one between them a step takes two thirds of the time.
class Lanes {
 public:
  using Register = std::experimental::native_simd<double>;
  struct Mask {
    Register::mask_type first, second;
  };
  static constexpr std::size_t size = 2 * Register::size();

  Lanes(double value) : first_(value), second_(value) {}
  Lanes(const Register& first, const Register& second) : first_(first), second_(second) {}
  // Written out: GCC 12 copies the whole by halves of registers, which stalls the loads that follow.
  Lanes(const Lanes& other) : first_(other.first_), second_(other.second_) {}
  Lanes& operator=(const Lanes& other) {
    first_ = other.first_;
    second_ = other.second_;
    return *this;
  }

  static Lanes load(const double* from) {
    return {Register(from, std::experimental::vector_aligned),
            Register(from + Register::size(), std::experimental::vector_aligned)};
  }
  void store(double* to) const {
    first_.copy_to(to, std::experimental::vector_aligned);
    second_.copy_to(to + Register::size(), std::experimental::vector_aligned);
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return {a.first_ + b.first_, a.second_ + b.second_};
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return {a.first_ - b.first_, a.second_ - b.second_};
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return {a.first_ * b.first_, a.second_ * b.second_};
  }
  /// Where not a <= limit, that is, also where a is not a number.
  friend Mask beyond(const Lanes& a, double limit) {
    return {!(a.first_ <= Register(limit)), !(a.second_ <= Register(limit))};
  }
  friend Mask operator||(const Mask& a, const Mask& b) { return {a.first || b.first, a.second || b.second}; }
  friend bool any(const Mask& a) { return std::experimental::any_of(a.first || a.second); }

 private:
  Register first_, second_;
};

static_assert(block % Lanes::size == 0);

}  // namespace
}  // namespace gnomon::ensemble
