#pragma once
#include <cstddef>
#include <utility>
#include <vector>

namespace gnomon::planar_beam {

/// Whether forces on both sides of a hinge count as forces on the joint (Numbering::join), or are kept apart.
enum class Sides { joined, apart };

/// Numbers of the unknowns (ux, uz, phi) of a chain of elements of order p, node after node. Where an element
/// begins at a hinge, the node of the joint is there twice: once as the last of the element before, once as
/// its first. The two rotations are unknowns, the displacements of the former are tied to those of the
/// latter.
class Numbering {
 public:
  /// `hinged`: the elements that begin at a hinge, ascending, none of them the first.
  Numbering(int order, int elements, std::vector<int> hinged = {}) : hinged_(std::move(hinged)) {
    first_.reserve(static_cast<std::size_t>(elements) + 1);
    std::size_t before = 0;
    for (int e = 0; e <= elements; ++e) {
      if (before < hinged_.size() && hinged_[before] == e) {
        ++before;
        const int right = 3 * (order * e + static_cast<int>(before));
        tied_.insert(tied_.end(), {right - 3, right - 2});
      }
      first_.push_back(3 * (order * e + static_cast<int>(before)));
    }
  }

  int elements() const { return static_cast<int>(first_.size()) - 1; }
  int unknowns() const { return first_.back() + 3; }
  /// The first unknown of element e, which the others of its nodes follow; of `elements()`, that of the last
  /// node.
  int first(int e) const { return first_[e]; }
  const std::vector<int>& hinged() const { return hinged_; }
  /// The rotations on both sides of hinge k.
  int left_rotation(int k) const { return first_[hinged_[k]] - 1; }
  int right_rotation(int k) const { return first_[hinged_[k]] + 2; }
  /// The tied displacements, ascending: that of unknown i is that of unknown i + 3.
  const std::vector<int>& tied() const { return tied_; }
  /// Sets tied displacements, or their rates, to what they are tied to.
  void spread(double* values) const {
    for (int i : tied_) values[i] = values[i + 3];
  }
  /// Adds the forces on tied displacements to those on what they are tied to.
  void join(double* forces) const {
    for (int i : tied_) {
      forces[i + 3] += forces[i];
      forces[i] = 0.0;
    }
  }

 private:
  std::vector<int> hinged_, first_, tied_;
};

}  // namespace gnomon::planar_beam
