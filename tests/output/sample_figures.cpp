#include "tests/output/sample_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace gnomon::test {
namespace {

using namespace output;

constexpr double bound = 3e-14;

struct Scheme {
  const char* name;
  double order;
  double constant;
  double evaluations_per_step;
  double microseconds_per_evaluation;
};

constexpr std::array<Scheme, 11> sample_schemes = {{{"munjiza", 1, 3e-1, 1, 0.07},
                                                    {"munjiza-half-impulse", 2, 2e-1, 1, 0.07},
                                                    {"munjiza-stage-moments", 4, 3e-1, 4, 0.16},
                                                    {"rkmk4", 4, 5e-2, 4, 0.20},
                                                    {"cvode-adams", 5, 2.0, 1.6, 0.75},
                                                    {"cvode-bdf", 4, 8.0, 2.1, 1.0},
                                                    {"arkode-erk4", 4, 0.5, 6, 0.40},
                                                    {"arkode-erk5", 5, 0.8, 7, 0.55},
                                                    {"arkode-erk8", 8, 4.0, 13, 1.0},
                                                    {"arkode-dirk", 4, 1.0, 15, 2.4},
                                                    {"ida-bdf", 4, 15.0, 2.4, 1.8}}};

Series errors(int number, bool against_evaluations) {
  const Scheme& scheme = sample_schemes[static_cast<std::size_t>(number)];
  std::mt19937 generator(static_cast<unsigned>(number));
  Series series;
  series.label = scheme.name;
  series.style = number;
  double growth = scheme.order > 6.0 ? 0.55 : 0.75;
  if (scheme.order < 3.0) growth = 1.05;
  for (int k = 0; k < 14; ++k) {
    const double steps = 20.0 * std::pow(2.0, growth * k);
    const double noise = 0.9 + 0.2 * static_cast<double>(generator()) / 4294967296.0;
    const double error = scheme.constant * std::pow(10.0 / steps, scheme.order) * noise;
    if (error > 0.3) continue;
    const double evaluations = steps * scheme.evaluations_per_step;
    series.x.push_back(against_evaluations ? evaluations : evaluations * scheme.microseconds_per_evaluation);
    series.y.push_back(std::max(error, bound));
    series.hollow.push_back(error <= bound);
    if (error <= bound) break;
  }
  return series;
}

Panel error_panel(bool against_evaluations) {
  Panel panel;
  panel.x_label = against_evaluations ? "evaluations of the right-hand side" : "CPU time [µs]";
  panel.y_label = "orientation error at t = 10 s [rad]";
  panel.reference_lines = {{bound, "reference’s error bound"}};
  for (int number = 0; number < static_cast<int>(sample_schemes.size()); ++number) {
    panel.series.push_back(errors(number, against_evaluations));
  }
  return panel;
}

}  // namespace

Figure work_precision() {
  Figure figure;
  figure.title = "free top: work–precision";
  figure.caption = "Error against CPU time";
  figure.hollow_note = "hollow: at or below the reference’s error bound";
  figure.panels = {error_panel(false)};
  figure.panels.front().series.push_back({"exact-free-top", {14.0}, {1.3e-15}, {}, 11});
  return figure;
}

Figure work_precision_in_two_panels() {
  Figure figure = work_precision();
  figure.panels.push_back(error_panel(true));
  figure.panels.back().guides = {{-1.0, "order 1"}, {-2.0, "order 2"}, {-4.0, "order 4"}};
  return figure;
}

Figure convergence() {
  Figure figure;
  figure.title = "free top: convergence";
  figure.hollow_note = "hollow: at or below the reference’s error bound";
  Panel panel;
  panel.x_label = "step h [s]";
  panel.y_label = "orientation error [rad]";
  panel.reference_lines = {{2e-13, "reference’s error bound"}};
  panel.guides = {{1.0, "order 1"}, {2.0, "order 2"}, {4.0, "order 4"}};
  for (int number = 0; number < 4; ++number) {
    const Scheme& scheme = sample_schemes[static_cast<std::size_t>(number)];
    Series series = {scheme.name, {}, {}, {}, number};
    for (int k = 0; k < 12; ++k) {
      const double h = 0.1 * std::pow(2.0, -0.75 * k);
      const double error = scheme.constant * std::pow(h, scheme.order);
      series.x.push_back(h);
      series.y.push_back(std::max(error, 2e-13));
      series.hollow.push_back(error <= 2e-13);
    }
    panel.series.push_back(series);
  }
  figure.panels = {panel};
  return figure;
}

Figure drift() {
  Figure figure;
  figure.title = "heavy top: energy over a long run";
  Panel panel;
  panel.x_label = "time t [s]";
  panel.y_label = "|energy error| / energy scale";
  panel.guides = {{1.0, "∝ t"}, {0.5, "∝ √t"}};
  const double oscillation[] = {2e-3, 4e-5, 3e-7, 1e-9, 1e-6, 2e-8, 1e-10};
  const double slope[] = {1e-4, 0.0, 0.0, 0.0, 3e-8, 1e-8, 1e-11};
  for (int number = 0; number < 7; ++number) {
    std::mt19937 generator(static_cast<unsigned>(number));
    Series series = {sample_schemes[static_cast<std::size_t>(number)].name, {}, {}, {}, number};
    for (int k = 0; k < 200; ++k) {
      const double t = 0.1 * std::pow(10.0, 5.0 * k / 199.0);
      const double noise = 0.3 + 0.7 * static_cast<double>(generator()) / 4294967296.0;
      series.x.push_back(t);
      series.y.push_back(oscillation[number] * noise * std::min(1.0, t) + slope[number] * t);
    }
    panel.series.push_back(series);
  }
  figure.panels = {panel};
  return figure;
}

}  // namespace gnomon::test
