#include "models/rigid_body/peers/peers.hpp"

#include <algorithm>

#include "models/rigid_body/peers/odeint.hpp"
#include "models/rigid_body/rigid_body.hpp"
#include "src/instruction_set.hpp"

namespace gnomon::rigid_body {
namespace {

const OdeintRuns& widest_odeint() {
  const auto& sets = instruction_sets();
  const auto has = [&](InstructionSet set) { return std::find(sets.begin(), sets.end(), set) != sets.end(); };
  if (has(InstructionSet::avx512) && odeint_avx512()) return *odeint_avx512();
  if (has(InstructionSet::avx2) && odeint_avx2()) return *odeint_avx2();
  return *odeint_baseline();
}

template <class Load>
double run_odeint(PlainRun run, const void* model, double t_end, double tol, std::vector<double>& state,
                  long& evaluations) {
  const auto& body = *static_cast<const RigidBody<Load>*>(model);
  PlainBody plain{{}, {}, false};
  for (int k = 0; k < 3; ++k) plain.inverse_inertia[k] = 1.0 / body.inertia()[k];
  if constexpr (std::is_same_v<Load, Gravity>) {
    plain.heavy = true;
    for (int k = 0; k < 3; ++k) plain.weight_times_arm[k] = body.load().weight * body.load().centre[k];
  }
  double y[7];
  pack_state(body.initial(), y);
  const double seconds = run(plain, y, t_end, tol, evaluations);
  state = body.flatten(unpack_state(y));
  return seconds;
}

template <class Load>
double run_bulirsch_stoer(const void* model, double t_end, double tol, std::vector<double>& state,
                          long& evaluations) {
  return run_odeint<Load>(widest_odeint().bulirsch_stoer, model, t_end, tol, state, evaluations);
}

template <class Load>
double run_fehlberg78(const void* model, double t_end, double tol, std::vector<double>& state,
                      long& evaluations) {
  return run_odeint<Load>(widest_odeint().fehlberg78, model, t_end, tol, state, evaluations);
}

template <class Load>
void add_of_type(Catalogue& catalogue) {
  catalogue.peers.push_back({"odeint bulirsch_stoer", "Boost.odeint, order and step chosen by the tolerance",
                             typeid(RigidBody<Load>), run_bulirsch_stoer<Load>});
  catalogue.peers.push_back({"odeint fehlberg78", "Boost.odeint, controlled runge_kutta_fehlberg78",
                             typeid(RigidBody<Load>), run_fehlberg78<Load>});
}

}  // namespace

void add_peers(Catalogue& catalogue) {
  add_of_type<Free>(catalogue);
  add_of_type<Gravity>(catalogue);
}

}  // namespace gnomon::rigid_body
