#include "tests/fuzz/differential.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "compiler/base/codes/grounding.h"
#include "runtime/optimize/optimum.h"
#include "tests/fuzz/old_encoder.h"
#include "tests/fuzz/oracles.h"

namespace parallax::test {
namespace {

using Keys = std::set<std::string>;

Comparison difference(std::string sides, std::string detail) {
  return {Comparison::Kind::kDiffer, std::move(sides), std::move(detail), 0, {}};
}

class Comparer {
 public:
  Comparer(const std::string& text, const DifferentialOptions& options)
      : text_(text), options_(options), base_(text, {}) {}

  Comparison run() {
    if (!base_.typed) return refused();
    evaluator_.emplace(*base_.typed);
    if (const auto reason = evaluator_->refusal()) return difference("reference", *reason);
    if (options_.brute_force) brute_ = brute_force_traces(*evaluator_, options_.max_atoms);
    if (options_.clingo) {
      if (auto failure = ask_clingo(false)) return *failure;
    }
    if (!base_.compiled) return confirm_refusal();
    if (auto found = compare_existence()) return *found;
    result_.brute_force = brute_.has_value();
    result_.clingo = clingo_.has_value();
    if (auto found = compare_traces()) return *found;
    if (auto found = compare_exclusions()) return *found;
    if (auto found = compare_export()) return *found;
    if (auto found = compare_optimum()) return *found;
    if (auto found = compare_variants()) return *found;
    return result_;
  }

 private:
  Comparison refused() const {
    return {Comparison::Kind::kRefused, base_.codes(), {}, 0, base_.error_lines()};
  }

  std::optional<Comparison> ask_clingo(bool observable) {
    const auto program =
        compiler::to_asp(*base_.typed, base_.files, {.report_existence = true}, base_.sink);
    if (!program) return difference("export", base_.codes());
    std::string error;
    clingo_ = clingo_traces(*program, options_.max_traces + 1, observable,
                            static_cast<std::size_t>(evaluator_->horizon()), error);
    if (!clingo_) return difference("clingo", error + program->text);
    return std::nullopt;
  }

  bool has_trace() const {
    return (brute_ && !brute_->traces.empty()) || (clingo_ && !clingo_->found.traces.empty());
  }

  /// "This formula is false whatever happens" and "says nothing" can be checked from outside;
  /// errors in a number or a table are taken as they are.
  Comparison confirm_refusal() const {
    const auto codes = base_.codes();
    if (codes == "E3003" && has_trace()) {
      return difference("refusal E3003", "an oracle has a trace");
    }
    if (codes == "E3004" && evaluator_->silent_axioms().empty()) {
      return difference("refusal E3004", "every axiom says something to the reference evaluator");
    }
    if (codes == "E3004" && clingo_ && !clingo_->found.traces.empty() &&
        clingo_->existing_axioms.size() == base_.typed->axioms.size()) {
      return difference("refusal E3004", "every axiom says something to clingo");
    }
    if (codes.find("E3016") != std::string::npos && !evaluator_->expanded().has_circular_effect()) {
      return difference("refusal E3016", "no effect depends on its absence");
    }
    return refused();
  }

  std::optional<Comparison> compare_existence() const {
    if (!evaluator_->silent_axioms().empty()) {
      const auto where = evaluator_->silent_axioms().front();
      return difference("existence, reference evaluator",
                        "says nothing: " + std::string(base_.files.text(where)));
    }
    if (!clingo_ || clingo_->found.traces.empty()) return std::nullopt;
    for (std::size_t i = 0; i < base_.typed->axioms.size(); ++i) {
      if (clingo_->existing_axioms.contains(i)) continue;
      return difference(
          "existence, clingo",
          "says nothing: " + std::string(base_.files.text(base_.typed->axioms[i].source)));
    }
    return std::nullopt;
  }

  static Keys observed(const TraceList& list) {
    Keys all;
    for (const auto& trace : list.traces) all.insert(trace_key(trace, false));
    return all;
  }

