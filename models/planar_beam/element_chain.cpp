#include "models/planar_beam/element_chain.hpp"

#include <utility>

namespace gnomon::planar_beam {

template <int p>
ElementChain<p>::ElementChain(int elements, std::vector<int> held, std::vector<int> hinged)
    : numbering_(p, elements, std::move(hinged)),
      ends_(elements + 1),
      inside_(p > 1 ? elements : 0),
      held_(std::move(held)),
      hinges_(numbering_.hinged().size()) {
  if (hinges_.empty()) return;
  hinge_after_.assign(static_cast<std::size_t>(elements), -1);
  for (std::size_t k = 0; k < hinges_.size(); ++k)
    hinge_after_[numbering_.hinged()[k] - 1] = static_cast<int>(k);
}

template <int p>
void ElementChain<p>::set_spring(int k, double by_left, double by_right) {
  hinges_[k].by_left = by_left;
  hinges_[k].by_right = by_right;
}

template <int p>
void ElementChain<p>::add(int e, const Matrix& K) {
  if constexpr (p == 1) {
    add_ends(e, K);
  } else {
    Inside& in = inside_[e];
    in.lu.compute(K.template block<inner, inner>(3, 3));
    in.from_inner.template topRows<3>() = K.template block<3, inner>(0, 3);
    in.from_inner.template bottomRows<3>() = K.template block<3, inner>(3 * p, 3);
    Eigen::Matrix<double, inner, 6> to_inner;
    to_inner.template leftCols<3>() = K.template block<inner, 3>(3, 0);
    to_inner.template rightCols<3>() = K.template block<inner, 3>(3, 3 * p);
    in.follow = in.lu.solve(to_inner);
    const EndMatrix gone = in.from_inner * in.follow;
    EndMatrix ends;
    ends << K.template topLeftCorner<3, 3>(), K.template topRightCorner<3, 3>(),
        K.template bottomLeftCorner<3, 3>(), K.template bottomRightCorner<3, 3>();
    add_ends(e, ends - gone);
  }
}

template <int p>
void ElementChain<p>::factorise() {
  for (int i : held_) ends_.hold(i < 3 ? 0 : ends_.size() - 1, i % 3);
  ends_.factorise();
}

template <int p>
void ElementChain<p>::solve(double* values) const {
  if (!hinges_.empty()) {
    solve_hinged(values);
    return;
  }
  reduce_inner(values);
  for (int i : held_) values[i] = 0.0;
  ends_.solve(values, 3 * p);
  recover_inner(values);
}

template <int p>
void ElementChain<p>::reduce_inner(double* values) const {
  if constexpr (p > 1) {
    using Inner = Eigen::Matrix<double, inner, 1>;
    const int count = static_cast<int>(inside_.size());
    for (int e = 0; e < count; ++e) {
      double *first = values + numbering_.first(e), *last = first + 3 * p;
      Eigen::Map<Inner> middle(first + 3);
      middle = Inner(inside_[e].lu.solve(middle));
      const Ends moved = inside_[e].from_inner * middle;
      for (int k = 0; k < 3; ++k) {
        first[k] -= moved[k];
        last[k] -= moved[3 + k];
      }
    }
  }
}

template <int p>
void ElementChain<p>::recover_inner(double* values) const {
  if constexpr (p > 1) {
    using Inner = Eigen::Matrix<double, inner, 1>;
    const int count = static_cast<int>(inside_.size());
    for (int e = 0; e < count; ++e) {
      double *first = values + numbering_.first(e), *last = first + 3 * p;
      Ends ends;
      for (int k = 0; k < 3; ++k) {
        ends[k] = first[k];
        ends[3 + k] = last[k];
      }
      Eigen::Map<Inner> middle(first + 3);
      middle -= inside_[e].follow * ends;
    }
  }
}

template <int p>
void ElementChain<p>::solve_hinged(double* values) const {
  reduce_inner(values);
  numbering_.join(values);
  const int hinges = static_cast<int>(hinges_.size());
  for (int h = 0; h < hinges; ++h) {
    const Hinge& hinge = hinges_[h];
    double& left = values[numbering_.left_rotation(h)];
    double* before = values + numbering_.first(numbering_.hinged()[h] - 1);
    double* after = values + numbering_.first(numbering_.hinged()[h]);
    left *= hinge.inverse;
    for (int k = 0; k < 3; ++k) {
      before[k] -= hinge.column[k] * left;
      after[k] -= hinge.column[3 + k] * left;
    }
  }
  for (int i : held_) values[i] = 0.0;
  ends_.solve_at(values, [this](int i) { return numbering_.first(i); });
  for (int h = 0; h < hinges; ++h) {
    const Hinge& hinge = hinges_[h];
    const double* before = values + numbering_.first(numbering_.hinged()[h] - 1);
    const double* after = values + numbering_.first(numbering_.hinged()[h]);
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += hinge.row[k] * before[k] + hinge.row[3 + k] * after[k];
    values[numbering_.left_rotation(h)] -= hinge.inverse * sum;
  }
  numbering_.spread(values);
  recover_inner(values);
}

template <int p>
typename ElementChain<p>::EndMatrix ElementChain<p>::released(Hinge& hinge, const EndMatrix& K) const {
  hinge.inverse = 1.0 / (K(5, 5) - hinge.by_left);
  hinge.row = K.row(5).transpose();
  hinge.column = K.col(5);
  hinge.row[5] = -hinge.by_right;
  hinge.column[5] = hinge.by_left;
  EndMatrix rest = K;
  rest.row(5).setZero();
  rest.col(5).setZero();
  rest(5, 5) = hinge.by_right;
  rest -= hinge.column * (hinge.inverse * hinge.row).transpose();
  return rest;
}

template <int p>
void ElementChain<p>::add_ends(int e, const EndMatrix& K) {
  if (!hinge_after_.empty() && hinge_after_[e] >= 0)
    place(e, released(hinges_[hinge_after_[e]], K));
  else
    place(e, K);
}

template <int p>
void ElementChain<p>::place(int e, const EndMatrix& K) {
  BlockTridiagonal::Row &here = ends_.rows[e], &next = ends_.rows[e + 1];
  if (e == 0)
    here.diagonal = K.template topLeftCorner<3, 3>();
  else
    here.diagonal += K.template topLeftCorner<3, 3>();
  here.upper = K.template topRightCorner<3, 3>();
  next.lower = K.template bottomLeftCorner<3, 3>();
  next.diagonal = K.template bottomRightCorner<3, 3>();
}

template class ElementChain<1>;
template class ElementChain<2>;
template class ElementChain<3>;
template class ElementChain<4>;

}  // namespace gnomon::planar_beam
