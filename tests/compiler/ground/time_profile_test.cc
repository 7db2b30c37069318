#include "compiler/ground/time_profile.h"

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::TimeShape;

const std::string kTimedWorld =
    "range time 0 5\nsort a\na A\nfluent F(a)\nevent E(a)\npredicate P(a)\npredicate Q(time)\n";

/// "uniform -1 +2": back 1, width 2.
std::string profile_of(const std::string& axiom) {
  const CheckedText checked(kTimedWorld + axiom + '\n');
  REQUIRE_MESSAGE(checked.model, checked.text());
  const auto& model = *checked.model;
  const auto profile = model.effects.empty()
                           ? compiler::time_profile(model, model.axioms.at(0).formula)
                           : compiler::time_profile(model, model.effects.at(0));
  switch (profile.shape) {
    case TimeShape::kRigid:
      return "rigid";
    case TimeShape::kFixed:
      return "fixed";
    case TimeShape::kUniform:
      return "uniform -" + std::to_string(profile.back) + " +" + std::to_string(profile.width);
    case TimeShape::kMixed:
      return "mixed";
  }
  return "?";
}

TEST_CASE("an axiom without timed atoms is rigid, one about numbers is fixed") {
  CHECK(profile_of("[a] P(a).") == "rigid");
  CHECK(profile_of("[a] HoldsAt(F(a),0) & !Happens(E(a),3).") == "fixed");
}

TEST_CASE("one time variable and its neighbours are said of every timepoint") {
  CHECK(profile_of("[a,time] HoldsAt(F(a),time).") == "uniform -0 +0");
  CHECK(profile_of("[a,time] HoldsAt(F(a),time) -> HoldsAt(F(a),time+1).") == "uniform -0 +1");
  CHECK(profile_of("[a,time] HoldsAt(F(a),time-1) -> HoldsAt(F(a),time+1).") == "uniform -1 +2");
}

TEST_CASE("an event needs the timepoint after it") {
  CHECK(profile_of("[a,time] Happens(E(a),time) -> HoldsAt(F(a),time).") == "uniform -0 +1");
}

TEST_CASE("two variables, a number beside one, and time used otherwise are mixed") {
  CHECK(profile_of("[a,time1,time2] HoldsAt(F(a),time1) -> HoldsAt(F(a),time2).") == "mixed");
  CHECK(profile_of("[a,time] HoldsAt(F(a),time) -> HoldsAt(F(a),0).") == "mixed");
  CHECK(profile_of("[a,time] HoldsAt(F(a),time) -> Q(time).") == "mixed");
  CHECK(profile_of("[a,time] time>2 -> HoldsAt(F(a),time).") == "mixed");
  CHECK(profile_of("[a] {time} HoldsAt(F(a),time).") == "mixed");
}

TEST_CASE("an effect is uniform where its condition speaks of the event's own step") {
  CHECK(profile_of("[a,time] Initiates(E(a),F(a),time).") == "uniform -0 +1");
  CHECK(profile_of("[a,time] HoldsAt(F(a),time) -> Terminates(E(a),F(a),time).") ==
        "uniform -0 +1");
  CHECK(profile_of("[a,time] HoldsAt(F(a),time-1) -> Terminates(E(a),F(a),time).") == "mixed");
  CHECK(profile_of("[a] Initiates(E(a),F(a),2).") == "fixed");
}

}  // namespace
}  // namespace parallax::test