  /// The traces with the user predicates that both sides know.
  static Keys in_full(const TraceList& list, const TraceList& other) {
    Keys all;
    for (const auto& trace : list.traces) {
      auto key = trace_key(trace, true);
      for (const auto& name : trace.predicates) {
        if (list.predicates && !list.predicates->contains(name)) continue;
        if (other.predicates && !other.predicates->contains(name)) continue;
        key += " " + name;
      }
      all.insert(std::move(key));
    }
    return all;
  }

  static std::optional<Comparison> same(const std::string& name, const Keys& ours,
                                        const std::string& other_name, const Keys& theirs) {
    for (const auto& key : ours) {
      if (theirs.contains(key)) continue;
      return difference(name + " > " + other_name,
                        "only " + name + " (" + std::to_string(ours.size()) + " against " +
                            std::to_string(theirs.size()) + " traces): " + key);
    }
    for (const auto& key : theirs) {
      if (ours.contains(key)) continue;
      return difference(name + " < " + other_name,
                        "only " + other_name + " (" + std::to_string(theirs.size()) + " against " +
                            std::to_string(ours.size()) + " traces): " + key);
    }
    return std::nullopt;
  }

  std::optional<Comparison> compare_traces() {
    const auto limit = options_.max_traces + 1;
    const auto all = solver_valuations(*base_.compiled, limit);
    const auto enumerated = enumerated_traces(*base_.compiled, limit);
    result_.traces = enumerated.traces.size();
    const auto found_once = observed(enumerated);
    if (found_once.size() != enumerated.traces.size()) {
      return difference("enumerator", "a trace is enumerated twice");
    }
    if (enumerated.complete) {
      const auto counted = counted_traces(*base_.compiled);
      if (counted != std::to_string(enumerated.traces.size())) {
        return difference("count by components",
                          counted + " against " + std::to_string(enumerated.traces.size()));
      }
    }
    if (all.complete) {
      if (auto found = same("enumerator", found_once, "solver", observed(all))) return found;
    }
    if (brute_) {
      if (auto found = against("brute force", all, enumerated, *brute_)) return found;
    }
    if (clingo_ && !clingo_->found.complete) {
      if (auto failure = ask_clingo(true)) return failure;
      if (auto found = against("clingo", {{}, false}, enumerated, clingo_->found)) return found;
    } else if (clingo_) {
      if (auto found = against("clingo", all, enumerated, clingo_->found)) return found;
    }
    if (!enumerated.complete) {
      result_.kind = Comparison::Kind::kPart;
      return check_part(enumerated);
    }
    return std::nullopt;
  }

  /// All atoms where both sides are complete, the observable ones where there are too many.
  std::optional<Comparison> against(const std::string& name, const TraceList& all,
                                    const TraceList& enumerated, const TraceList& theirs) const {
    if (!theirs.complete) return std::nullopt;
    if (all.complete) return same("parallax", in_full(all, theirs), name, in_full(theirs, all));
    if (enumerated.complete) return same("parallax", observed(enumerated), name, observed(theirs));
    if (theirs.traces.size() < enumerated.traces.size()) {
      return difference("parallax > " + name, "parallax has more traces");
    }
    return std::nullopt;
  }

  /// The traces are those of the model without its `mutex` and `xor` statements that satisfy them
  /// as they were parsed. A completion takes the disjunction of `xor` for a reason; then, each
  /// trace satisfies them, and no more is known.
  std::optional<Comparison> compare_exclusions() const {
    if (base_.exclusions.empty()) return std::nullopt;
    const auto satisfied = [&](const compiler::Valuation& trace) {
      return std::all_of(base_.exclusions.begin(), base_.exclusions.end(),
                         [&](const auto& one) { return satisfies(one, *base_.typed, trace); });
    };
    const auto ours = enumerated_traces(*base_.compiled, options_.max_traces + 1);
    for (const auto& trace : ours.traces) {
      if (!satisfied(trace)) {
        return difference("exclusion as stated", "not satisfied in " + trace_key(trace, false));
      }
    }
    const bool is_reason = !base_.typed->completions.empty() &&
                           std::any_of(base_.exclusions.begin(), base_.exclusions.end(),
                                       [](const auto& one) { return one.is_xor; });
    if (is_reason || !ours.complete) return std::nullopt;
    std::string rest = text_;
    for (auto one = base_.exclusions.rbegin(); one != base_.exclusions.rend(); ++one) {
      rest.erase(one->source.begin, one->source.end - one->source.begin);
    }
    const FuzzCompilation free(rest, {});
    if (!free.compiled) return std::nullopt;
    auto all = enumerated_traces(*free.compiled, 20 * options_.max_traces);
    if (!all.complete) return std::nullopt;
    std::erase_if(all.traces, [&](const auto& trace) { return !satisfied(trace); });
    return same("parallax", observed(ours), "exclusion as stated", observed(all));
  }

