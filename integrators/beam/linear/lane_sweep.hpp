#pragma once
// Newton's correction in lanes: elements, elimination of their nodes, back substitution, in two sweeps.
// Compiled once for each instruction set, see lane_step.hpp.

#include "integrators/beam/linear/lane_element.hpp"

namespace gnomon::beam::linear {
namespace {

/// Squares of the norms of the residual and of its parts; of moments divided by the length of the beam.
template <class Number>
struct Squares {
  Number inertia = 0.0, internal = 0.0, external = 0.0, total = 0.0;

  /// Returns the residual with its sign changed.
  [[gnu::always_inline]] Triple<Number> add(const Triple<Number>& a, const Triple<Number>& f,
                                            const Triple<Number>& p, double arm) {
    Triple<Number> r;
    for (int k = 0; k < 3; ++k) r.at[k] = p.at[k] - (a.at[k] + f.at[k]);
    const auto square = [&](const Triple<Number>& x) {
      return (x.at[0] * x.at[0] + x.at[1] * x.at[1]) + arm * (x.at[2] * x.at[2]);
    };
    inertia += square(a);
    internal += square(f);
    external += square(p);
    total += square(r);
    return r;
  }
};

/// What has been eliminated up to a node: its block and right-hand side, without the elements behind it, and
/// the parts of the residual that the element before it gives. Between cuts also the node's blocks with the
/// lane's first node, and that node's own.
template <class V>
struct Front {
  Block<V> diagonal;
  Triple<V> right, force, inertia;
  Block<V> to_first, from_first, first;
  Triple<V> first_right;
};
template <class V>
struct FirstNode {
  Triple<V> force, inertia;
};

template <int lanes, bool cayley>
class Sweep {
 public:
  /// Two lanes meet in the middle; of more, all but the first node of each is eliminated at first.
  static constexpr bool between_cuts = lanes > 2;
  using V = Lanes<lanes>;
  using Numbers = Triple<double>;

  Sweep(const Beam& beam, const Layout& layout, const Arrays& arrays, double h)
      : beam_(beam), layout_(layout), arrays_(arrays), step_(beam, h, direction()) {
    reach_ = beam.length * beam.length;
    arm_ = 1.0 / reach_;
    alignas(64) double longer[lanes];
    for (int l = 0; l < lanes; ++l) longer[l] = l < layout.extra ? 1.0 : 0.0;
    longer_ = load(longer);
    if constexpr (!between_cuts) {
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < lanes; ++l) longer[l] = beam.held[l][k] ? 0.0 : 1.0;
        free_.at[k] = load(longer);
      }
    }
  }

  /// Assembles at the present mean velocities and solves for the correction; `apply` adds it.
  struct Found {
    double size, scale, largest;
  };
  [[gnu::always_inline]] Found eliminate() {
    Squares<V> squares;
    V largest = 0.0;
    Front<V> front;
    const int full = layout_.full;
    last_ = node(arrays_.mean, 0);
    last_change_ = change(0, last_);
    start(front, squares, largest);
    for (int i = 1; i < full; ++i) advance(front, squares, largest, i);
    if (layout_.extra > 0) {
      const Front<V> shorter = front;
      const Squares<V> before = squares;
      const V largest_before = largest;
      advance(front, squares, largest, full);
      const auto mask = longer_ == 0.0;
      choose(mask, shorter, front);
      where(mask, squares.inertia) = before.inertia;
      where(mask, squares.internal) = before.internal;
      where(mask, squares.external) = before.external;
      where(mask, squares.total) = before.total;
      where(mask, largest) = largest_before;
      forget(mask, full);
    }
    return meet(front, squares, largest);
  }

