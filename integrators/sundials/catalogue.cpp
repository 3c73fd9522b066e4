#include "integrators/catalogue.hpp"
#include "integrators/sundials/schemes.hpp"
#include "integrators/sundials/session.hpp"
#include "models/catalogue.hpp"

#include <SuiteSparse_config.h>
#include <fmt/format.h>

namespace gnomon {

void add_sundials_schemes(Catalogue& catalogue) {
  using namespace sundials;
  using Schemes = TypeList<CvodeAdams, CvodeBdf, CvodeBdfGmres, ArkodeErk4, ArkodeErk5, ArkodeErk8,
                           ArkodeDirk, IdaBdf, IdaBdfConstraints, IdaBdfIndex2, IdaBdfIndex3>;
  add_schemes<Models>(catalogue, Schemes{});
  catalogue.reference_solvers.push_back({CvodeBdf::info.name, 1e-11, 1e-10, 0.15});
  catalogue.reference_solvers.push_back({ArkodeDirk::info.name, 1e-9, 1e-8, 0.65});
  const std::string suitesparse =
      fmt::format("{}.{}.{}", SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION, SUITESPARSE_SUBSUB_VERSION);
  catalogue.libraries.push_back({"sundials", SUNDIALS_VERSION, optimised(), build_record()});
  catalogue.libraries.push_back({"suitesparse", suitesparse, std::nullopt, ""});
}

}  // namespace gnomon
