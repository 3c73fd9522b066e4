#include "models/planar_beam/element_chain.hpp"

#include <utility>

namespace gnomon::planar_beam {

template <int p>
ElementChain<p>::ElementChain(int elements, std::vector<int> held)
    : ends_(elements + 1), inside_(p > 1 ? elements : 0), held_(std::move(held)) {}

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
    const Eigen::Matrix<double, 6, 6> gone = in.from_inner * in.follow;
    Eigen::Matrix<double, 6, 6> ends;
    ends << K.template topLeftCorner<3, 3>(), K.template topRightCorner<3, 3>(),
        K.template bottomLeftCorner<3, 3>(), K.template bottomRightCorner<3, 3>();
    add_ends(e, ends - gone);
  }
}

template <int p>
void ElementChain<p>::factorise() {
  for (int i : held_) ends_.hold(i / (3 * p), i % 3);
  ends_.factorise();
}

template <int p>
void ElementChain<p>::solve(double* values) const {
  if constexpr (p == 1) {
    for (int i : held_) values[i] = 0.0;
    ends_.solve(values, 3);
  } else {
    using Inner = Eigen::Matrix<double, inner, 1>;
    using Ends = Eigen::Matrix<double, 6, 1>;
    const int count = static_cast<int>(inside_.size());
    for (int e = 0; e < count; ++e) {
      Eigen::Map<Inner> middle(values + 3 * p * e + 3);
      middle = Inner(inside_[e].lu.solve(middle));
      const Ends moved = inside_[e].from_inner * middle;
      for (int k = 0; k < 3; ++k) {
        values[3 * p * e + k] -= moved[k];
        values[3 * p * (e + 1) + k] -= moved[3 + k];
      }
    }
    for (int i : held_) values[i] = 0.0;
    ends_.solve(values, 3 * p);
    for (int e = 0; e < count; ++e) {
      Ends ends;
      for (int k = 0; k < 3; ++k) {
        ends[k] = values[3 * p * e + k];
        ends[3 + k] = values[3 * p * (e + 1) + k];
      }
      Eigen::Map<Inner> middle(values + 3 * p * e + 3);
      middle -= inside_[e].follow * ends;
    }
  }
}

template <int p>
void ElementChain<p>::add_ends(int e, const Eigen::Matrix<double, 6, 6>& K) {
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
