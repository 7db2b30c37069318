// The printed model has the meaning of the model: reading it again gives the same text.

#include "compiler/sema/model_text.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "tests/compiler/front_end.h"
#include "tests/support/peer_examples.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

std::string printed(const CheckedText& text) {
  REQUIRE_MESSAGE(text.model.has_value(), text.text());
  return compiler::to_text(*text.model, [&](const base::SourceRange& range) {
    return text.files[range.file].name().starts_with("foundations/");
  });
}

/// `loads` is put in front of the printed text, which leaves foundations out.
void check_round_trip(const std::string& text, const std::string& loads = "") {
  const auto once = printed(CheckedText(text));
  const CheckedText again(loads + once);
  REQUIRE_MESSAGE(again.model.has_value(), once << again.text());
  CHECK(printed(again) == once);
}

const char* const kEverything =
    "option encoding 3\nrange time 0 3\nrange offset 1 3\nsort agent, h: integer\nsort cat: agent\n"
    "range h -2 4\nagent James\ncat Tom\nsort pet\npet! Tom\nreified sort belief\n"
    "belief BIs(agent)\nfluent Believe(agent,belief)\nfluent H(h)\nnoninertial H\n"
    "manualrelease Believe\nevent Think(agent)\nevent Sleep(agent)\npredicate P(agent,h)\n"
    "function Age(agent): h\nAge(James)=3.\nAge(Tom)=-1.\nmutex Think, Sleep\n"
    "[agent,time] agent=James & Age(agent)-1*2>h0 | !({h} P(agent,h)) -> "
    "!(agent!=Tom) & HoldsAt(Believe(agent,BIs(agent)),time).\n"
    "Delta: Happens(Think(Tom),0).\n[agent,belief,time] agent=James -> "
    "(P(agent,2) -> Initiates(Think(agent),Believe(agent,belief),time)).\n"
    "[agent,h,time,offset] HoldsAt(H(h),time) -> Trajectory(Believe(agent,BIs(agent)),time,"
    "H(h-offset),offset).\ncompletion Delta Happens\ncompletion P\n";

std::string everything() {
  std::string text = kEverything;
  const std::string odd = "h0";
  text.replace(text.find(odd), odd.size(), "(time+1)");
  return text;
}

TEST_CASE("model text: every kind of statement comes back") {
  check_round_trip(everything());
  const auto text = printed(CheckedText(everything()));
  for (const auto* line :
       {"sort cat: agent\n", "pet! Tom\n", "range h -2 4\n", "noninertial H\n",
        "belief BIs(agent)\n", "function Age(agent): h\n", "Age(Tom)=-1.\n",
        "[agent,time0] !Happens(Think(agent),time0) | !Happens(Sleep(agent),time0).\n",
        "Delta: Happens(Think(Tom),0).\n", "completion Delta Happens\n",
        "[agent,belief,time] (agent=James & P(agent,2)) -> "
        "Initiates(Think(agent),Believe(agent,belief),time).\n"}) {
    CHECK_MESSAGE(text.find(line) != std::string::npos, line << text);
  }
}

TEST_CASE("model text: deep formulas and terms are printed without recursion") {
  const std::size_t depth = 10'000;
  std::string sum = "1";
  for (std::size_t i = 0; i < depth; ++i) sum += "+1";
  const auto text = printed(CheckedText("range time 0 1\npredicate P()\n" +
                                        std::string(depth, '!') + "P().\n" + sum + "=2.\n"));
  CHECK(text.size() > 4 * depth);
}

TEST_CASE("model text: the examples of the 2005 reasoner") {
  const auto folder = peer_examples();
  if (!folder) return;
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(*folder / "examples")) {
    if (entry.path().extension() != ".e") continue;
    FrontEnd front;
    compiler::LoadOptions options;
    options.include_dirs = {*folder};
    const std::vector<fs::path> main = {entry.path()};
    const auto ast = compiler::load_model(main, options, front.files, front.sink);
    if (!ast) continue;
    const auto model = compiler::check_model(*ast, front.files, front.sink);
    if (!model) continue;
    std::string loads;
    for (const auto& file : ast->files) {
      if (file.built_in) loads += "load " + front.files[file.ast.file()].name() + "\n";
    }
    const auto once = compiler::to_text(*model, [&](const base::SourceRange& range) {
      return front.files[range.file].name().starts_with("foundations/");
    });
    CAPTURE(entry.path().string());
    check_round_trip(loads + once, loads);
    ++count;
  }
  CHECK(count > 20);
}

}  // namespace
}  // namespace parallax::test
