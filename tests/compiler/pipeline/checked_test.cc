// A compilation that is only asked for its messages leaves out passes: the messages are the same.
// Models are those of scenarios/classics, whole and with one line left out, in both meanings.

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "compiler/pipeline/check_texts.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

/// The messages about a text.
std::string messages(const std::string& text, bool only_checked, compiler::Meaning meaning,
                     std::set<std::string>* codes) {
  FrontEnd front;
  compiler::CompileInput input;
  input.text = front.add(text);
  input.lint = true;
  input.ground.meaning = meaning;
  const bool is_right =
      only_checked ? static_cast<bool>(compiler::check_texts(input, front.files, front.sink))
                   : static_cast<bool>(compiler::compile_model(input, front.files, front.sink));
  if (codes != nullptr) {
    for (const auto& code : front.codes()) codes->insert(code);
  }
  return (is_right ? "compiled\n" : "not compiled\n") + front.text();
}

void check_same(const std::string& text, std::set<std::string>* codes = nullptr) {
  CAPTURE(text);
  for (const auto meaning : {compiler::Meaning::kStandard, compiler::Meaning::kDecreasoner})
    CHECK(messages(text, false, meaning, nullptr) == messages(text, true, meaning, codes));
}

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<std::string> out;
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

TEST_CASE("messages of grounding do not depend on what is done with the model") {
  std::set<std::string> codes;
  for (const auto* text :
       {"range time 0 2\nsort a\na A, B\nfluent F(a)\nevent E(a)\n[a,time] HoldsAt(F(a),time) & "
        "!HoldsAt(F(a),time).\n",
        "range time 0 1\nfluent F()\nevent E()\nHappens(E(),1).\nHoldsAt(F(),0).\n",
        "range time 0 1\nfluent F()\nHoldsAt(F(),7).\n",
        "range time 0 2\nfluent F()\npredicate P(time)\npredicate Q(time)\n[time] P(time) -> "
        "Q(time).\n[time] Q(time) -> P(time).\ncompletion P\ncompletion Q\n",
        "range time 0 2\nrange offset 1 2\nsort h: integer\nrange h 0 3\nfluent At(h)\nfluent "
        "Falling()\nevent Drop()\n[time] Initiates(Drop(),Falling(),time).\n[h,offset,time] "
        "Trajectory(Falling(),time,At(h),offset).\n"}) {
    check_same(text, &codes);
  }
  CHECK(codes.size() > 3);
}

TEST_CASE("models with one line left out have the same messages, checked or compiled") {
  std::set<std::string> codes;
  const auto folder = std::filesystem::path(PARALLAX_SOURCE_DIR) / "scenarios" / "classics";
  for (const auto* name : {"stolen_car.e", "falling_object.e", "relay_circuit.e", "mail_protocol.e",
                           "bus_ride.e", "coin_toss.e"}) {
    const auto lines = lines_of(folder / name);
    REQUIRE(lines.size() > 5);
    for (std::size_t left_out = 0; left_out <= lines.size(); ++left_out) {
      std::string text;
      for (std::size_t i = 0; i < lines.size(); ++i) {
        if (i != left_out) text += lines[i] + "\n";
      }
      check_same(text, &codes);
    }
  }
  CHECK(codes.size() > 5);
}

}  // namespace
}  // namespace parallax::test
