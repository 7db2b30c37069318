// Tables of possibly true atoms, and the rows of effects that they bound.

#include "compiler/ground/possible_atoms.h"

#include "tests/compiler/front_end.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using compiler::EffectKind;
using compiler::EffectRows;
using compiler::GroundTable;
using compiler::GroundTermId;

const char* const kSteps =
    "range time 0 3\nsort n: integer\nrange n 1 3\nfluent At(n)\nevent Go(n)\n"
    "HoldsAt(At(1),0).\n[n] n!=1 -> !HoldsAt(At(n),0).\n";

TEST_CASE("a table finds its rows by any columns, also those added after the index was made") {
  compiler::GroundTermStore terms;
  const auto one = terms.integer(1), two = terms.integer(2), three = terms.integer(3);
  GroundTable table(2);
  table.add(std::array{one, two});
  table.add(std::array{one, three});
  const auto rows = [&](std::uint64_t mask, std::vector<GroundTermId> key) {
    const auto found = table.find(mask, key);
    return std::vector<std::uint32_t>(found.begin(), found.end());
  };
  CHECK(rows(1, {one}) == std::vector<std::uint32_t>{0, 1});
  CHECK(rows(2, {three}) == std::vector<std::uint32_t>{1});
  CHECK(rows(3, {one, one}).empty());
  table.add(std::array{two, three});
  CHECK(rows(2, {three}) == std::vector<std::uint32_t>{1, 2});
  CHECK(rows(0, {}) == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(table.row(2)[0] == two);
}

TEST_CASE("the values at 0 are those that a constraint states outright") {
  const TextModel model(kSteps);
  REQUIRE(model.ground != nullptr);
  const auto values = compiler::initial_values(*model.ground);
  REQUIRE(values.size() == 3);
  CHECK(values[0] == compiler::Truth::kTrue);
  CHECK(values[1] == compiler::Truth::kFalse);
  CHECK(values[2] == compiler::Truth::kFalse);
}

TEST_CASE("what no row initiates is left out, and so is what needs it") {
  const TextModel model(kSteps);
  REQUIRE(model.ground != nullptr);
  auto& ground = *model.ground;
  auto& formulas = ground.formulas();
  EffectRows rows(ground.fluents().size());
  // Go(2) leads from 1 to 2; At(3) would need itself.
  rows.add_always({EffectKind::kInitiates, 1, 1, ground.holds(0, 0), 0});
  rows.add_always({EffectKind::kInitiates, 2, 2, ground.holds(2, 0), 0});
  compiler::PossibleAtoms possible(ground);
  compiler::drop_unreachable(ground, possible, rows, 0);
  CHECK(ground.may_hold(0));
  CHECK(ground.may_hold(1));
  CHECK(!ground.may_hold(2));
  CHECK(rows.always().size() == 1);
  CHECK(possible.fluents(*ground.typed().find_symbol("At")).size() == 2);
  CHECK(!possible.may_hold(2, std::nullopt));
  CHECK(formulas.node_count() > 0);
}

TEST_CASE("small models keep fluents that are always false") {
  const TextModel model(kSteps);
  REQUIRE(model.ground != nullptr);
  EffectRows rows(model.ground->fluents().size());
  compiler::PossibleAtoms possible(*model.ground);
  compiler::drop_unreachable(*model.ground, possible, rows, 1000);
  CHECK(model.ground->may_hold(2));
}

TEST_CASE("a fluent that is tracked may hold where its history says so") {
  const TextModel model(kSteps);
  REQUIRE(model.ground != nullptr);
  compiler::PossibleAtoms possible(*model.ground);
  possible.track(1, 0, false);
  possible.track(1, 2, true);
  CHECK(!possible.may_hold(1, 0));
  CHECK(!possible.may_hold(1, 1));
  CHECK(possible.may_hold(1, 2));
  CHECK(possible.may_hold(1, 3));
  CHECK(possible.may_hold(1, std::nullopt));  // at some timepoint
  possible.set_timeless(true);
  CHECK(possible.may_hold(1, 0));
}

TEST_CASE("events that are scheduled happen at their timepoints only") {
  const TextModel model(kSteps);
  REQUIRE(model.ground != nullptr);
  const auto go = *model.typed->find_symbol("Go");
  std::vector<bool> symbols(model.typed->symbols.size(), false);
  symbols[go.index()] = true;
  compiler::PossibleAtoms possible(*model.ground);
  possible.schedule(symbols, {{0, 1}, {1, 2}});
  CHECK(possible.all_events_scheduled());
  CHECK(possible.may_happen(0, 1));
  CHECK(!possible.may_happen(0, 2));
  CHECK(!possible.may_happen(2, std::nullopt));
  CHECK(!model.ground->may_happen(2));
  auto& table = possible.events(go);
  CHECK(table.columns() == 2);  // the argument and the timepoint
  CHECK(table.size() == 2);
}

TEST_CASE("rows of every timepoint and of single ones change a fluent together") {
  const TextModel model(kSteps);
  REQUIRE(model.ground != nullptr);
  auto& ground = *model.ground;
  auto& formulas = ground.formulas();
  EffectRows rows(ground.fluents().size());
  rows.add_always({EffectKind::kInitiates, 0, 0, ground.holds(1, 0), 0});
  CHECK(rows.is_uniform(0));
  rows.add(2, {EffectKind::kInitiates, 1, 0, formulas.truth(), 0});
  CHECK(!rows.is_uniform(0));
  const auto always = formulas.conjunction(ground.happens(0, 2), ground.holds(1, 2));
  CHECK(rows.changed(EffectKind::kInitiates, 0, 2, ground) ==
        formulas.disjunction(always, ground.happens(1, 2)));
  CHECK(rows.changed(EffectKind::kTerminates, 0, 2, ground) == formulas.falsity());
  CHECK(rows.holds(EffectKind::kInitiates, 0, 0, 2, ground) == ground.holds(1, 2));
  CHECK(rows.holds(EffectKind::kInitiates, 1, 0, 2, ground) == formulas.truth());
  CHECK(rows.holds(EffectKind::kInitiates, 1, 0, 1, ground) == formulas.falsity());
}

}  // namespace
}  // namespace parallax::test
