#pragma once
// Small matrices of lanes. Compiled once for each instruction set, see lane_step.hpp.

namespace gnomon::beam::linear {
namespace {

/// A 3 x 3 block, row by row; `Number` is one number or one a lane.
template <class Number>
struct Block {
  Number at[3][3];
};
template <class Number>
struct Triple {
  Number at[3];
};

/// By the adjugate: no exchanges of rows.
template <class Number>
[[gnu::always_inline]] inline Block<Number> inverse(const Block<Number>& d) {
  const auto& a = d.at;
  const Number c0 = a[1][1] * a[2][2] - a[1][2] * a[2][1], c1 = a[1][2] * a[2][0] - a[1][0] * a[2][2],
               c2 = a[1][0] * a[2][1] - a[1][1] * a[2][0];
  const Number r = 1.0 / ((a[0][0] * c0 + a[0][1] * c1) + a[0][2] * c2);
  return {
      {{c0 * r, (a[0][2] * a[2][1] - a[0][1] * a[2][2]) * r, (a[0][1] * a[1][2] - a[0][2] * a[1][1]) * r},
       {c1 * r, (a[0][0] * a[2][2] - a[0][2] * a[2][0]) * r, (a[0][2] * a[1][0] - a[0][0] * a[1][2]) * r},
       {c2 * r, (a[0][1] * a[2][0] - a[0][0] * a[2][1]) * r, (a[0][0] * a[1][1] - a[0][1] * a[1][0]) * r}}};
}
template <class Number>
[[gnu::always_inline]] inline Block<Number> product(const Block<Number>& a, const Block<Number>& b) {
  Block<Number> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c.at[i][j] = (a.at[i][0] * b.at[0][j] + a.at[i][1] * b.at[1][j]) + a.at[i][2] * b.at[2][j];
  return c;
}
template <class Number>
[[gnu::always_inline]] inline Triple<Number> product(const Block<Number>& a, const Triple<Number>& x) {
  Triple<Number> y;
  for (int i = 0; i < 3; ++i) y.at[i] = (a.at[i][0] * x.at[0] + a.at[i][1] * x.at[1]) + a.at[i][2] * x.at[2];
  return y;
}
template <class Number>
[[gnu::always_inline]] inline void subtract_product(Block<Number>& c, const Block<Number>& a,
                                                    const Block<Number>& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c.at[i][j] -= (a.at[i][0] * b.at[0][j] + a.at[i][1] * b.at[1][j]) + a.at[i][2] * b.at[2][j];
}
template <class Number>
[[gnu::always_inline]] inline void subtract_product(Triple<Number>& y, const Block<Number>& a,
                                                    const Triple<Number>& x) {
  for (int i = 0; i < 3; ++i) y.at[i] -= (a.at[i][0] * x.at[0] + a.at[i][1] * x.at[1]) + a.at[i][2] * x.at[2];
}
template <class Number>
[[gnu::always_inline]] inline void negate(Block<Number>& a) {
  for (auto& row : a.at)
    for (Number& x : row) x = -x;
}

/// Takes unknowns with `free` = 0 out of a node's equations: their correction is 0. `in` and `out` are the
/// blocks that couple it with the next node.
template <class Number>
[[gnu::always_inline]] inline void hold(const Triple<Number>& free, Block<Number>& diagonal,
                                        Block<Number>& to_next, Block<Number>& from_next) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      diagonal.at[i][j] *= free.at[i] * free.at[j];
      to_next.at[i][j] *= free.at[i];
      from_next.at[i][j] *= free.at[j];
    }
    diagonal.at[i][i] += 1.0 - free.at[i];
  }
}

}  // namespace
}  // namespace gnomon::beam::linear
