// A model that uses the whole language, damaged in thousands of ways: the front end always ends
// with a model or a message, and an accepted model means the same after printing.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>

#include "compiler/syntax/printer.h"
#include "tests/compiler/front_end.h"
#include "tests/compiler/typed_text.h"
#include "tests/support/random.h"

namespace parallax::test {
namespace {

constexpr std::string_view kModel = R"(option encoding 3 ; comment
option trajectory on
load foundations/Root.e
load foundations/EC.e
load foundations/ECCausal.e
sort object
sort agent: object, cup: object
sort level: integer
reified sort belief
agent Ann, Bob
cup Cup1
agent! Cup1
belief BFull(cup)
predicate Likes(agent,object)
function Size(cup): level
fluent Full(cup)
fluent Level(cup,level)
fluent Believes(agent,belief)
event Fill(agent,cup)
event Spill(cup)
event Leak(cup)
noninertial Level
manualrelease Believes
mutex Fill, Spill
xor Spill, Leak
completion Delta Happens
Size(Cup1)=2.
[agent,cup,time] Likes(agent,cup) & !HoldsAt(Full(cup),time) ->
  Initiates(Fill(agent,cup),Full(cup),time).
[cup][time] HoldsAt(Full(cup),time) -> (Size(cup)>1 -> Terminates(Spill(cup),Full(cup),time) &
  Releases(Spill(cup),Level(cup,0),time)).
[cup,level1,level2,offset,time]
HoldsAt(Level(cup,level1),time) & level2 = level1-offset ->
Trajectory(Full(cup),time,Level(cup,level2),offset).
Delta: [time] Started(Full(Cup1),time) <-> {agent} Happens(Fill(agent,Cup1),time) | 1+2*3>=-4%5/6.
[agent,belief,time] (agent=Ann | belief!=BFull(Cup1)) -> HoldsAt(Believes(agent,belief),time).
range time 0 3
range level 0 3
range offset 1 2
)";

std::string damaged(Random& random) {
  constexpr std::string_view kPieces = "()[]{}.,:;!&|<->=+*/^% \n\tAaz09_@\r\xC3\xFF";
  std::string text(kModel);
  const auto count = 1 + random.below(4);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = random.below(text.size());
    const auto length = std::min<std::size_t>(random.below(12), text.size() - at);
    switch (random.below(4)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, 1, kPieces[random.below(kPieces.size())]);
        break;
      case 2:
        text[at] = kPieces[random.below(kPieces.size())];
        break;
      default:
        text.insert(random.below(text.size()), text.substr(at, 3 * length));
        break;
    }
  }
  return text;
}

/// Everything the model says, as text.
std::string meaning(const compiler::TypedModel& model) {
  const TypedText text(model);
  std::string out;
  for (const auto& symbol : model.symbols) out += symbol.name + "\n";
  for (const auto& object : model.objects) out += object.name + "\n";
  for (const auto& axiom : model.axioms) out += text.axiom(axiom) + "\n";
  for (const auto& effect : model.effects) out += text.effect(effect) + "\n";
  for (const auto& path : model.trajectories) out += text.trajectory(path) + "\n";
  return out;
}

TEST_CASE("mutation: the undamaged model is accepted") {
  const CheckedText checked{std::string(kModel)};
  CHECK_MESSAGE(checked.model.has_value(), checked.text());
}

TEST_CASE("mutation: 2,000 damaged models are refused with a message or mean what they print") {
  Random random(7);
  int accepted = 0;
  for (int round = 0; round < 2'000; ++round) {
    const auto text = damaged(random);
    CAPTURE(text);
    FrontEnd front;
    const auto file = front.add(text);
    const auto ast = compiler::load_model_text(file, "/nonexistent", {}, front.files, front.sink);
    if (!ast) {
      REQUIRE(front.sink.has_errors());
      continue;
    }
    const auto model = compiler::check_model(*ast, front.files, front.sink);
    REQUIRE(model.has_value() != front.sink.has_errors());
    REQUIRE((model || !front.text().empty()));
    if (!model) continue;
    ++accepted;
    const CheckedText again(compiler::print_file(ast->files[0].ast));
    REQUIRE_MESSAGE(again.model.has_value(), again.text());
    REQUIRE(meaning(*again.model) == meaning(*model));
  }
  // Damage in comments, blanks and names of the same kind is no damage.
  CHECK(accepted > 25);
  CHECK(accepted < 1'000);
}

}  // namespace
}  // namespace parallax::test
