#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "models/planar_beam/data.hpp"
#include "models/planar_beam/numbering.hpp"

namespace gnomon::planar_beam {

/// (ux, uz, phi, vx, vz, Omega) at places from 0 to 1 along the beam, by the shape functions of its elements
/// of order p.
template <int p>
std::vector<double> field(const State& state, const Numbering& numbering, const std::vector<double>& places) {
  const int elements = numbering.elements();
  std::vector<double> values;
  values.reserve(6 * places.size());
  for (double place : places) {
    const int e = std::clamp(static_cast<int>(place * elements), 0, elements - 1);
    const double x = p * (place * elements - e);
    double sum[6] = {0, 0, 0, 0, 0, 0};
    for (int a = 0; a <= p; ++a) {
      double shape = 1.0;
      for (int b = 0; b <= p; ++b)
        if (b != a) shape *= (x - b) / (a - b);
      for (int k = 0; k < 3; ++k) {
        sum[k] += shape * state.u[numbering.first(e) + 3 * a + k];
        sum[3 + k] += shape * state.v[numbering.first(e) + 3 * a + k];
      }
    }
    values.insert(values.end(), sum, sum + 6);
  }
  return values;
}

/// Root mean squares of the differences of two such fields: displacement [m], rotation [rad], and their
/// rates.
inline std::array<double, 4> field_distance(const std::vector<double>& field,
                                            const std::vector<double>& reference) {
  std::array<double, 4> sum{};
  for (std::size_t k = 0; k < field.size(); ++k) {
    const double d = field[k] - reference[k];
    sum[(k % 6) / 3 * 2 + (k % 3 == 2 ? 1 : 0)] += d * d;
  }
  for (double& value : sum) value = std::sqrt(6.0 * value / static_cast<double>(field.size()));
  return sum;
}

}  // namespace gnomon::planar_beam
