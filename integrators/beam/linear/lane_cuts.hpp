#pragma once
// Where the lanes meet: the small system of the nodes between them. Compiled once for each instruction set,
// see lane_step.hpp.

#include "integrators/beam/linear/lane_sweep.hpp"

namespace gnomon::beam::linear {
namespace {

template <int lanes>
[[gnu::always_inline]] inline void add_totals(const Squares<Lanes<lanes>>& lane, Squares<double>& sum) {
  sum.inertia += reduce(lane.inertia);
  sum.internal += reduce(lane.internal);
  sum.external += reduce(lane.external);
  sum.total += reduce(lane.total);
}
/// Numbers of all lanes, to be read two lanes at a time.
using Pair = Lanes<2>;
template <int lanes, int count>
struct alignas(64) Table {
  double at[count][lanes];

  explicit Table(const Block<Lanes<lanes>>& a) {
    for (int k = 0; k < 9; ++k) a.at[k / 3][k % 3].copy_to(at[k], stdx::vector_aligned);
  }
  explicit Table(const Triple<Lanes<lanes>>& a) {
    for (int k = 0; k < 3; ++k) a.at[k].copy_to(at[k], stdx::vector_aligned);
  }
  Pair pair(int k, int j) const { return Pair(at[k] + 2 * j, stdx::vector_aligned); }
  Block<Pair> block(int j) const {
    return {{{pair(0, j), pair(1, j), pair(2, j)},
             {pair(3, j), pair(4, j), pair(5, j)},
             {pair(6, j), pair(7, j), pair(8, j)}}};
  }
  Triple<Pair> triple(int j) const { return {{pair(0, j), pair(1, j), pair(2, j)}}; }
};
template <class Number>
[[gnu::always_inline]] inline void add(Block<Number>& to, const Block<Number>& a) {
  for (int k = 0; k < 9; ++k) to.at[k / 3][k % 3] += a.at[k / 3][k % 3];
}
template <class Number>
[[gnu::always_inline]] inline void add(Triple<Number>& to, const Triple<Number>& a) {
  for (int k = 0; k < 3; ++k) to.at[k] += a.at[k];
}
[[gnu::always_inline]] inline Block<double> sum_of(const Block<Pair>& a) {
  Block<double> sum;
  for (int k = 0; k < 9; ++k) sum.at[k / 3][k % 3] = a.at[k / 3][k % 3][0] + a.at[k / 3][k % 3][1];
  return sum;
}
[[gnu::always_inline]] inline Triple<double> sum_of(const Triple<Pair>& a) {
  return {{a.at[0][0] + a.at[0][1], a.at[1][0] + a.at[1][1], a.at[2][0] + a.at[2][1]}};
}

/// The nodes with which lanes 2 j and 2 j + 1 begin are eliminated two at a time, from both ends of the beam
/// to the middle, where the last two lanes meet. Two lanes have been eliminated up to there.
template <int lanes, bool cayley>
typename Sweep<lanes, cayley>::Found Sweep<lanes, cayley>::meet(const Front<V>& front,
                                                                const Squares<V>& lane_squares,
                                                                const V& largest) {
  constexpr int middle = lanes / 2;
  Squares<double> squares;
  add_totals<lanes>(lane_squares, squares);
  const Table<lanes, 9> last(front.diagonal);
  const Table<lanes, 3> right(front.right), force(front.force), inertia(front.inertia);
  Block<Pair> G[middle], diagonal = last.block(middle - 1);
  Triple<Pair> z[middle], reduced = right.triple(middle - 1);
  if constexpr (between_cuts) {
    const Table<lanes, 9> first(front.first), to_first(front.to_first), from_first(front.from_first);
    const Table<lanes, 3> first_right(front.first_right), first_force(first_.force),
        first_inertia(first_.inertia);
    Squares<Pair> pair_squares;
    const double* external = arrays_.external;
    for (int j = 0; j < middle; ++j) {
      Block<Pair> own = first.block(j), upper = from_first.block(j), lower = to_first.block(j);
      Triple<Pair> own_right = first_right.triple(j), own_force = first_force.triple(j),
                   own_inertia = first_inertia.triple(j), own_external;
      for (int k = 0; k < 3; ++k)
        own_external.at[k] = Pair(external + lanes * k + 2 * j, stdx::vector_aligned);
      if (j == 0) {
        Triple<Pair> free;
        for (int k = 0; k < 3; ++k) {
          alignas(16) const double both[2] = {beam_.held[0][k] ? 0.0 : 1.0, beam_.held[1][k] ? 0.0 : 1.0};
          free.at[k] = Pair(both, stdx::vector_aligned);
          own_right.at[k] *= free.at[k];
          own_force.at[k] *= free.at[k];
          own_inertia.at[k] *= free.at[k];
          own_external.at[k] *= free.at[k];
        }
        hold(free, own, upper, lower);
      } else {
        add(own, last.block(j - 1));
        add(own, diagonal);
        add(own_right, right.triple(j - 1));
        add(own_right, reduced);
        add(own_force, force.triple(j - 1));
        add(own_inertia, inertia.triple(j - 1));
      }
      add(own_right, pair_squares.add(own_inertia, own_force, own_external, arm_));
      const Block<Pair> inner = inverse(own);
      G[j] = product(inner, upper);
      z[j] = product(inner, own_right);
      diagonal = product(lower, G[j]);
      negate(diagonal);
      reduced = {{0.0, 0.0, 0.0}};
      subtract_product(reduced, lower, z[j]);
    }
    add_totals<2>(pair_squares, squares);
    add(diagonal, last.block(middle - 1));
    add(reduced, right.triple(middle - 1));
  }
  Numbers own_external;
  const double* external = arrays_.external + lanes * node_components * layout_.rows() + lanes - 2;
  for (int k = 0; k < 3; ++k) own_external.at[k] = external[lanes * k];
  Numbers own_right = sum_of(reduced);
  add(own_right,
      squares.add(sum_of(inertia.triple(middle - 1)), sum_of(force.triple(middle - 1)), own_external, arm_));
  const Numbers x = product(inverse(sum_of(diagonal)), own_right);
  Triple<Pair> both;
  alignas(64) double cuts[3][lanes + 2];
  for (int k = 0; k < 3; ++k) {
    both.at[k] = x.at[k];
    both.at[k].copy_to(cuts[k] + lanes, stdx::vector_aligned);
  }
  if constexpr (between_cuts)
    for (int j = middle - 1; j >= 0; --j) {
      Triple<Pair> next = z[j];
      subtract_product(next, G[j], both);
      both = next;
      for (int k = 0; k < 3; ++k) both.at[k].copy_to(cuts[k] + 2 * j, stdx::vector_aligned);
    }
  for (int k = 0; k < 3; ++k) {
    if constexpr (between_cuts) cut_left_.at[k] = V(cuts[k], stdx::element_aligned);
    cut_right_.at[k] = V(cuts[k] + 2, stdx::element_aligned);
  }
  double most = squares.inertia > squares.internal ? squares.inertia : squares.internal;
  most = squares.external > most ? squares.external : most;
  return {__builtin_sqrt(squares.total), __builtin_sqrt(most), hmax(largest)};
}

}  // namespace
}  // namespace gnomon::beam::linear
