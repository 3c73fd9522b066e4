#pragma once
#include <array>
#include <cmath>
#include <cstdint>

namespace gnomon::rigid_body_ensemble {

/// xoshiro256** of D. Blackman and S. Vigna (ACM Trans. Math. Softw. 47 (2021) 36), its state filled by
/// splitmix64 of the seed as they advise. With the rejection methods below, which need +, *, / and the square
/// root only, the numbers are the same on every machine.
class Random {
 public:
  /// Streams of different numbers are independent: the seed of stream k is the output k of splitmix64.
  Random(std::uint64_t seed, std::uint64_t stream) {
    std::uint64_t counter = seed + stream * increment;
    counter = splitmix(counter);
    for (std::uint64_t& word : state_) word = splitmix(counter);
  }

  std::uint64_t bits() {
    const std::uint64_t result = rotate(state_[1] * 5, 7) * 9, shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  /// Uniform in [0, 1), a multiple of 2^-53.
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double least, double most) { return least + (most - least) * unit(); }

  /// A unit vector of any direction (G. Marsaglia, Ann. Math. Stat. 43 (1972) 645-646).
  std::array<double, 3> direction() {
    const Point p = in_disc();
    const double root = 2.0 * std::sqrt(1.0 - p.square);
    return {p.x * root, p.y * root, 1.0 - 2.0 * p.square};
  }
  /// A unit quaternion, every attitude being as likely as any other (the same source).
  std::array<double, 4> quaternion() {
    const Point p = in_disc(), q = in_disc();
    const double root = std::sqrt((1.0 - p.square) / q.square);
    return {p.x, p.y, q.x * root, q.y * root};
  }

 private:
  static constexpr std::uint64_t increment = 0x9e3779b97f4a7c15U;
  struct Point {
    double x, y, square;
  };
  Point in_disc() {
    for (;;) {
      const double x = uniform(-1.0, 1.0), y = uniform(-1.0, 1.0), square = x * x + y * y;
      if (square < 1.0 && square > 0.0) return {x, y, square};
    }
  }
  static std::uint64_t splitmix(std::uint64_t& counter) {
    std::uint64_t z = counter += increment;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  static std::uint64_t rotate(std::uint64_t x, int by) { return (x << by) | (x >> (64 - by)); }

  std::array<std::uint64_t, 4> state_{};
};

}  // namespace gnomon::rigid_body_ensemble
