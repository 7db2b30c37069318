// Optima, compared with every valuation that the reference evaluator accepts: its own numbering,
// its own instances of the objectives, no solver.
#include "runtime/optimize/optimum.h"

#include <algorithm>
#include <map>
#include <set>

#include "compiler/pipeline/compile.h"
#include "compiler/pipeline/objective.h"
#include "compiler/reference/model_expander.h"
#include "runtime/enumerate/model_enumerator.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/model_traces.h"
#include "runtime/graph/trace_count.h"
#include "runtime/optimize/bounded_model.h"
#include "runtime/optimize/core_guided.h"
#include "tests/runtime/enumerate/brute_force.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

using compiler::Timepoint;
using Totals = std::vector<std::int64_t>;

/// `formula` times the weight that `weight` gives for the value of `time`.
struct Part {
  std::string text, formula;
  std::int64_t constant, factor;  // weight = constant + factor * time
};
struct Wanted {
  std::vector<Part> parts;
  std::string text() const {
    std::string out;
    for (const auto& part : parts) out += (out.empty() ? "" : ", ") + part.text;
    return out;
  }
};

const std::vector<Part> kParts = {
    {"count Happens(event,time)", "Happens(event,time)", 1, 0},
    {"count HoldsAt(fluent,time)", "HoldsAt(fluent,time)", 1, 0},
    {"sum 1+time: HoldsAt(fluent,time)", "HoldsAt(fluent,time)", 1, 1},
    {"sum 3-2*time: Happens(event,time)", "Happens(event,time)", 3, -2},
    {"sum -1: HoldsAt(fluent,time)", "HoldsAt(fluent,time)", -1, 0},
    {"count HoldsAt(fluent,time) & !HoldsAt(fluent,time+1)",
     "HoldsAt(fluent,time) & !HoldsAt(fluent,time+1)", 1, 0},
    {"sum 5+3*time: {event} Happens(event,time)", "{event} Happens(event,time)", 5, 3},
    {"sum time-1: {fluent} HoldsAt(fluent,time) & !HoldsAt(fluent,0)",
     "{fluent} HoldsAt(fluent,time) & !HoldsAt(fluent,0)", -1, 1},
    {"count Happens(event,time1) & HoldsAt(fluent,time2) & time1<time2",
     "Happens(event,time1) & HoldsAt(fluent,time2) & time1<time2", 1, 0},
};

/// A compiled model, its texts, and its objectives once more as the reference evaluator sees them.
class Subject {
 public:
  Subject(const std::string& text, const std::vector<Wanted>& wanted,
          const std::optional<std::string>& until = std::nullopt,
          std::optional<std::int64_t> horizon = std::nullopt)
      : wanted_(wanted) {
    compiler::CompileInput input;
    input.text = files_.add("m.e", text);
    input.horizon = horizon;
    const bool bare = horizon.has_value();  // the model alone; the rest is looked at here
    for (const auto& objective : wanted) {
      if (!bare) input.objectives.push_back(add(objective.text()));
    }
    if (until && !bare) {
      const auto range = add(*until);
      input.constraints.push_back({range, range, false});
      input.hits_at_start = true;
    }
    auto compiled = compiler::compile_model(input, files_, sink_);
    if (!compiled) return;
    compilation_ = *std::move(compiled);
    for (const auto& objective : wanted) {
      auto& sums = sums_.emplace_back();
      for (const auto& part : objective.parts) sums.push_back(sum("count " + part.formula));
    }
    if (until) until_ = sum("count " + *until);
    brute_ = std::make_unique<BruteForce>(*compilation_->typed);
    budget_ = std::make_unique<compiler::ReferenceBudget>(50'000'000, nullptr);
    expander_ = std::make_unique<compiler::ModelExpander>(*compilation_->typed, *budget_, own_);
    expander_->begin();
  }

  bool compiled() const { return compilation_.has_value(); }
  const compiler::CompiledModel& model() const { return compilation_->model; }
  BruteForce& brute() { return *brute_; }
  const BruteForce& brute() const { return *brute_; }

