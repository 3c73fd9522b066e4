#pragma once
#include <cstdio>  // SUNDIALS 6.4 needs it first

#include <arkode/arkode_butcher_dirk.h>
#include <arkode/arkode_butcher_erk.h>

#include <memory>

#include "src/ode.hpp"
#include "src/run.hpp"
#include "src/scheme.hpp"

namespace gnomon::sundials {

/// `krylov`: Newton's systems by GMRES, preconditioned by the system's own solver, which it has to have.
std::unique_ptr<AdaptiveSolver> make_cvode(const OdeSystem& system, const RunSpec& spec, bool adams,
                                           bool krylov = false);
/// By an explicit table of ERKStep or a diagonally implicit one of ARKStep, an ARKODE_ERKTableID or
/// ARKODE_DIRKTableID. Throws std::runtime_error where there is none of that number.
std::unique_ptr<AdaptiveSolver> make_arkode(const OdeSystem& system, const RunSpec& spec, int table);
std::unique_ptr<AdaptiveSolver> make_arkode(const MassSystem& system, const RunSpec& spec, int table);
/// Ends with a reason on a form of index 2 or more. `check_index = false` is for showing what IDA does with
/// such a form on its own.
std::unique_ptr<AdaptiveSolver> make_ida(const DaeSystem& system, const RunSpec& spec,
                                         bool check_index = true);

/// Schemes on the ODE form.
struct OnOde {
  template <HasOde M>
  static std::unique_ptr<OdeSystem> system(const M& model) {
    return erase_ode(model);
  }
};

inline constexpr std::string_view cvode_citation =
    "A.C. Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363-396; SUNDIALS CVODE";
inline constexpr std::string_view arkode_citation =
    "D.R. Reynolds, D.J. Gardner, C.S. Woodward, R. Chinomona, ACM Trans. Math. Softw. 49 (2023) 19; "
    "SUNDIALS ARKODE";

struct CvodeAdams : OnOde {
  static constexpr SchemeInfo info{
      .name = "cvode-adams",
      .family = "sundials",
      .summary =
          "CVODE, Adams-Moulton of order 1 to 12 with variable step, Newton with the analytic Jacobian",
      .citation = cvode_citation,
      .form = "ode",
      .stepping = Stepping::adaptive,
  };
  static std::unique_ptr<AdaptiveSolver> make(const OdeSystem& system, const RunSpec& spec) {
    return make_cvode(system, spec, true);
  }
};

struct CvodeBdf : OnOde {
  static constexpr SchemeInfo info{
      .name = "cvode-bdf",
      .family = "sundials",
      .summary = "CVODE, BDF of order 1 to 5 with variable step, Newton with the analytic Jacobian",
      .citation = cvode_citation,
      .form = "ode",
      .stepping = Stepping::adaptive,
  };
  static std::unique_ptr<AdaptiveSolver> make(const OdeSystem& system, const RunSpec& spec) {
    return make_cvode(system, spec, false);
  }
};

/// For meshes so large that a factorisation in every set-up is to be avoided.
struct CvodeBdfGmres {
  static constexpr SchemeInfo info{
      .name = "cvode-bdf-gmres",
      .family = "sundials",
      .summary =
          "CVODE, BDF of order 1 to 5 with variable step, Newton by GMRES without a matrix, preconditioned "
          "by the model's own elimination with the tangent and step of earlier steps",
      .citation = cvode_citation,
      .form = "ode",
      .stepping = Stepping::adaptive,
  };
  template <HasOde M>
  requires requires(const M& model) { model.ode().newton_solver(); }
  static std::unique_ptr<OdeSystem> system(const M& model) { return erase_ode(model); }
  static std::unique_ptr<AdaptiveSolver> make(const OdeSystem& system, const RunSpec& spec) {
    return make_cvode(system, spec, false, true);
  }
};

struct ArkodeErk4 : OnOde {
  static constexpr SchemeInfo info{
      .name = "arkode-erk4",
      .family = "sundials",
      .summary = "ARKODE ERKStep, ARKODE_ZONNEVELD_5_3_4, explicit, order 4",
      .citation = arkode_citation,
      .form = "ode",
      .stepping = Stepping::adaptive,
  };
  static std::unique_ptr<AdaptiveSolver> make(const OdeSystem& system, const RunSpec& spec) {
    return make_arkode(system, spec, ARKODE_ZONNEVELD_5_3_4);
  }
};

struct ArkodeErk5 : OnOde {
  static constexpr SchemeInfo info{
      .name = "arkode-erk5",
      .family = "sundials",
      .summary = "ARKODE ERKStep, ARKODE_DORMAND_PRINCE_7_4_5, explicit, order 5",
      .citation = arkode_citation,
      .form = "ode",
      .stepping = Stepping::adaptive,
  };
  static std::unique_ptr<AdaptiveSolver> make(const OdeSystem& system, const RunSpec& spec) {
    return make_arkode(system, spec, ARKODE_DORMAND_PRINCE_7_4_5);
  }
};

struct ArkodeErk8 : OnOde {
  static constexpr SchemeInfo info{
      .name = "arkode-erk8",
      .family = "sundials",
      .summary = "ARKODE ERKStep, ARKODE_FEHLBERG_13_7_8, explicit, order 8",
      .citation = arkode_citation,
      .form = "ode",
      .stepping = Stepping::adaptive,
  };
  static std::unique_ptr<AdaptiveSolver> make(const OdeSystem& system, const RunSpec& spec) {
    return make_arkode(system, spec, ARKODE_FEHLBERG_13_7_8);
  }
};

struct ArkodeDirk {
  static constexpr SchemeInfo info{
      .name = "arkode-dirk",
      .family = "sundials",
      .summary =
          "ARKODE ARKStep, ARKODE_KVAERNO_7_4_5, diagonally implicit, order 5, Newton with the analytic "
          "Jacobian, with the mass matrix where there is one",
      .citation = arkode_citation,
      .form = "ode",
      .stepping = Stepping::adaptive,
  };
  template <HasOde M>
  static auto system(const M& model) {
    if constexpr (HasMassForm<M>)
      return erase_mass(model);
    else
      return erase_ode(model);
  }
  static std::unique_ptr<AdaptiveSolver> make(const OdeSystem& system, const RunSpec& spec) {
    return make_arkode(system, spec, ARKODE_KVAERNO_7_4_5);
  }
  static std::unique_ptr<AdaptiveSolver> make(const MassSystem& system, const RunSpec& spec) {
    return make_arkode(system, spec, ARKODE_KVAERNO_7_4_5);
  }
};

struct IdaBdf {
  static constexpr SchemeInfo info{
      .name = "ida-bdf",
      .family = "sundials",
      .summary = "IDA, BDF of order 1 to 5 with variable step on the implicit form, constraints stabilised",
      .citation = "A.C. Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363-396; SUNDIALS IDA",
      .form = "dae",
      .stepping = Stepping::adaptive,
  };
  template <HasDae M>
  static std::unique_ptr<DaeSystem> system(const M& model) {
    return erase_dae(model, model.dae());
  }
  static std::unique_ptr<AdaptiveSolver> make(const DaeSystem& system, const RunSpec& spec) {
    return make_ida(system, spec);
  }
};

struct IdaBdfConstraints {
  static constexpr SchemeInfo info{
      .name = "ida-bdf-constraints",
      .family = "sundials",
      .summary =
          "IDA, BDF of order 1 to 5 with variable step; pivot or supports kept as constraints, stabilised",
      .citation =
          "C.W. Gear, B. Leimkuhler, G.K. Gupta, J. Comput. Appl. Math. 12-13 (1985) 77-90; SUNDIALS IDA",
      .form = "dae",
      .stepping = Stepping::adaptive,
  };
  template <HasConstraintDae M>
  static std::string_view refusal(const M& model) {
    return model.is_constrained() ? "" : "it has no supports that can be kept as constraints";
  }
  template <HasConstraintDae M>
  static std::unique_ptr<DaeSystem> system(const M& model) {
    return erase_dae(model, model.dae_constraints());
  }
  static std::unique_ptr<AdaptiveSolver> make(const DaeSystem& system, const RunSpec& spec) {
    return make_ida(system, spec);
  }
};

struct IdaBdfIndex2 {
  static constexpr SchemeInfo info{
      .name = "ida-bdf-index2",
      .family = "sundials",
      .summary = "negative control: the same on the index-2 DAE form, which has to end with a reason",
      .citation = IdaBdf::info.citation,
      .form = "dae",
      .stepping = Stepping::adaptive,
      .control = true,
  };
  template <HasIndex2Dae M>
  static std::unique_ptr<DaeSystem> system(const M& model) {
    return erase_dae(model, model.dae_index2());
  }
  static std::unique_ptr<AdaptiveSolver> make(const DaeSystem& system, const RunSpec& spec) {
    return make_ida(system, spec);
  }
};

struct IdaBdfIndex3 {
  static constexpr SchemeInfo info{
      .name = "ida-bdf-index3",
      .family = "sundials",
      .summary = "negative control: the pivot as a constraint of index 3, which has to end with a reason",
      .citation = IdaBdf::info.citation,
      .form = "dae",
      .stepping = Stepping::adaptive,
      .control = true,
  };
  template <HasIndex3Dae M>
  static std::string_view refusal(const M& model) {
    return IdaBdfConstraints::refusal(model);
  }
  template <HasIndex3Dae M>
  static std::unique_ptr<DaeSystem> system(const M& model) {
    return erase_dae(model, model.dae_index3());
  }
  static std::unique_ptr<AdaptiveSolver> make(const DaeSystem& system, const RunSpec& spec) {
    return make_ida(system, spec);
  }
};

}  // namespace gnomon::sundials
