#include <fmt/format.h>

#include "src/cli/command.hpp"
#include "src/environment.hpp"

namespace gnomon::cli {

int doctor(Context& context) {
  nlohmann::ordered_json json;
  json["gnomon"] = gnomon_version;
  json["command"] = "doctor";
  json["environment"] = environment(context.catalogue);
  json["findings"] = nlohmann::ordered_json::array();
  bool all_good = true;
  for (const Finding& finding : examine(context.catalogue)) {
    say(context.request, fmt::format("[{}] {}", finding.good ? "ok" : "!!", finding.text));
    json["findings"].push_back({{"good", finding.good}, {"text", finding.text}});
    all_good = all_good && finding.good;
  }
  say(context.request, all_good ? "nothing stands in the way of trustworthy times"
                                : "lines marked !! make times less trustworthy; accuracy is not affected");
  write_json(context.request, json);
  return done;
}

}  // namespace gnomon::cli
