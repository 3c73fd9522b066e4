#include "src/output/progress.hpp"

#include <limits>
#include <sstream>
#include <string>

#include "tests/catch.hpp"
#include "tests/output/contains.hpp"

using namespace gnomon::output;
using namespace gnomon::test;

TEST_CASE("output: durations are written for people") {
  CHECK(duration(0.0) == "0 s");
  CHECK(duration(59.4) == "59 s");
  CHECK(duration(59.6) == "1 min 00 s");
  CHECK(duration(70.0) == "1 min 10 s");
  CHECK(duration(3599.6) == "1 h 00 min");
  CHECK(duration(7500.0) == "2 h 05 min");
  CHECK(duration(-1.0) == "unknown time");
  CHECK(duration(std::numeric_limits<double>::infinity()) == "unknown time");
}

TEST_CASE("output: a live line counts, names the run and estimates the time left") {
  double now = 0.0;
  std::ostringstream out;
  Progress progress(128, ProgressMode::live, out, 80, [&] { return now; });
  progress.begin("free-top / munjiza  step 0.01");
  CHECK(out.str() == "\r\033[K[  1/128 ..........] free-top / munjiza  step 0.01");
  out.str("");
  now = 1.0;
  progress.begin("free-top / rkmk4");
  CHECK(out.str() == "\r\033[K[  2/128 ..........] free-top / rkmk4  2 min 07 s left");
  out.str("");
  now = 200.0;
  progress.finish();
  CHECK(out.str() == "\r\033[K[  2/128] done in 3 min 20 s\n");
  out.str("");
  progress.finish();
  CHECK(out.str().empty());
}

TEST_CASE("output: a live line never reaches the last column and keeps the time left") {
  double now = 0.0;
  std::ostringstream out;
  Progress progress(2, ProgressMode::live, out, 30, [&] { return now; });
  progress.begin("a");
  now = 5.0;
  out.str("");
  progress.begin("a scene with a very long name / an integrator");
  const std::string line = out.str().substr(std::string("\r\033[K").size());
  CHECK(line.size() == 29);
  CHECK(contains(line, "[2/2] a scene with"));
  CHECK(contains(line, "  5 s left"));
}

TEST_CASE("output: plain lines come at most every ten seconds") {
  double now = 0.0;
  std::ostringstream out;
  Progress progress(100, ProgressMode::lines, out, 0, [&] { return now; });
  for (int i = 0; i < 100; ++i) {
    progress.begin("run " + std::to_string(i));
    now += 0.25;
  }
  CHECK(out.str() == "[  1/100] run 0\n[ 41/100] run 40  15 s left\n[ 81/100] run 80  5 s left\n");
  progress.finish();
  CHECK(contains(out.str(), "[100/100] done in 25 s\n"));
}

TEST_CASE("output: runs known already count but say nothing about the time left") {
  double now = 0.0;
  std::ostringstream out;
  Progress progress(10, ProgressMode::live, out, 80, [&] { return now; });
  progress.skip(6);
  progress.begin("first");
  CHECK(contains(out.str(), "[ 7/10 ######....] first"));
  CHECK_FALSE(contains(out.str(), "left"));
  now = 3.0;
  progress.begin("second");
  CHECK(contains(out.str(), "[ 8/10 #######...] second  9 s left"));
  progress.finish();
  CHECK(contains(out.str(), "[ 8/10] done in 3 s, 6 known already\n"));
}

TEST_CASE("output: quiet progress prints nothing") {
  CHECK(progress_mode(true) == ProgressMode::silent);
  CHECK(progress_mode(false) != ProgressMode::silent);
  std::ostringstream out;
  {
    Progress progress(2, ProgressMode::silent, out);
    progress.begin("a");
    progress.begin("b");
    progress.finish();
  }
  CHECK(out.str().empty());
}

TEST_CASE("output: a live line left by an exception is cleared, plain lines stay") {
  std::ostringstream live;
  { Progress(2, ProgressMode::live, live, 40).begin("a"); }
  CHECK(live.str() == "\r\033[K[1/2] a\r\033[K");
  std::ostringstream lines;
  { Progress(2, ProgressMode::lines, lines).begin("a\nb"); }
  CHECK(lines.str() == "[1/2] a b\n");
}

TEST_CASE("output: the time left of a resumed study counts only what has still to be made") {
  double now = 0.0;
  std::ostringstream out;
  Progress progress(1000, ProgressMode::live, out, 80, [&] { return now; });
  progress.expect(20);
  const auto shown = [&] {
    const std::string text = out.str();
    out.str("");
    return text.substr(text.rfind("\r\033[K") + 4);
  };
  // Nothing is known of what runs take, until the first known one has told.
  progress.begin("known");
  CHECK_FALSE(contains(shown(), "left"));
  for (int k = 0; k < 490; ++k) {
    progress.known(3.0);
    now += 0.001;
    progress.begin("next");
  }
  // 3 s each for the 20 to be made, whatever the other 490 that follow are.
  CHECK(shown() == "[ 491/1000 ####......] next  1 min 00 s left");
  // The first that is made takes five minutes: with eight known ones that is 36 s on average.
  progress.made();
  now += 300.0;
  progress.begin("next");
  CHECK(shown() == "[ 492/1000 ####......] next  11 min 24 s left");
  for (int k = 0; k < 18; ++k) {
    progress.made();
    now += 3.0;
    progress.begin("next");
  }
  CHECK(shown() == "[ 510/1000 #####.....] next  14 s left");
  // One of which a part was known and a part was made counts as made.
  progress.known(3.0);
  progress.made();
  now += 3.0;
  progress.begin("last");
  CHECK(progress.made_so_far() == 21);
  progress.known(3.0);
  CHECK(progress.made_so_far() == 20);
  now += 0.5;
  progress.finish();
  CHECK(contains(shown(), "done in 5 min 58 s, 491 known already\n"));
}

TEST_CASE("output: without an expectation a resumed study counts all that is left") {
  double now = 0.0;
  std::ostringstream out;
  Progress progress(10, ProgressMode::lines, out, 0, [&] { return now; });
  for (int k = 0; k < 5; ++k) {
    progress.begin("a");
    progress.known();
  }
  now = 20.0;
  progress.begin("b");
  now = 40.0;
  progress.begin("c");
  CHECK(contains(out.str(), "[ 7/10] c  1 min 20 s left\n"));
}
