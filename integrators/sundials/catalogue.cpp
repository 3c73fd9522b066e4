#include "integrators/catalogue.hpp"
#include "integrators/sundials/schemes.hpp"
#include "models/catalogue.hpp"

namespace gnomon {

void add_sundials_schemes(Catalogue& catalogue) {
  using namespace sundials;
  using Schemes = TypeList<CvodeAdams, CvodeBdf, ArkodeErk4, ArkodeErk5, ArkodeErk8, ArkodeDirk, IdaBdf, IdaBdfIndex2>;
  add_schemes<Models>(catalogue, Schemes{});
}

}  // namespace gnomon
