// Advice on misspelt names, and queries on sorts.

#include "compiler/sema/name_advice.h"

#include <array>

#include "compiler/sema/typed_model.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::SymbolKind;

const char* const kSorts =
    "sort thing\nsort cup: thing\nsort plate: thing\nsort both: cup\nsort both: plate\n"
    "sort lonely\nsort level: integer\nsort low: level\nrange low 0 2\nrange level 5 6\n"
    "cup Red, Blue\nboth Odd\nreified sort place\nplace Shelf(thing)\nreified sort nothing\n"
    "fluent Filled(cup,level)\nevent Fill(cup)\nrange time 0 1\n";

struct Sorts {
  CheckedText checked{kSorts};
  Sorts() { REQUIRE_MESSAGE(checked.model, checked.text()); }
  const compiler::TypedModel& model() const { return *checked.model; }
  compiler::SortId sort(const char* name) const { return *model().find_sort(name); }
};

TEST_CASE("a misspelt name is taken for a near one of the wanted kind") {
  const Sorts sorts;
  const base::DiagnosticSink sink;
  const compiler::NameAdvice advice(sorts.model(), sink);
  constexpr std::array<SymbolKind, 1> kFluents = {SymbolKind::kFluent};
  constexpr std::array<SymbolKind, 1> kEvents = {SymbolKind::kEvent};
  CHECK(advice.symbol("Filed", kFluents) == sorts.model().find_symbol("Filled"));
  CHECK(advice.symbol("Fil", kEvents) == sorts.model().find_symbol("Fill"));
  CHECK(!advice.symbol("Emptied", kFluents));
  CHECK(advice.object("Bleu") == sorts.model().find_object("Blue"));
  CHECK(advice.sort("plates") == sorts.model().find_sort("plate"));
  CHECK(compiler::NameAdvice::replace("Filed", "Filled") == "replace `Filed` with `Filled`");
}

TEST_CASE("a symbol is shown as it was declared") {
  const Sorts sorts;
  const auto& model = sorts.model();
  const auto& filled = model.symbols[*model.find_symbol("Filled")];
  CHECK(compiler::signature(model, filled) == "Filled(cup,level)");
  CHECK(compiler::kind_word(filled.kind) == "fluent");
}

TEST_CASE("sorts overlap where something can belong to both") {
  const Sorts sorts;
  compiler::SortDomains domains(sorts.model());
  CHECK(domains.overlap(sorts.sort("cup"), sorts.sort("thing")));
  CHECK(domains.overlap(sorts.sort("cup"), sorts.sort("plate")));  // Odd is both
  CHECK(!domains.overlap(sorts.sort("cup"), sorts.sort("place")));
  CHECK(domains.overlap(sorts.sort("plate"), sorts.sort("cup")));  // from memory, turned around
}

TEST_CASE("the ranges of a sort are its own and those of the sorts below it") {
  const Sorts sorts;
  compiler::SortDomains domains(sorts.model());
  CHECK(domains.ranges(sorts.sort("level")).size() == 2);
  CHECK(domains.ranges(sorts.sort("low")).size() == 1);
  CHECK(domains.contains(sorts.sort("level"), 1));
  CHECK(domains.contains(sorts.sort("level"), 6));
  CHECK(!domains.contains(sorts.sort("level"), 4));
  CHECK(!domains.contains(sorts.sort("low"), 5));
}

TEST_CASE("a sort has elements by constants, ranges or constructors, its own or below it") {
  const Sorts sorts;
  compiler::SortDomains domains(sorts.model());
  for (const auto* name : {"thing", "cup", "plate", "both", "level", "place"}) {
    CHECK_MESSAGE(domains.has_elements(sorts.sort(name)), name);
  }
  CHECK(!domains.has_elements(sorts.sort("lonely")));
  CHECK(!domains.has_elements(sorts.sort("nothing")));
}

}  // namespace
}  // namespace parallax::test
