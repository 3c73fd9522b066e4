#pragma once
#include "integrators/rotation/commutator_free.hpp"
#include "integrators/rotation/crouch_grossman.hpp"
#include "integrators/rotation/exact_splitting.hpp"
#include "integrators/rotation/implicit_midpoint.hpp"
#include "integrators/rotation/lie_newmark.hpp"
#include "integrators/rotation/lie_verlet.hpp"
#include "integrators/rotation/liemid_ea.hpp"
#include "integrators/rotation/moser_veselov.hpp"
#include "integrators/rotation/moser_veselov_splitting.hpp"
#include "integrators/rotation/munjiza.hpp"
#include "integrators/rotation/rk4_quaternion.hpp"
#include "integrators/rotation/simo_wong.hpp"
#include "src/catalogue.hpp"

namespace gnomon::rotation {

// Each list is compiled in a file of its own.
using MunjizaSchemes = TypeList<Munjiza, MunjizaHalfImpulse, MunjizaStageMoments, Rkmk4>;
using SplittingSchemes = TypeList<StrangExactDrift, Yoshida4ExactDrift, Suzuki4ExactDrift,
                                  BlanesMoan4ExactDrift, BlanesMoanRkn4ExactDrift>;
using HighSplittingSchemes =
    TypeList<BlanesMoanRkn6ExactDrift, KahanLi6ExactDrift, Mclachlan8ExactDrift, KahanLi8ExactDrift>;
using MoserVeselovSchemes = TypeList<Dmv2, Dmv4, Dmv6, Dmv8, Dmv10>;
using MoserVeselovSplittings = TypeList<Yoshida4Dmv10, Suzuki4Dmv10, BlanesMoan4Dmv10, BlanesMoanRkn4Dmv10>;
using HighMoserVeselovSplittings =
    TypeList<BlanesMoanRkn6Dmv10, KahanLi6Dmv10, Mclachlan8Dmv10, KahanLi8Dmv10>;
using SecondOrderSchemes = TypeList<ImplicitMidpoint, LieNewmark, LieVerlet, LiemidEa, SimoWongC1>;
using ExplicitSchemes = TypeList<CommutatorFree4, CrouchGrossman3, Rk4Quaternion>;

void add_splitting_schemes(Catalogue& catalogue);
void add_high_splitting_schemes(Catalogue& catalogue);
void add_moser_veselov_schemes(Catalogue& catalogue);
void add_moser_veselov_splittings(Catalogue& catalogue);
void add_high_moser_veselov_splittings(Catalogue& catalogue);
void add_second_order_schemes(Catalogue& catalogue);
void add_explicit_schemes(Catalogue& catalogue);
void add_lanes_schemes(Catalogue& catalogue);

}  // namespace gnomon::rotation