  /// With the open atoms named, the export has the traces of `--distinct all`, one for one.
  std::optional<Comparison> compare_export() {
    if (!clingo_ || !compiler::has_user_predicates(*base_.typed)) return std::nullopt;
    const auto limit = options_.max_traces + 1;
    const auto ours = solver_valuations(*base_.compiled, limit);
    if (!ours.complete) return std::nullopt;
    compiler::AspOptions asp;
    asp.open_atoms.emplace(ours.predicates->begin(), ours.predicates->end());
    const auto program = compiler::to_asp(*base_.typed, base_.files, asp, base_.sink);
    if (!program) return difference("export", base_.codes());
    std::string error;
    const auto theirs = clingo_traces(*program, limit, false,
                                      static_cast<std::size_t>(evaluator_->horizon()), error);
    if (!theirs) return difference("clingo", error + program->text);
    if (theirs->found.traces.size() != ours.traces.size()) {
      return difference("number of traces over all atoms",
                        std::to_string(ours.traces.size()) + " against " +
                            std::to_string(theirs->found.traces.size()));
    }
    return same("parallax", in_full(ours, ours), "clingo over all atoms",
                in_full(theirs->found, theirs->found));
  }

  /// Costs and gains of events and states, and how often a state changes.
  std::optional<Comparison> compare_optimum() {
    if (!clingo_) return std::nullopt;
    const FuzzCompilation made(text_, {},
                               "sum 1+2*time: Happens(event,time), "
                               "sum 4-3*time: HoldsAt(fluent,time), "
                               "count HoldsAt(fluent,time) & !HoldsAt(fluent,time+1)");
    const bool has_atoms = !base_.compiled->fluents.empty() || !base_.compiled->events.empty();
    if (!has_atoms && made.codes() == "E3017") return std::nullopt;
    if (!made.compiled) return difference("objective", made.codes());
    const auto program = compiler::to_asp(*base_.typed, base_.files, {}, base_.sink);
    if (!program) return difference("export", base_.codes());
    const auto horizon = std::to_string(evaluator_->horizon());
    const auto theirs =
        clingo_optimum(*program, "#minimize{ 1+2*T,e,E,T : happens(E,T), T < " + horizon +
                                     "; 4-3*T,f,F,T : holds_at(F,T); "
                                     "1,c,F,T : holds_at(F,T), not holds_at(F,T+1), T < " +
                                     horizon + " }.");
    if (const auto* failure = std::get_if<std::string>(&theirs)) {
      return difference("clingo", *failure);
    }
    runtime::SolverSession session(*made.compiled, runtime::make_cadical_solver());
    const auto ours = runtime::find_optimum(session);
    const auto& wanted = std::get<std::optional<std::int64_t>>(theirs);
    const auto text = [](bool any, std::int64_t value) {
      return any ? std::to_string(value) : std::string("no trace");
    };
    const auto found = text(ours.witness.has_value(), ours.witness ? ours.values.front() : 0);
    const auto expected = text(wanted.has_value(), wanted.value_or(0));
    if (!ours.proved() || found != expected) {
      return difference("optimum", found + ", clingo: " + expected);
    }
    return std::nullopt;
  }

