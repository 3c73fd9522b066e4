#include "integrators/beam/linear/chain.hpp"

#include <algorithm>
#include <cstring>

namespace gnomon::beam::linear {
namespace {

/// Steps for which the better start of Newton's iteration is not looked for anew.
constexpr int patience = 16;

Layout layout_of(int elements, int lanes) { return {lanes, elements / lanes, elements % lanes}; }

}  // namespace

Chain::Chain(const Beam& beam, const Kernels& kernels, const std::vector<double>& strain_offsets)
    : beam_(beam), layout_(layout_of(beam.elements, kernels.lanes)), kernels_(&kernels) {
  const int rows = layout_.rows();
  for (Numbers* nodal : {&u_, &v_, &external_, &past_[0], &past_[1], &past_[2]})
    *nodal = room(node_components, rows + 1);
  elements_ = room(element_components, rows);
  blocks_ = room(block_components, rows);
  nodal_external_.resize(3 * static_cast<std::size_t>(beam.elements + 1));
  for (int i = 0; i < rows; ++i)
    for (int l = 0; l < layout_.lanes; ++l) {
      double* values = at(elements_) + layout_.lanes * element_components * i + l;
      if (i >= layout_.count(l)) {  // nothing depends on it, but it is to be computed with
        values[0] = values[2 * layout_.lanes] = 1.0;
        continue;
      }
      const int e = layout_.element(l, i);
      values[7 * layout_.lanes] = 2.0 * strain_offsets[2 * e];
      values[8 * layout_.lanes] = 2.0 * strain_offsets[2 * e + 1];
    }
}

Chain::Numbers Chain::room(int components, int count) const {
  return Numbers((static_cast<std::size_t>(components) * count * layout_.lanes + 7) / 8, Line{});
}

void Chain::spread(const double* nodal, Numbers& to) const {
  for (int l = 0; l < layout_.lanes; ++l)
    for (int i = 0; i <= layout_.rows(); ++i) {
      const double* from = nodal + 3 * layout_.node(l, i);
      for (int k = 0; k < 3; ++k) at(to)[layout_.lanes * (node_components * i + k) + l] = from[k];
    }
}
void Chain::collect(const Numbers& from, double* nodal) const {
  for (int l = 0; l < layout_.lanes; ++l)
    for (int i = 0; i <= layout_.rows(); ++i) {
      double* to = nodal + 3 * layout_.node(l, i);
      for (int k = 0; k < 3; ++k) to[k] = at(from)[layout_.lanes * (node_components * i + k) + l];
    }
}

void Chain::take(const Nodal& state) {
  spread(state.u, u_);
  spread(state.v, v_);
  for (int k = 0; k < 3; ++k) spread(state.past[k], past_[k]);
  known_ = state.known;
  past_step_ = state.past_step;
  for (int l = 0; l < layout_.lanes; ++l)
    for (int i = 0; i < layout_.count(l); ++i) {
      const PointHistory& h = state.history[layout_.element(l, i)];
      const double values[7] = {h.d1, h.d2, h.c, h.s, h.g1, h.g2, h.bending};
      for (int k = 0; k < 7; ++k) at(elements_)[layout_.lanes * (element_components * i + k) + l] = values[k];
    }
}
void Chain::give(double* u, double* v, PointHistory* history) const {
  collect(u_, u);
  collect(v_, v);
  for (int l = 0; l < layout_.lanes; ++l)
    for (int i = 0; i < layout_.count(l); ++i) {
      const double* values = at(elements_) + layout_.lanes * element_components * i + l;
      const auto value = [&](int k) { return values[layout_.lanes * k]; };
      history[layout_.element(l, i)] = {value(0), value(1), value(2), value(3), value(4), value(5), value(6)};
    }
}
void Chain::give_past(double* const past[3]) const {
  for (int k = 0; k < 3; ++k) collect(past_[k], past[k]);
}

void Chain::set(Numbers& numbers, int unknown, double value) {
  at(numbers)[layout_.lanes * (unknown % 3) + unknown / 3] = value;
}

bool Chain::step(bool cayley, double h, const double* external, const double (&imposed)[2][3]) {
  if (std::memcmp(external, nodal_external_.data(), nodal_external_.size() * sizeof(double)) != 0) {
    std::copy_n(external, nodal_external_.size(), nodal_external_.begin());
    spread(external, external_);
  }
  const int known = h == past_step_ ? known_ : 0;
  Start start = known == 3 ? Start::parabola : known == 2 ? Start::line : Start::velocity;
  // Where the constant has been the better start lately, the other is tried only now and then.
  if (known >= 2 && constant_ > 0) {
    --constant_;
    start = Start::constant;
  }
  StepInput input{h, start, trusted_ == 0, {}, curvature_};
  for (int end = 0; end < 2; ++end)
    for (int k = 0; k < 3; ++k) input.imposed[end][k] = imposed[end][k];
  // The mean velocity takes the place of the oldest one.
  const Arrays arrays{at(u_),       at(v_),        at(past_[2]),  at(past_[0]), at(past_[1]),
                      at(past_[2]), at(external_), at(elements_), at(blocks_)};
  const StepResult result = (cayley ? kernels_->cayley : kernels_->documented)(beam_, layout_, arrays, input);
  evaluations += result.evaluations;
  iterations += result.iterations;
  if (!result.solved) {
    known_ = std::min(known_, 2);
    curvature_ = -1.0;
    return false;
  }
  curvature_ = result.curvature;
  trusted_ = trusted_ > 0 ? trusted_ - 1 : 0;
  if (result.constant_better) constant_ = patience;
  if (result.constant_worse) trusted_ = patience;
  past_[2].swap(past_[1]);
  past_[1].swap(past_[0]);
  // now past_[0] is where the mean velocity was put
  known_ = h == past_step_ ? std::min(known_ + 1, 3) : 1;
  past_step_ = h;
  return true;
}

}  // namespace gnomon::beam::linear
