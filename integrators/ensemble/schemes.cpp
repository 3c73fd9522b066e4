#include "integrators/ensemble/schemes.hpp"

#include <stdexcept>

namespace gnomon::ensemble {

EnsembleState start(std::size_t bodies, Scheme scheme, Load load, InstructionSet instructions, int threads) {
  const Kernels* compiled = kernels(instructions);
  if (!compiled) throw std::invalid_argument("this machine or this build lacks the instruction set");
  return {Arrays(bodies), find_step(*compiled, scheme, load), std::make_shared<Team>(threads)};
}

void step_all(EnsembleState& state, double h) {
  struct Work {
    EnsembleState& state;
    double h;
  } const work{state, h};
  state.team->run(
      [](const void* context, int part) {
        const Work& todo = *static_cast<const Work*>(context);
        todo.state.step(todo.state.arrays.range(part, todo.state.team->size()), todo.h);
      },
      &work);
}

}  // namespace gnomon::ensemble