  Totals totals(const compiler::ReferenceEvaluator::Values& values) {
    Totals out;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      std::int64_t total = 0;
      for (std::size_t j = 0; j < sums_[i].size(); ++j) {
        const auto& part = wanted_[i].parts[j];
        for (const auto& [time, node] : instances(sums_[i][j])) {
          if (value(node, values)) total += part.constant + part.factor * time;
        }
      }
      out.push_back(total);
    }
    return out;
  }
  /// Does `until` hold at the last timepoint and at none before?
  bool ends_here(const compiler::ReferenceEvaluator::Values& values) {
    std::set<std::int64_t> hits;
    for (const auto& [time, node] : instances(*until_)) {
      if (value(node, values)) hits.insert(time);
    }
    return hits.size() == 1 && hits.contains(brute().evaluator().horizon());
  }
  compiler::ReferenceEvaluator::Values values_of(const runtime::Trace& trace) {
    return brute().evaluator().values_of(tools::valuation_of(trace));
  }
  Totals totals_of(const runtime::Trace& trace) { return totals(values_of(trace)); }

 private:
  using Instances = std::vector<std::pair<std::int64_t, compiler::FormulaTrees::Node>>;

  base::SourceRange add(const std::string& text) {
    const auto file = files_.add("objective", text);
    return {file, 0, static_cast<std::uint32_t>(text.size())};
  }
  compiler::CheckedSum sum(const std::string& text) {
    auto checked = compiler::check_objective(add(text), *compilation_->typed, files_, sink_);
    REQUIRE(checked);
    return checked->sums.front();
  }
  /// Every assignment of the free variables, with the value of `time`.
  const Instances& instances(const compiler::CheckedSum& sum) {
    auto [known, added] = instances_.try_emplace(sum.formula.index());
    if (added) expand(sum, 0, 0, known->second);
    return known->second;
  }
  void expand(const compiler::CheckedSum& sum, std::size_t variable, std::int64_t time,
              Instances& out) {
    if (variable == sum.variables.size()) {
      if (const auto node = expander_->instance(sum.formula)) out.emplace_back(time, *node);
      return;
    }
    const auto id = sum.variables[variable];
    const bool is_time = compilation_->typed->variables[id].name == "time";
    for (const auto& value : expander_->values(id)) {
      REQUIRE(expander_->bind(id, value));
      expand(sum, variable + 1, is_time ? std::stoll(value) : time, out);
    }
  }
  /// Both number the timed atoms alike; there are no others in these objectives.
  bool value(compiler::FormulaTrees::Node node,
             const compiler::ReferenceEvaluator::Values& values) const {
    return own_.trees().value(node, values);
  }

  std::vector<Wanted> wanted_;
  base::SourceFiles files_;
  base::DiagnosticSink sink_;
  std::optional<compiler::Compilation> compilation_;
  std::vector<std::vector<compiler::CheckedSum>> sums_;
  std::optional<compiler::CheckedSum> until_;
  std::unique_ptr<BruteForce> brute_;
  std::unique_ptr<compiler::ReferenceBudget> budget_;
  compiler::ExpandedModel own_;
  std::unique_ptr<compiler::ModelExpander> expander_;
  std::map<std::uint32_t, Instances> instances_;
};

std::vector<Wanted> random_objectives(FuzzRandom& random) {
  std::vector<Wanted> out(1 + random.below(2));
  for (auto& objective : out) {
    const auto parts = 1 + random.below(2);
    for (std::size_t i = 0; i < parts; ++i) objective.parts.push_back(random.pick(kParts));
  }
  return out;
}

runtime::Optimum optimum_of(const compiler::CompiledModel& model) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  return runtime::find_optimum(session);
}

bool has_trace(const compiler::CompiledModel& model) {
  if (model.has_constraints) {
    runtime::SolverSession session(model, runtime::make_cadical_solver());
    runtime::PlanEnumerator enumerator(session);
    return enumerator.next().has_value();
  }
  return runtime::count_traces(model, {}).count > 0;
}

