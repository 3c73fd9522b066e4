#pragma once
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/output/progress.hpp"
#include "src/status.hpp"
#include "src/study/child.hpp"
#include "src/study/run_store.hpp"

namespace gnomon {

/// Makes every measurement of a study once: what is in the store is taken from there, the rest is made in a
/// child process and stored as it ends.
class Keeper {
 public:
  using Json = nlohmann::ordered_json;
  struct Plan {
    std::string code;     ///< the program that measures, as a hash
    std::string machine;  ///< where it runs; times of another one are not taken
    bool measure = true;  ///< false: only what is in the store
    ChildLimits limits;
    int jobs = 1;  ///< children at a time, for measurements that are not timed
  };

  Keeper(RunStore& store, Plan plan) : store_(store), plan_(std::move(plan)) {}

  /// A measurement: what it gave, or how it failed.
  struct Kept {
    Status status = Status::ok;  ///< interrupted where there is none
    std::string message;
    Json result;
    int task = -1;                                              ///< of a failed one, the task it was at
    double seconds = std::numeric_limits<double>::quiet_NaN();  ///< of wall-clock time that it took
  };
  /// The measurements of these identities one after the other: `work(k, pulse)` makes number k, `begin(k)` is
  /// called before and `take(k, kept)` after it; where that says false the rest is left out. What ends its
  /// process is a result, too. `timed` ones belong to the machine. Those made share a child process until one
  /// ends it.
  void get_all(std::string_view kind, const std::vector<Json>& identities, bool timed,
               const std::function<Json(std::size_t, Pulse&)>& work,
               const std::function<void(std::size_t)>& begin,
               const std::function<bool(std::size_t, const Kept&)>& take);
  /// Measurements that are not timed and do not depend on each other: the same results in the same order, but
  /// up to Plan::jobs of those to be made at a time, each in a child of its own. `begin` is called for known
  /// ones first.
  void get_each(std::string_view kind, const std::vector<Json>& identities,
                const std::function<Json(std::size_t, Pulse&)>& work,
                const std::function<void(std::size_t)>& begin,
                const std::function<void(std::size_t, const Kept&)>& take);
  /// A single one.
  Kept get(std::string_view kind, const Json& identity, bool timed, const std::function<Json(Pulse&)>& work);

  /// What is stored that is no measurement, such as what is known of a reference; null if there is none.
  Json recall(std::string_view kind, const Json& identity) const;
  void remember(std::string_view kind, const Json& identity, const Json& what);

  /// Is told which of the measurements it counts were known.
  void report_to(output::Progress* progress) { progress_ = progress; }
  void set_seconds(double seconds) { plan_.limits.seconds = seconds; }
  int jobs() const { return plan_.jobs; }
  bool measures() const { return plan_.measure; }
  std::size_t known() const { return known_; }
  std::size_t made() const { return made_; }
  std::size_t missing() const { return missing_; }

 private:
  void count_known(const Kept& kept);
  std::optional<Kept> stored(const std::string& name) const;
  void store(const std::string& name, std::string_view kind, const Json& identity, const Kept& kept,
             double seconds);
  std::string key(std::string_view kind, const Json& identity, bool timed) const;

  RunStore& store_;
  Plan plan_;
  output::Progress* progress_ = nullptr;
  std::size_t known_ = 0, made_ = 0, missing_ = 0;
};

}  // namespace gnomon
