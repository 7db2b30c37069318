// Counts and sums on the command line: properties, goals, exports, layout, comparison.

#include <doctest/doctest.h>

#include <functional>
#include <set>
#include <string>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

// At most one thing is put somewhere at a time; A is put there once at most.
constexpr const char* kModel =
    "range time 0 5\nsort thing\nthing A, B, C\nfluent On(thing)\nevent Put(thing)\n"
    "[thing,time] Initiates(Put(thing),On(thing),time).\n[thing] !HoldsAt(On(thing),0).\n"
    "[time] count{thing: Happens(Put(thing),time)}<=1.\ncount{time: Happens(Put(A),time)}<=1.\n";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The traces that end where two things have been put, written out by hand.
int traces_to_two() {
  int found = 0;
  const std::function<void(std::string)> go = [&](const std::string& put) {
    std::set<char> things(put.begin(), put.end());
    things.erase('-');
    if (things.size() == 2) ++found;
    if (things.size() == 2 || put.size() == 5) return;
    for (const char thing : {'A', 'B', 'C', '-'}) {
      if (thing != 'A' || !things.contains('A')) go(put + thing);
    }
  };
  go("");
  return found;
}

TEST_CASE("a goal with a count ends traces, and a bound from above holds in those that end early") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  const auto counted = cli.parallax(
      {"traces", "m.e", "--count", "--until", "count{thing: HoldsAt(On(thing),time)}=2"});
  CHECK_MESSAGE(counted.out == std::to_string(traces_to_two()) + "\n", counted.err);
}

TEST_CASE("properties with counts and sums are verified, with the second evaluator's check") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  const auto verify = [&](const std::string& property) {
    return cli.parallax({"verify", "m.e", "--check", "--property=" + property});
  };
  CHECK(verify("count{thing: HoldsAt(On(thing),time)}<=time").code == 0);
  CHECK(has(verify("count{thing: HoldsAt(On(thing),time)}<=2").out, "violated at timepoint 3"));
  CHECK(has(verify("always (sum{thing: 2: HoldsAt(On(thing),time)}<4)").out,
            "violated at timepoint 2"));
  CHECK(verify("eventually (count{thing: HoldsAt(On(thing),time)}>=1) | "
               "always (count{thing: HoldsAt(On(thing),time)}=0)")
            .code == 0);
  const auto inside = verify("count{thing: eventually HoldsAt(On(thing),time)}>=1");
  CHECK(has(inside.err, ":1:14-47: error[E2116]"));
}

TEST_CASE("models with aggregates are laid out, compared and checked like others") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  cli.write("same.e", std::string(kModel) + "; the same\n");
  std::string text = kModel;
  text.replace(text.find("}<=1."), 5, "}<=2.");
  cli.write("other.e", text);
  CHECK(cli.parallax({"check", "m.e"}).code == 0);
  CHECK(cli.parallax({"fmt", "--check", "m.e"}).code == 0);
  CHECK(cli.parallax({"diff", "m.e", "same.e"}).code == 0);
  const auto diff = cli.parallax({"diff", "m.e", "other.e"});
  CHECK_MESSAGE(has(diff.out, "count{thing"), diff.out << diff.err);
  CHECK(has(cli.parallax({"compile", "m.e", "--emit=lp"}).out, "#count{"));
  const auto old = cli.parallax({"traces", "m.e", "--compat", "decreasoner"});
  CHECK(old.code == 3);
  CHECK(has(old.err, "error[E3019]"));
}

}  // namespace
}  // namespace parallax::test
