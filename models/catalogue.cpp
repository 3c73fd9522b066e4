#include "models/catalogue.hpp"

#include "models/planar_beam/read.hpp"
#include "models/rigid_body/peers/peers.hpp"
#include "models/rigid_body/read.hpp"
#include "models/rigid_body/yardstick.hpp"
#include "models/rigid_body_ensemble/read.hpp"

namespace gnomon {

void add_models(Catalogue& catalogue) {
  const std::string root = std::string(GNOMON_SOURCE_DIR) + "/models/";
  catalogue.models.push_back(rigid_body::entry);
  catalogue.scene_folders.push_back(root + "rigid_body/scenes");
  catalogue.study_files.push_back(root + "rigid_body/study.toml");
  catalogue.models.push_back(rigid_body_ensemble::entry);
  catalogue.scene_folders.push_back(root + "rigid_body_ensemble/scenes");
  catalogue.study_files.push_back(root + "rigid_body_ensemble/study.toml");
  catalogue.models.push_back(planar_beam::entry);
  catalogue.scene_folders.push_back(root + "planar_beam/scenes");
  catalogue.study_files.push_back(root + "planar_beam/study.toml");
  catalogue.yardsticks.push_back(rigid_body::plain_cvode_yardstick);
  rigid_body::add_peers(catalogue);
  add_model_types(catalogue, Models{});
}

}  // namespace gnomon
