#include "runtime/compare/trace_difference.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/model_edits.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using runtime::CompiledModel;
using runtime::DifferenceAnswer;
using runtime::Timepoint;
using runtime::TraceDifference;

constexpr std::size_t kLimit = 400;  // traces of one model

/// Reference for a comparison: full lists of traces, over the names that both models have.
class FullLists {
 public:
  FullLists(const CompiledModel& model, const CompiledModel& other) {
    std::set<std::string> others;
    for (const auto* list : {&other.fluents, &other.events}) {
      for (const auto& name : *list) others.insert(name.name);
    }
    for (const auto* list : {&model.fluents, &model.events}) {
      for (const auto& name : *list) {
        if (others.contains(name.name)) names_.insert(name.name);
      }
    }
    for (Timepoint n = 0; n <= model.horizon && small_; ++n) add(runtime::truncated(model, n), n);
  }

  bool is_small() const { return small_; }
  const std::set<std::string>& traces() const { return by_horizon_.back(); }
  /// The shared observables of a trace up to timepoint n.
  std::string key(const runtime::Trace& trace, Timepoint n) const {
    std::string out;
    for (Timepoint t = 0; t <= n; ++t) {
      const auto at = static_cast<std::size_t>(t);
      const auto add = [&](std::string_view name) {
        if (names_.contains(std::string(name))) out.append(name).append(" ");
      };
      for (const auto name : trace.holds(at)) add(name);
      out += '|';
      for (const auto name : trace.happens(at)) {
        if (t < n) add(name);
      }
      out += ';';
    }
    return out;
  }
  bool has(const runtime::Trace& trace, Timepoint n) const {
    return by_horizon_[static_cast<std::size_t>(n)].contains(key(trace, n));
  }
  const std::vector<runtime::Trace>& list() const { return list_; }
  bool is_shared(const std::string& name) const { return names_.contains(name); }
  std::size_t shared_events(const runtime::Trace& trace, Timepoint before) const {
    std::size_t count = 0;
    for (Timepoint t = 0; t < before; ++t) {
      for (const auto name : trace.happens(static_cast<std::size_t>(t))) {
        if (names_.contains(std::string(name))) ++count;
      }
    }
    return count;
  }

 private:
  void add(const CompiledModel& model, Timepoint n) {
    runtime::SolverSession session(model, runtime::make_cadical_solver());
    runtime::ModelEnumerator enumerator(session);
    by_horizon_.emplace_back();
    list_.clear();
    while (auto trace = enumerator.next()) {
      by_horizon_.back().insert(key(*trace, n));
      list_.push_back(*std::move(trace));
      if (list_.size() > kLimit) small_ = false;
      if (!small_) return;
    }
  }

  std::set<std::string> names_;
  std::vector<std::set<std::string>> by_horizon_;
  std::vector<runtime::Trace> list_;  // of the last horizon
  bool small_ = true;
};

/// Timepoint of exclusion and number of events of the best witnesses, by going through the lists.
std::optional<std::pair<Timepoint, std::size_t>> best_witness(const FullLists& first,
                                                              const FullLists& second,
                                                              Timepoint horizon) {
  std::optional<std::pair<Timepoint, std::size_t>> best;
  for (const auto& trace : first.list()) {
    for (Timepoint n = 0; n <= horizon; ++n) {
      if (second.has(trace, n)) continue;
      const auto found = std::pair(n, first.shared_events(trace, n));
      best = best ? std::min(*best, found) : found;
      break;
    }
  }
  return best;
}

/// Can the clauses of these origins up to `by` hold together with the trace up to then?
bool allows(const CompiledModel& model, const std::set<std::uint32_t>& origins,
            const runtime::Trace& trace, Timepoint by, const FullLists& lists) {
  if (model.variable_count() == 0) {
    // Its clauses are empty, and no clause over variables could take their place.
    for (std::size_t i = 0; i < model.clauses.size(); ++i) {
      if (origins.contains(model.clause_origins[i])) return false;
    }
    return true;
  }
  auto part = model;
  part.clauses = {};
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const bool kept = model.clause_is_definition[i] || origins.contains(model.clause_origins[i]);
    if (kept) {
      part.clauses.add(model.clauses[i]);
    } else {
      // A clause that says nothing keeps the numbering.
      const auto any = compiler::Literal::positive(1);
      part.clauses.add(std::vector<compiler::Literal>{any, ~any});
    }
  }
  runtime::SolverSession session(part, runtime::make_cadical_solver());
  std::vector<compiler::Literal> observation;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const bool happens = atom.kind == compiler::AtomKind::kHappens;
    if (!happens && atom.kind != compiler::AtomKind::kHoldsAt) return;
    if (*atom.time + (happens ? 1 : 0) > by || !lists.is_shared(atom.name)) return;
    const auto at = static_cast<std::size_t>(*atom.time);
    const auto names = happens ? trace.happens(at) : trace.holds(at);
    const bool is_true = std::count(names.begin(), names.end(), atom.name) != 0;
    observation.push_back(is_true ? atom.literal() : ~atom.literal());
  });
  return session.solve(by, observation) == runtime::SolveStatus::kSatisfiable;
}

