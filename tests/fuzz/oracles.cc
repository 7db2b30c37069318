#include "tests/fuzz/oracles.h"

#include <algorithm>

#include "compiler/cnf/encoder.h"
#include "compiler/pipeline/objective.h"
#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"
#include "runtime/enumerate/model_enumerator.h"
#include "runtime/graph/component_traces.h"
#include "tools/app/trace_check.h"

namespace parallax::test {

using compiler::AtomKind;
using compiler::Literal;
using compiler::Valuation;

FuzzCompilation::FuzzCompilation(const std::string& text, const compiler::GroundOptions& options,
                                 const std::string& objective) {
  const auto file = files.add("random.e", text);
  const auto ast = compiler::load_model_text(file, ".", {}, files, sink);
  if (!ast) return;
  compiler::CheckOptions check;
  check.old_reasoner = options.meaning == compiler::Meaning::kDecreasoner;
  auto checked = compiler::check_model(*ast, files, sink, check);
  if (!checked) return;
  typed = std::make_unique<compiler::TypedModel>(*std::move(checked));
  exclusions = stated_exclusions(*ast, *typed);
  std::optional<compiler::CheckedObjective> wanted;
  if (!objective.empty()) {
    const auto place = files.add("objective", objective);
    const auto size = static_cast<std::uint32_t>(objective.size());
    auto sound = compiler::check_objective({place, 0, size}, *typed, files, sink);
    if (!sound) return;
    wanted = *std::move(sound);
  }
  auto ground = compiler::ground_model(*typed, options, sink);
  if (!ground) return;
  compiler::FormulaGrounder grounder(*ground, options, sink);
  if (wanted && !compiler::encode_objective(*wanted, *ground, grounder, sink)) return;
  compiled = compiler::encode(*ground);
}

std::string FuzzCompilation::codes() const {
  std::set<std::string> ids;
  for (const auto& diagnostic : sink.sorted()) {
    const auto& about = base::info(diagnostic.code);
    if (about.severity == base::Severity::kError) ids.emplace(about.id);
  }
  std::string text;
  for (const auto& id : ids) text += (text.empty() ? "" : " ") + id;
  return text;
}

std::set<std::size_t> FuzzCompilation::error_lines() const {
  std::set<std::size_t> lines;
  for (const auto& diagnostic : sink.sorted()) {
    if (base::info(diagnostic.code).severity != base::Severity::kError || !diagnostic.range)
      continue;
    lines.insert(files[diagnostic.range->file].position(diagnostic.range->begin).line);
  }
  return lines;
}

std::vector<GroundVariant> ground_variants() {
  std::vector<GroundVariant> variants(6);
  variants[0].name = "default";
  variants[1].name = "without templates";
  variants[1].options.templates = false;
  variants[2].name = "without relevance";
  variants[2].options.relevance = false;
  variants[3].name = "plain";
  variants[3].options.templates = false;
  variants[3].options.relevance = false;
  variants[4].name = "without unreachable fluents";
  variants[4].options.keep_unreachable = 0;
  variants[5].name = "without what never meets";
  variants[5].options.keep_meetings = 0;
  variants[5].options.least_clique = 3;
  return variants;
}

TraceList solver_valuations(const compiler::CompiledModel& model, std::size_t limit) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  TraceList list;
  const auto points = static_cast<std::size_t>(model.horizon) + 1;
  auto& predicates = list.predicates.emplace();
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.kind == AtomKind::kPredicate) predicates.insert(atom.name);
  });
  while (list.traces.size() < limit) {
    if (session.solve(model.horizon, {}) != runtime::SolveStatus::kSatisfiable) {
      list.complete = true;
      break;
    }
    Valuation trace{std::vector<std::set<std::string>>(points),
                    std::vector<std::set<std::string>>(points),
                    std::vector<std::set<std::string>>(points),
                    {}};
    std::vector<Literal> others;
    model.for_each_atom([&](const compiler::AtomRef& atom) {
      const auto literal = atom.literal();
      const bool value = session.value(literal);
      others.push_back(value ? ~literal : literal);
      if (!value) return;
      const auto kind = atom.kind;
      const auto& name = atom.name;
      const auto t = static_cast<std::size_t>(atom.time.value_or(0));
      if (kind == AtomKind::kHoldsAt) trace.holds[t].insert(name);
      if (kind == AtomKind::kHappens) trace.happens[t].insert(name);
      if (kind == AtomKind::kReleasedAt) trace.released[t].insert(name);
      if (kind == AtomKind::kPredicate) trace.predicates.insert(name);
    });
    list.traces.push_back(std::move(trace));
    session.add_clause(others);
  }
  return list;
}