TEST_CASE(
    "the optimum is the least value of all valuations, and its traces are those that have it") {
  std::size_t compared = 0, several = 0, without = 0;
  for (std::uint64_t seed = 1; seed <= 700; ++seed) {
    FuzzRandom random(seed * 77);
    Subject subject(random_model(seed, kBruteForceSize).print(), random_objectives(random));
    if (!subject.compiled() || subject.brute().open_atoms() > 14) continue;
    std::map<Totals, std::set<std::string>> all;
    subject.brute().for_each([&](const auto& values) {
      all[subject.totals(values)].insert(signature(subject.brute().valuation(values)));
    });
    CAPTURE(seed);
    const auto found = optimum_of(subject.model());
    REQUIRE(found.proved());
    CHECK(found.none == all.empty());
    if (all.empty()) {
      ++without;
      continue;
    }
    ++compared;
    several += all.size() > 1 ? 1 : 0;
    const auto& [least, best] = *all.begin();
    CHECK(found.values == least);
    CHECK(subject.totals_of(*found.witness) == least);
    CHECK(best.contains(signature(tools::valuation_of(*found.witness))));

    const auto bounded =
        runtime::with_bound(subject.model(), found.values, runtime::BoundKind::kNoWorse);
    REQUIRE(bounded);
    std::set<std::string> listed;
    runtime::ModelTraces traces(*bounded, {});
    while (const auto trace = traces.next()) {
      CHECK(subject.totals_of(*trace) == least);
      listed.insert(signature(tools::valuation_of(*trace)));
    }
    CHECK(listed == best);
    CHECK(runtime::count_traces(*bounded, {}).count == best.size());

    // "Better" is exactly the traces that come before, whatever the values are.
    CHECK_FALSE(has_trace(
        *runtime::with_bound(subject.model(), found.values, runtime::BoundKind::kBetter)));
    for (const auto& [totals, ignored] : all) {
      std::set<std::string> before;
      for (const auto& [other, signatures] : all) {
        if (other < totals) before.insert(signatures.begin(), signatures.end());
      }
      const auto better = runtime::with_bound(subject.model(), totals, runtime::BoundKind::kBetter);
      REQUIRE(better);
      CHECK(runtime::count_traces(*better, {}).count == before.size());
    }
  }
  CHECK(compared > 150);
  CHECK(several > 80);
  CHECK(without > 10);
}

/// The first `n` steps of a trace. Predicates play no part in goals and objectives here.
runtime::Trace beginning(runtime::Trace trace, Timepoint n) {
  trace.points.resize(static_cast<std::size_t>(n) + 1);
  trace.points.back().happens.clear();
  trace.predicates.clear();
  return trace;
}

TEST_CASE("where traces end at a goal, a trace of any length may be the best") {
  const std::vector<std::string> goals = {"{fluent} HoldsAt(fluent,time)",
                                          "{event} Happens(event,time-1)",
                                          "[fluent] HoldsAt(fluent,time)"};
  std::size_t compared = 0, longer = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    FuzzRandom random(seed * 99);
    const auto text = random_model(seed, kBruteForceSize).print();
    const auto objectives = random_objectives(random);
    const auto goal = random.pick(goals);
    Subject whole(text, objectives, goal);
    if (!whole.compiled() || whole.brute().open_atoms() > 14) continue;
    const auto horizon = whole.model().horizon;
    std::vector<std::unique_ptr<Subject>> parts;
    for (Timepoint n = 0; n <= horizon; ++n) {
      parts.push_back(std::make_unique<Subject>(text, objectives, goal, n));
      if (!parts.back()->compiled()) break;
    }
    if (!parts.back()->compiled()) continue;
    std::optional<Totals> least;
    Timepoint least_length = 0;
    // Every trace of the model alone, up to where it first meets the goal.
    runtime::TraceQuery all;
    all.distinct = runtime::Distinct::kAll;
    runtime::ModelTraces traces(parts.back()->model(), all);
    while (const auto trace = traces.next()) {
      for (Timepoint n = 0; n <= horizon; ++n) {
        auto& part = *parts[static_cast<std::size_t>(n)];
        const auto values = part.values_of(beginning(*trace, n));
        if (!part.ends_here(values)) continue;
        const auto totals = part.totals(values);
        if (!least || totals < *least) {
          least = totals;
          least_length = n;
        } else if (totals == *least) {
          least_length = std::min(least_length, n);
        }
      }
    }
    CAPTURE(seed);
    const auto found = optimum_of(whole.model());
    REQUIRE(found.proved());
    CHECK(found.none == !least);
    if (!least) continue;
    ++compared;
    longer += least_length > 1 ? 1 : 0;
    CHECK(found.values == *least);
    CHECK(found.witness->length() == least_length);
    CHECK(
        has_trace(*runtime::with_bound(whole.model(), found.values, runtime::BoundKind::kNoWorse)));
    CHECK_FALSE(
        has_trace(*runtime::with_bound(whole.model(), found.values, runtime::BoundKind::kBetter)));
    auto worse = found.values;
    ++worse.back();
    CHECK(has_trace(*runtime::with_bound(whole.model(), worse, runtime::BoundKind::kBetter)));
  }
  // Few random models say something at every horizon.
  CHECK(compared > 5);
  CHECK(longer > 0);
}

}  // namespace
}  // namespace parallax::test