  /// Adds the correction to the mean velocities: x_i = z_i - G_i x_{i+1} - S_i x_0. Returns the square of its
  /// size, rotations times the length of the beam.
  [[gnu::always_inline]] double apply() {
    const int rows = layout_.rows();
    Triple<V> x = cut_right_;
    V size = add_to_mean(rows, x);
    for (int i = rows - 1; i >= (between_cuts ? 1 : 0); --i) {
      const double* at = block(i);
      Triple<V> next;
      for (int k = 0; k < 3; ++k) {
        const double* G = at + lanes * 3 * k;
        next.at[k] = load(at + lanes * (18 + k)) -
                     ((load(G) * x.at[0] + load(G + lanes) * x.at[1]) + load(G + 2 * lanes) * x.at[2]);
        if constexpr (between_cuts) {
          const double* S = G + lanes * 9;
          next.at[k] -= (load(S) * cut_left_.at[0] + load(S + lanes) * cut_left_.at[1]) +
                        load(S + 2 * lanes) * cut_left_.at[2];
        }
      }
      x = next;
      size += add_to_mean(i, x);
    }
    if constexpr (between_cuts) size += add_to_mean(0, cut_left_);
    return reduce(size);
  }

  static V load(const double* values) { return V(values, stdx::vector_aligned); }
  static Triple<V> node(const double* values, int i) {
    const double* at = values + lanes * node_components * i;
    return {{load(at), load(at + lanes), load(at + 2 * lanes)}};
  }
  static void put(const Triple<V>& x, double* values, int i) {
    for (int k = 0; k < 3; ++k)
      x.at[k].copy_to(values + lanes * (node_components * i + k), stdx::vector_aligned);
  }
  const StepConstants<V>& constants() const { return step_; }

 private:
  static V direction() {
    alignas(64) double sign[lanes];
    for (int l = 0; l < lanes; ++l) sign[l] = l % 2 == 1 ? -1.0 : 1.0;
    return load(sign);
  }
  double* block(int i) const { return arrays_.blocks + lanes * block_components * i; }
  [[gnu::always_inline]] Triple<V> change(int i, const Triple<V>& mean) const {
    const Triple<V> before = node(arrays_.v, i);
    return {{mean.at[0] - before.at[0], mean.at[1] - before.at[1], mean.at[2] - before.at[2]}};
  }
  [[gnu::always_inline]] V add_to_mean(int i, const Triple<V>& x) {
    Triple<V> mean = node(arrays_.mean, i);
    for (int k = 0; k < 3; ++k) mean.at[k] += x.at[k];
    put(mean, arrays_.mean, i);
    return (x.at[0] * x.at[0] + x.at[1] * x.at[1]) + reach_ * (x.at[2] * x.at[2]);
  }
  [[gnu::always_inline]] ElementTerms<V> element(int i, V& largest) {
    V now[element_components];
    const double* at = arrays_.elements + lanes * element_components * i;
    for (int k = 0; k < element_components; ++k) now[k] = load(at + lanes * k);
    const Triple<V> mean = node(arrays_.mean, i + 1), next_change = change(i + 1, mean);
    const ElementTerms<V> terms =
        element_terms<V, cayley>(step_, now, last_, mean, last_change_, next_change, largest);
    last_ = mean;
    last_change_ = next_change;
    return terms;
  }
  static void set_residual(Front<V>& front, const ElementTerms<V>& terms) {
    front.force = terms.force[1];
    front.inertia = terms.inertia[1];
  }

  /// The first element of each lane.
  [[gnu::always_inline]] void start(Front<V>& front, Squares<V>& squares, V& largest) {
    const ElementTerms<V> terms = element(0, largest);
    if constexpr (!between_cuts) {
      Triple<V> force, inertia, external = node(arrays_.external, 0);
      for (int k = 0; k < 3; ++k) {
        force.at[k] = terms.force[0].at[k] * free_.at[k];
        inertia.at[k] = terms.inertia[0].at[k] * free_.at[k];
        external.at[k] *= free_.at[k];
      }
      const Triple<V> right = squares.add(inertia, force, external, arm_);
      Block<V> diagonal = terms.block(-1, -1), upper = terms.block(-1, 1), lower = terms.block(1, -1);
      hold(free_, diagonal, upper, lower);
      const Block<V> inner = inverse(diagonal);
      const Block<V> G = product(inner, upper);
      const Triple<V> z = product(inner, right);
      keep(0, G, z);
      front.diagonal = terms.block(1, 1);
      subtract_product(front.diagonal, lower, G);
      front.right = {{0.0, 0.0, 0.0}};
      subtract_product(front.right, lower, z);
    } else {
      front.first = terms.block(-1, -1);
      front.from_first = terms.block(-1, 1);
      front.to_first = terms.block(1, -1);
      front.diagonal = terms.block(1, 1);
      front.right = front.first_right = {{0.0, 0.0, 0.0}};
      first_ = {terms.force[0], terms.inertia[0]};
    }
    set_residual(front, terms);
  }