struct Seen {
  std::size_t pairs = 0, differ = 0, lost = 0, gained = 0, refined = 0, later = 0, eventful = 0;
};

void check_side(const runtime::OneSided& side, const FullLists& first, const FullLists& second,
                const CompiledModel& other, Timepoint horizon, Seen& seen) {
  std::size_t wanted = 0;
  for (const auto& key : first.traces()) wanted += second.traces().contains(key) ? 0 : 1;
  REQUIRE(side.answer != DifferenceAnswer::kUnknown);
  CHECK((side.answer == DifferenceAnswer::kFound) == (wanted != 0));
  CHECK(side.count.exact);
  CHECK(side.count.value == wanted);
  if (side.refinements != 0) ++seen.refined;
  if (wanted == 0) return;
  REQUIRE(side.witness);
  const auto& witness = *side.witness;
  CHECK(witness.is_shortest);
  CHECK(first.has(witness.trace, horizon));
  CHECK_FALSE(second.has(witness.trace, witness.excluded_by));
  const auto best = best_witness(first, second, horizon);
  CHECK(witness.excluded_by == best->first);
  CHECK(witness.events == best->second);
  CHECK(witness.impossible.has_value() == witness.excluding.empty());
  // The reported axioms contradict the witness, and each of them is needed for that.
  const std::set<std::uint32_t> excluding(witness.excluding.begin(), witness.excluding.end());
  if (!excluding.empty()) {
    CHECK_FALSE(allows(other, excluding, witness.trace, witness.excluded_by, first));
  }
  for (const auto origin : excluding) {
    auto fewer = excluding;
    fewer.erase(origin);
    CHECK(allows(other, fewer, witness.trace, witness.excluded_by, first));
  }
  if (witness.excluded_by > 0) ++seen.later;
  if (witness.events > 0) ++seen.eventful;
}

void compare(const CompiledModel& first, const CompiledModel& second, Seen& seen) {
  const FullLists a(first, second), b(second, first);
  if (!a.is_small() || !b.is_small()) return;
  runtime::DifferenceOptions options;
  options.list_limit = kLimit + 1;
  const auto difference = runtime::compare_traces(first, second, options);
  ++seen.pairs;
  check_side(difference.lost, a, b, second, difference.horizon, seen);
  check_side(difference.gained, b, a, first, difference.horizon, seen);
  const bool lost = difference.lost.answer == DifferenceAnswer::kFound;
  const bool gained = difference.gained.answer == DifferenceAnswer::kFound;
  seen.lost += lost ? 1 : 0;
  seen.gained += gained ? 1 : 0;
  seen.differ += lost || gained ? 1 : 0;
  // So does who asks for no witness.
  options.counts_only = true;
  const auto numbers = runtime::compare_traces(first, second, options);
  CHECK(numbers.lost.count.value == difference.lost.count.value);
  CHECK(numbers.lost.count.exact == difference.lost.count.exact);
  CHECK(numbers.gained.count.value == difference.gained.count.value);
  CHECK(numbers.gained.count.exact == difference.gained.count.exact);
  CHECK_FALSE(numbers.lost.witness);
  options.counts_only = false;
  // The graphs, where there are some, count the same.
  options.list_limit = 0;
  const auto counted = runtime::compare_traces(first, second, options);
  if (!counted.first_count) return;
  CHECK(counted.first_count->value == a.list().size());
  CHECK(counted.second_count->value == b.list().size());
  CHECK(counted.lost.count.value == difference.lost.count.value);
  CHECK(counted.gained.count.value == difference.gained.count.value);
}