  std::optional<Comparison> check_part(const TraceList& enumerated) const {
    for (std::size_t i = 0; i < enumerated.traces.size(); i += 10) {
      if (const auto violation = evaluator_->check(enumerated.traces[i])) {
        return difference("parallax > reference evaluator",
                          violation->text + " in " + trace_key(enumerated.traces[i], false));
      }
    }
    return std::nullopt;
  }

  std::optional<Comparison> compare_variants() const {
    const auto variants = ground_variants();
    std::optional<Keys> expected;
    for (const auto& variant : variants) {
      if (variants.size() == 1) break;
      const FuzzCompilation compilation(text_, variant.options);
      // Expanded over all timepoints, a contradiction between them shows while grounding already.
      if (compilation.codes() == "E3003" && expected && expected->empty()) continue;
      // With bounds, a cycle may go through impossible atoms; without, nobody can tell.
      if (compilation.codes() == "E3016" && !variant.options.relevance &&
          evaluator_->expanded().has_circular_effect()) {
        continue;
      }
      if (!compilation.compiled) {
        return difference("grounding " + variant.name, compilation.codes());
      }
      const auto list = enumerated_traces(*compilation.compiled, options_.max_traces + 1);
      auto found = observed(list);
      if (!list.complete && expected && found.size() == expected->size()) continue;
      if (!expected) {
        expected = std::move(found);
      } else if (auto differing = same("grounding " + variants.front().name, *expected,
                                       "grounding " + variant.name, found)) {
        return differing;
      }
    }
    return std::nullopt;
  }

  const std::string& text_;
  const DifferentialOptions& options_;
  FuzzCompilation base_;
  std::optional<compiler::ReferenceEvaluator> evaluator_;
  std::optional<TraceList> brute_;
  std::optional<ClingoAnswer> clingo_;
  Comparison result_;
};

}  // namespace

namespace {

Keys full_keys(const TraceList& list) {
  Keys all;
  for (const auto& trace : list.traces) {
    auto key = trace_key(trace, true);
    for (const auto& name : trace.predicates) key += " " + name;
    all.insert(std::move(key));
  }
  return all;
}

Comparison compare_with_old_encoder(const std::string& text, const DifferentialOptions& options) {
  compiler::GroundOptions ground;
  ground.meaning = compiler::Meaning::kDecreasoner;
  const FuzzCompilation made(text, ground);
  Comparison result;
  if (!made.compiled) {
    return {Comparison::Kind::kRefused, made.codes(), {}, 0, made.error_lines()};
  }
  const auto old = old_encoder_traces(*made.typed, made.exclusions, options.max_traces + 1);
  result.code = old.beyond;
  for (const auto& diagnostic : made.sink.sorted()) {
    if (diagnostic.code == codes::kNamedCompletion) {
      result.code = "completion over named parts";
    }
  }
  if (!result.code.empty()) {
    result.kind = Comparison::Kind::kLeftOut;
    return result;
  }
  const auto all = solver_valuations(*made.compiled, options.max_traces + 1);
  result.traces = all.traces.size();
  if (all.complete != old.found.complete) {
    return difference("number of traces",
                      all.complete ? "the encoder of 2005 has more" : "parallax has more");
  }
  if (!all.complete) {
    result.kind = Comparison::Kind::kPart;
    return result;
  }
  const auto ours = full_keys(all), theirs = full_keys(old.found);
  for (const auto& [mine, other, name] : {std::tuple(&ours, &theirs, "parallax"),
                                          std::tuple(&theirs, &ours, "the encoder of 2005")}) {
    for (const auto& key : *mine) {
      if (other->contains(key)) continue;
      return difference(std::string("only ") + name, std::to_string(ours.size()) + " against " +
                                                         std::to_string(theirs.size()) +
                                                         " traces: " + key);
    }
  }
  return result;
}

}  // namespace

Comparison compare_oracles(const std::string& text, const DifferentialOptions& options) {
  if (options.compat) return compare_with_old_encoder(text, options);
  return Comparer(text, options).run();
}

}  // namespace parallax::test