  /// Adds element i and eliminates node i, its first one.
  [[gnu::always_inline]] void advance(Front<V>& front, Squares<V>& squares, V& largest, int i) {
    const ElementTerms<V> terms = element(i, largest);
    for (int k = 0; k < 3; ++k) {
      front.force.at[k] += terms.force[0].at[k];
      front.inertia.at[k] += terms.inertia[0].at[k];
    }
    const Triple<V> own = squares.add(front.inertia, front.force, node(arrays_.external, i), arm_);
    Block<V> diagonal = terms.block(-1, -1);
    Triple<V> right;
    for (int k = 0; k < 3; ++k) {
      right.at[k] = front.right.at[k] + own.at[k];
      for (int j = 0; j < 3; ++j) diagonal.at[k][j] += front.diagonal.at[k][j];
    }
    const Block<V> inner = inverse(diagonal), lower = terms.block(1, -1);
    const Block<V> G = product(inner, terms.block(-1, 1));
    const Triple<V> z = product(inner, right);
    keep(i, G, z);
    front.diagonal = terms.block(1, 1);
    subtract_product(front.diagonal, lower, G);
    front.right = {{0.0, 0.0, 0.0}};
    subtract_product(front.right, lower, z);
    if constexpr (between_cuts) {
      const Block<V> S = product(inner, front.to_first);
      for (int k = 0; k < 9; ++k)
        S.at[k / 3][k % 3].copy_to(block(i) + lanes * (9 + k), stdx::vector_aligned);
      subtract_product(front.first, front.from_first, S);
      subtract_product(front.first_right, front.from_first, z);
      front.to_first = product(lower, S);
      negate(front.to_first);
      front.from_first = product(front.from_first, G);
      negate(front.from_first);
    }
    set_residual(front, terms);
  }
  [[gnu::always_inline]] void keep(int i, const Block<V>& G, const Triple<V>& z) {
    double* at = block(i);
    for (int k = 0; k < 9; ++k) G.at[k / 3][k % 3].copy_to(at + lanes * k, stdx::vector_aligned);
    for (int k = 0; k < 3; ++k) z.at[k].copy_to(at + lanes * (18 + k), stdx::vector_aligned);
  }

  template <class Mask>
  static void choose(const Mask& mask, const Block<V>& from, Block<V>& to) {
    for (int k = 0; k < 9; ++k) where(mask, to.at[k / 3][k % 3]) = from.at[k / 3][k % 3];
  }
  template <class Mask>
  static void choose(const Mask& mask, const Triple<V>& from, Triple<V>& to) {
    for (int k = 0; k < 3; ++k) where(mask, to.at[k]) = from.at[k];
  }
  template <class Mask>
  static void choose(const Mask& mask, const Front<V>& from, Front<V>& to) {
    choose(mask, from.diagonal, to.diagonal);
    choose(mask, from.right, to.right);
    choose(mask, from.force, to.force);
    choose(mask, from.inertia, to.inertia);
    if constexpr (between_cuts) {
      choose(mask, from.to_first, to.to_first);
      choose(mask, from.from_first, to.from_first);
      choose(mask, from.first, to.first);
      choose(mask, from.first_right, to.first_right);
    }
  }
  /// In shorter lanes local node i is the last one: x_i = x_{i+1}.
  template <class Mask>
  void forget(const Mask& mask, int i) {
    double* at = block(i);
    for (int k = 0; k < block_components; ++k) {
      V value = load(at + lanes * k);
      where(mask, value) = k == 0 || k == 4 || k == 8 ? -1.0 : 0.0;
      value.copy_to(at + lanes * k, stdx::vector_aligned);
    }
  }

  Found meet(const Front<V>& front, const Squares<V>& squares, const V& largest);

  const Beam& beam_;
  const Layout& layout_;
  const Arrays& arrays_;
  StepConstants<V> step_;
  double reach_, arm_;
  V longer_;
  Triple<V> free_, last_, last_change_;
  FirstNode<V> first_;
  Triple<V> cut_left_, cut_right_;
};

}  // namespace
}  // namespace gnomon::beam::linear