std::string renamed(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace

TEST_CASE("500 random edits: lost and gained are what the full lists say") {
  Seen seen;
  FuzzRandom random(11);
  for (std::uint64_t seed = 1; seen.pairs < 500; ++seed) {
    const auto model = random_model(seed, seed % 4 == 0 ? kSolverSize : kBruteForceSize);
    const TextModel before(model.print());
    if (before.ground == nullptr) continue;
    auto changed = edited(model, random);
    if (random.chance(30)) changed = edited(changed, random);
    const TextModel after(changed.print());
    if (after.ground == nullptr) continue;
    CAPTURE(before.files[base::FileId(0)].text());
    CAPTURE(after.files[base::FileId(0)].text());
    compare(before.compiled, after.compiled, seen);
  }
  // The comparison finds the differences that it is meant to find.
  CHECK(seen.differ > 100);
  CHECK(seen.differ < 450);
  CHECK(seen.lost > 50);
  CHECK(seen.gained > 50);
  CHECK(seen.refined > 5);
  CHECK(seen.later > 50);
  CHECK(seen.eventful > 20);
  MESSAGE(seen.differ << " differ, " << seen.lost << " lose, " << seen.gained << " gain, "
                      << seen.refined << " refined, " << seen.later << " later, " << seen.eventful
                      << " with events");
}

TEST_CASE("models with different names are compared on what they share") {
  Seen seen;
  FuzzRandom random(12);
  for (std::uint64_t seed = 1; seen.pairs < 150; ++seed) {
    const auto model = random_model(seed, kBruteForceSize);
    const TextModel before(model.print());
    if (before.ground == nullptr) continue;
    const auto* from = random.chance(50) ? "F0" : "E0";
    const TextModel after(renamed(edited(model, random).print(), from, "Other"));
    if (after.ground == nullptr) continue;
    CAPTURE(before.files[base::FileId(0)].text());
    CAPTURE(after.files[base::FileId(0)].text());
    compare(before.compiled, after.compiled, seen);
  }
  CHECK(seen.differ > 20);
  CHECK(seen.refined > 5);
}

TEST_CASE("definitions that are not recognised cost calls, not answers") {
  // The auxiliary no longer stands in front of its definition.
  const auto scrambled = [](CompiledModel model) {
    compiler::ClauseList clauses;
    for (std::size_t i = 0; i < model.clauses.size(); ++i) {
      std::vector<compiler::Literal> clause(model.clauses[i].begin(), model.clauses[i].end());
      if (model.clause_is_definition[i]) std::reverse(clause.begin(), clause.end());
      clauses.add(clause);
    }
    model.clauses = std::move(clauses);
    return model;
  };
  Seen seen;
  FuzzRandom random(13);
  for (std::uint64_t seed = 1; seen.pairs < 100; ++seed) {
    const auto model = random_model(seed, kBruteForceSize);
    const TextModel before(model.print()), after(edited(model, random).print());
    if (before.ground == nullptr || after.ground == nullptr) continue;
    CAPTURE(before.files[base::FileId(0)].text());
    CAPTURE(after.files[base::FileId(0)].text());
    compare(scrambled(before.compiled), scrambled(after.compiled), seen);
  }
  CHECK(seen.differ > 20);
}

TEST_CASE("a raised stop flag leaves the answers open") {
  const TextModel before("fluent F()\nrange time 0 1\n"),
      after("fluent F()\nrange time 0 1\nHoldsAt(F(),0).\n");
  const std::atomic<bool> stop{true};
  runtime::DifferenceOptions options;
  options.stop = &stop;
  const auto difference = runtime::compare_traces(before.compiled, after.compiled, options);
  CHECK(difference.lost.answer == DifferenceAnswer::kUnknown);
  CHECK(difference.gained.answer == DifferenceAnswer::kUnknown);
}

TEST_CASE("numbers beyond listing come from the graphs") {
  const std::string switches =
      "sort s\ns A, B\nfluent On(s)\nevent Press(s)\n"
      "[s,time] Initiates(Press(s),On(s),time).\n[s] !HoldsAt(On(s),0).\nrange time 0 40\n";
  const TextModel before(switches);
  const TextModel after(switches + "[time] !Happens(Press(A),time) | !Happens(Press(B),time).\n");
  const auto difference = runtime::compare_traces(before.compiled, after.compiled, {});
  mpz_class four, three;
  mpz_ui_pow_ui(four.get_mpz_t(), 4, 40);
  mpz_ui_pow_ui(three.get_mpz_t(), 3, 40);
  CHECK(difference.lost.count.exact);
  CHECK(difference.lost.count.value == four - three);
  CHECK(difference.gained.answer == DifferenceAnswer::kNone);
  REQUIRE(difference.lost.witness);
  CHECK(difference.lost.witness->excluded_by == 1);
  CHECK(difference.lost.witness->events == 2);
}

}  // namespace parallax::test
