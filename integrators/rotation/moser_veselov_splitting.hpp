#pragma once
#include "integrators/rotation/moser_veselov.hpp"

namespace gnomon::rotation {

/// Splittings of which each drift is a Moser-Veselov step, preprocessed to order 10. Its equation takes a
/// varying number of iterations, so no number of stages is declared.
constexpr SchemeInfo moser_veselov_splitting_info(std::string_view name, std::string_view summary,
                                                  std::string_view citation, double order) {
  return {
      .name = name,
      .family = "rotation",
      .summary = summary,
      .citation = citation,
      .form = "rotation",
      .orders = {{{"none", 10}, {"gravity", order}, {"space_moment", order}, {"body_moment", order}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
}

struct Yoshida4Dmv10 : Kicked<MoserVeselovFlow<10>, yoshida4> {
  static constexpr SchemeInfo info = moser_veselov_splitting_info(
      "yoshida4-dmv10", "three steps of dmv10, the middle one backwards", yoshida4_citation, 4);
};
struct Suzuki4Dmv10 : Kicked<MoserVeselovFlow<10>, suzuki4> {
  static constexpr SchemeInfo info = moser_veselov_splitting_info(
      "suzuki4-dmv10", "five steps of dmv10, the middle one backwards", suzuki4_citation, 4);
};
struct BlanesMoan4Dmv10 : Kicked<MoserVeselovFlow<10>, blanes_moan4> {
  static constexpr SchemeInfo info = moser_veselov_splitting_info(
      "blanes-moan4-dmv10",
      "splitting of order 4 with a small error constant: seven kicks, six Moser-Veselov steps",
      blanes_moan4_citation, 4);
};
struct BlanesMoanRkn4Dmv10 : Kicked<MoserVeselovFlow<10>, blanes_moan_rkn4> {
  static constexpr SchemeInfo info = moser_veselov_splitting_info(
      "blanes-moan-rkn4-dmv10",
      "Runge-Kutta-Nystrom splitting of order 4: seven kicks, six Moser-Veselov steps",
      blanes_moan_rkn4_citation, 4);
};
struct BlanesMoanRkn6Dmv10 : Kicked<MoserVeselovFlow<10>, blanes_moan_rkn6> {
  static constexpr SchemeInfo info = moser_veselov_splitting_info(
      "blanes-moan-rkn6-dmv10",
      "Runge-Kutta-Nystrom splitting of order 6: fifteen Moser-Veselov steps, fourteen kicks",
      blanes_moan_rkn6_citation, 6);
};
struct KahanLi6Dmv10 : Kicked<MoserVeselovFlow<10>, kahan_li6> {
  static constexpr SchemeInfo info =
      moser_veselov_splitting_info("kahan-li6-dmv10", "nine steps of dmv10, order 6", kahan_li6_citation, 6);
};
struct Mclachlan8Dmv10 : Kicked<MoserVeselovFlow<10>, mclachlan8> {
  static constexpr SchemeInfo info = moser_veselov_splitting_info(
      "mclachlan8-dmv10", "fifteen steps of dmv10, order 8", mclachlan8_citation, 8);
};
struct KahanLi8Dmv10 : Kicked<MoserVeselovFlow<10>, kahan_li8> {
  static constexpr SchemeInfo info = moser_veselov_splitting_info(
      "kahan-li8-dmv10", "seventeen steps of dmv10, order 8", kahan_li8_citation, 8);
};

}  // namespace gnomon::rotation
