#pragma once
#include "src/catalogue.hpp"

namespace gnomon::rigid_body {

/// Controlled steppers of Boost.odeint on the free body and the heavy top, compiled for the widest registers
/// that this machine has.
void add_peers(Catalogue& catalogue);

}  // namespace gnomon::rigid_body
