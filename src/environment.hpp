#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/catalogue.hpp"

namespace gnomon {

inline constexpr const char* gnomon_version = "0.1.0";

/// What a result depends on besides the scene: machine, compiler, flags, libraries, commit, date.
nlohmann::ordered_json environment(const Catalogue& catalogue);

/// One line for tables: which SUNDIALS was timed and whether it is optimised.
std::string sundials_line(const Catalogue& catalogue);

/// A finding of the doctor about the machine or the build.
struct Finding {
  bool good;
  std::string text;
};
std::vector<Finding> examine(const Catalogue& catalogue);

}  // namespace gnomon
