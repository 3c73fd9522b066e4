#pragma once
#include "integrators/rotation/buss.hpp"
#include "integrators/rotation/fincham_leapfrog.hpp"
#include "integrators/rotation/johnson_williams_cook.hpp"
#include "integrators/rotation/no_squish.hpp"
#include "integrators/rotation/omelyan.hpp"
#include "integrators/rotation/richardson.hpp"
#include "integrators/rotation/spiral.hpp"
#include "integrators/rotation/zhao_van_wachem.hpp"
#include "src/catalogue.hpp"

namespace gnomon::rotation {

/// The schemes of discrete-element and molecular codes.
using DiscreteElementSchemes =
    TypeList<FinchamLeapfrog, Omelyan, Richardson, NoSquish, Buss, BussAugmented, JohnsonWilliamsCook,
             SpiralLeapfrog, SpiralSynchronous, ZhaoVanWachem>;

void add_discrete_element_schemes(Catalogue& catalogue);

}  // namespace gnomon::rotation