std::string counted_traces(const compiler::CompiledModel& model) {
  const runtime::ComponentTraces traces(model, runtime::Distinct::kObservable, nullptr);
  return traces.total() ? traces.total()->get_str() : "not counted";
}

TraceList enumerated_traces(const compiler::CompiledModel& model, std::size_t limit) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  TraceList list;
  while (list.traces.size() < limit) {
    const auto trace = enumerator.next();
    if (!trace) {
      list.complete = enumerator.exhausted();
      break;
    }
    list.traces.push_back(tools::valuation_of(*trace));
  }
  return list;
}

namespace {

/// ReleasedAt is settled of most fluents: true where there is no inertia; false, by DEC8 from the
/// start on, where nothing releases. Everything else is open.
std::vector<std::uint32_t> open_atoms(const compiler::ExpandedModel& model,
                                      compiler::ReferenceEvaluator::Values& values) {
  values.assign(model.atom_count(), 0);
  std::vector<bool> settled(model.atom_count(), false);
  for (std::uint32_t f = 0; f < model.fluents().size(); ++f) {
    const auto& symbol = model.symbol_of(f);
    bool open = symbol.manual_release;
    for (std::int64_t t = 0; t < model.horizon(); ++t) {
      for (const auto& row : model.rows(f, t)) {
        open = open || row.kind == compiler::EffectKind::kReleases;
      }
    }
    for (std::int64_t t = 0; t <= model.horizon() && (symbol.noninertial || !open); ++t) {
      values[model.released(f, t)] = symbol.noninertial ? 1 : 0;
      settled[model.released(f, t)] = true;
    }
  }
  std::vector<std::uint32_t> open;
  for (std::uint32_t atom = 0; atom < model.atom_count(); ++atom) {
    if (!settled[atom]) open.push_back(atom);
  }
  return open;
}

Valuation valuation_of(const compiler::ExpandedModel& model,
                       const compiler::ReferenceEvaluator::Values& values) {
  Valuation trace;
  for (std::int64_t t = 0; t <= model.horizon(); ++t) {
    auto& holds = trace.holds.emplace_back();
    auto& happens = trace.happens.emplace_back();
    auto& released = trace.released.emplace_back();
    for (std::uint32_t f = 0; f < model.fluents().size(); ++f) {
      if (values[model.holds(f, t)] != 0) holds.insert(model.fluents()[f]);
      if (values[model.released(f, t)] != 0) released.insert(model.fluents()[f]);
    }
    for (std::uint32_t e = 0; t < model.horizon() && e < model.events().size(); ++e) {
      if (values[model.happens(e, t)] != 0) happens.insert(model.events()[e]);
    }
  }
  for (std::uint32_t atom = 0; atom < model.atom_count(); ++atom) {
    if (!model.timepoint(atom) && values[atom] != 0) {
      trace.predicates.insert(model.atom_text(atom));
    }
  }
  return trace;
}

}  // namespace

std::optional<TraceList> brute_force_traces(const compiler::ReferenceEvaluator& evaluator,
                                            std::size_t max_atoms) {
  compiler::ReferenceEvaluator::Values values;
  const auto open = open_atoms(evaluator.expanded(), values);
  if (open.size() > max_atoms) return std::nullopt;
  TraceList list;
  list.complete = true;
  auto& predicates = list.predicates.emplace();
  const auto& model = evaluator.expanded();
  for (std::uint32_t atom = 0; atom < model.atom_count(); ++atom) {
    if (!model.timepoint(atom)) predicates.insert(model.atom_text(atom));
  }
  for (std::uint64_t bits = 0; bits < (std::uint64_t{1} << open.size()); ++bits) {
    for (std::size_t i = 0; i < open.size(); ++i) {
      values[open[i]] = static_cast<std::uint8_t>((bits >> i) & 1U);
    }
    if (evaluator.accepts(values)) {
      list.traces.push_back(valuation_of(model, values));
    }
  }
  return list;
}

std::string trace_key(const Valuation& trace, bool full) {
  std::string key;
  for (std::size_t t = 0; t < trace.holds.size(); ++t) {
    key += std::to_string(t) + ":";
    for (const auto& name : trace.holds[t]) key += " " + name;
    for (const auto& name : trace.happens[t]) key += " happens " + name;
    if (full) {
      for (const auto& name : trace.released[t]) key += " released " + name;
    }
    key += "; ";
  }
  return key;
}

}  // namespace parallax::test
