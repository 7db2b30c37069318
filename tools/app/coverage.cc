#include "tools/app/coverage.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/reference/reference_use.h"
#include "harness/campaign/journal.h"
#include "tools/app/coverage_plan.h"
#include "tools/app/file_kind.h"
#include "tools/app/trace_check.h"
#include "tools/app/trace_feed.h"

namespace parallax::tools {
namespace {

using base::DiagnosticCode;
using compiler::FormulaKind;
using compiler::TypedFormulaId;

/// One line, as the file has it; long ones are cut.
std::string one_line(std::string_view text) {
  constexpr std::size_t kMost = 100;
  std::string out;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (!blank) out += c;
    if (blank && !out.empty() && out.back() != ' ') out += ' ';
    if (out.size() > kMost) return out + "...";
  }
  return out;
}

/// What there is to cover in a model, and what a trace covers of it.
class ModelCoverage {
 public:
  /// Both outlive the object, and so does the evaluator.
  ModelCoverage(const compiler::TypedModel& model, const compiler::ReferenceEvaluator& evaluator,
                const base::SourceFiles& files)
      : model_(model), files_(files), use_(evaluator) {
    for (std::size_t i = 0; i < model.symbols.size(); ++i) {
      const auto& symbol = model.symbols[model.symbols.id_at(i)];
      if (symbol.kind == compiler::SymbolKind::kEvent) all_.emplace(event(symbol), "");
    }
    for (std::size_t i = 0; i < model.effects.size(); ++i) all_.emplace(effect(i), effect_text(i));
    for (std::size_t i = 0; i < model.axioms.size(); ++i) {
      axioms_.push_back(axiom(i));
      if (axioms_[i]) all_.emplace(*axioms_[i], text(model.axioms[i].source));
    }
  }

  const std::map<CoverageKey, std::string>& all() const { return all_; }

  std::set<CoverageKey> covered_by(const runtime::Trace& trace) const {
    std::set<CoverageKey> covered;
    for (std::size_t t = 0; t < trace.points.size(); ++t) {
      for (const auto name : trace.happens(t)) {
        const auto symbol = model_.find_symbol(name.substr(0, name.find('(')));
        if (symbol) covered.insert(event(model_.symbols[*symbol]));
      }
    }
    const auto used = use_.of(valuation_of(trace));
    for (const auto i : used.effects) covered.insert(effect(i));
    for (const auto i : used.axioms) {
      if (axioms_[i]) covered.insert(*axioms_[i]);
    }
    return covered;
  }

 private:
  std::string text(const base::SourceRange& range) const { return one_line(files_.text(range)); }
  std::string effect_text(std::size_t i) const { return text(model_.effects[i].source); }

  CoverageKey event(const compiler::Symbol& symbol) const {
    return coverage_key(CoverageGroup::kEvents, symbol.declared, symbol.name, files_);
  }
  CoverageKey effect(std::size_t i) const {
    const auto& axiom = model_.effects[i];
    const auto* kind = "releases";
    if (axiom.kind == compiler::EffectKind::kInitiates) kind = "initiates";
    if (axiom.kind == compiler::EffectKind::kTerminates) kind = "terminates";
    return coverage_key(CoverageGroup::kAxioms, axiom.source, kind, files_);
  }

  bool speaks_of_events(TypedFormulaId root) const {
    std::vector<TypedFormulaId> open = {root};
    while (!open.empty()) {
      const auto& formula = model_.formulas[open.back()];
      open.pop_back();
      if (formula.kind == FormulaKind::kAtom && formula.predicate == model_.core.happens) {
        return true;
      }
      open.insert(open.end(), formula.children.begin(), formula.children.end());
    }
    return false;
  }

  std::optional<CoverageKey> axiom(std::size_t i) const {
    const auto& axiom = model_.axioms[i];
    if (axiom.is_foundation || !speaks_of_events(axiom.formula)) return std::nullopt;
    auto root = axiom.formula;
    while (model_.formulas[root].kind == FormulaKind::kForall) {
      root = model_.formulas[root].children.front();
    }
    const auto& formula = model_.formulas[root];
    const bool conditional = formula.kind == FormulaKind::kImplies;
    const bool asks = conditional && speaks_of_events(formula.children.front());
    const bool brings = conditional && !asks;
    return coverage_key(CoverageGroup::kAxioms, axiom.source,
                        asks     ? "precondition"
                        : brings ? "trigger"
                                 : "events",
                        files_);
  }

  const compiler::TypedModel& model_;
  const base::SourceFiles& files_;
  compiler::ReferenceUse use_;
  std::vector<std::optional<CoverageKey>> axioms_;  // none: it says nothing of events
  std::map<CoverageKey, std::string> all_;
};

bool same_trace(const harness::CampaignTrace& a, const harness::CampaignTrace& b) {
  if (a.key != b.key || a.points.size() != b.points.size()) return false;
  for (std::size_t t = 0; t < a.points.size(); ++t) {
    if (a.holds(t) != b.holds(t) || a.happens(t) != b.happens(t)) return false;
  }
  return true;
}

/// The traces of the model that the run's are numbered by.
struct ListedTraces {
  std::vector<harness::CampaignTrace> traces;
  bool all = false;
};

/// At least those of the journal. A journal does not say whether it ran every hit, or every initial
/// state: what it has tells. None: the model has no such traces.
std::optional<ListedTraces> list_traces(const compiler::CompiledModel& model,
                                        const harness::JournalText& journal, std::int64_t limit,
                                        Context& context) {
  const auto last = journal.traces.empty() ? std::int64_t{0} : journal.traces.rbegin()->first;
  for (const bool split : {false, true}) {
    for (const bool all_hits : {false, true}) {
      EnumeratedTraces feed(model, context, {.all_hits = all_hits, .split_initial = split});
      ListedTraces listed;
      bool fits = true;
      while (fits) {
        const auto count = static_cast<std::int64_t>(listed.traces.size());
        if (limit > 0 && count >= std::max(limit, last)) break;
        const auto before = context.sink();
        auto trace = feed.next();
        if (!trace && count < last) return std::nullopt;
        if (!trace) {
          context.sink() = before;  // behind the last one that was simulated
          break;
        }
        if (!*trace) {
          listed.all = !context.stopped();
          break;
        }
        const auto recorded = journal.traces.find((*trace)->number);
        fits = recorded == journal.traces.end() || same_trace(*recorded->second.trace, **trace);
        listed.traces.push_back(**std::move(trace));
      }
      fits = fits && static_cast<std::int64_t>(listed.traces.size()) >= last;
      if (fits || context.stopped()) return listed;
    }
  }
  return std::nullopt;
}

class Collector {
 public:
  Collector(const CoverageOptions& options, Context& context)
      : options_(options), context_(context) {}

  base::Status add(const std::string& folder) {
    auto& sink = context_.sink();
    if (!expect_kind(folder, {FileKind::kRun}, "the folder of a run", context_)) {
      return sink.already_reported();
    }
    const auto journal = harness::read_journal(folder, context_.files(), sink);
    if (!journal) return sink.already_reported();
    if (!journal->header) return sink.error_about(DiagnosticCode::kNoJournal, folder);
    if (journal->header->options.find("\"execution\":\"closed-loop\"") != std::string::npos) {
      return sink.error_about(DiagnosticCode::kUsage, folder,
                              "the run was made in closed loop; coverage is of open-loop runs");
    }
    for (const auto& [key, record] : journal->samples) {
      const auto run = harness::recorded_run(*journal, {std::get<0>(key), std::get<1>(key)});
      if (!require_trace(folder, run, sink)) return sink.already_reported();
      break;
    }
    const auto loaded = load_recorded_scenario({folder, options_.scenario}, *journal->header,
                                               ScenarioUse::kRun, context_);
    if (!loaded || !check(*loaded, *journal)) return sink.already_reported();
    return add(*loaded, *journal);
  }

  Coverage take() { return std::move(coverage_); }

 private:
  /// One simulation of each trace, as `replay` looks at it.
  base::Status check(const ScenarioModel& loaded, const harness::JournalText& journal) {
    std::set<std::int64_t> seen;
    for (const auto& [key, record] : journal.samples) {
      if (!seen.insert(std::get<0>(key)).second) continue;
      const auto run = harness::recorded_run(journal, {std::get<0>(key), std::get<1>(key)});
      if (!check_recorded_run(loaded, run, context_)) return context_.sink().already_reported();
    }
    return base::Unit{};
  }

  base::Status add(const ScenarioModel& loaded, const harness::JournalText& journal) {
    auto& sink = context_.sink();
    const auto& compilation = loaded.compilation;
    const auto listed = list_traces(compilation.model, journal, options_.limit, context_);
    if (!listed) {
      if (sink.has_errors()) return sink.already_reported();
      return sink.error(DiagnosticCode::kForeignJournalLine, journal.trace_places.begin()->second,
                        "the model has no such trace");
    }
    compiler::ReferenceLimits limits;
    limits.stop = &context_.stop();
    const compiler::ReferenceEvaluator evaluator(*compilation.typed, limits);
    if (const auto reason = evaluator.refusal()) {
      return sink.error_about(DiagnosticCode::kCheckGivenUp, "", 1, *reason);
    }
    const ModelCoverage model(*compilation.typed, evaluator, context_.files());
    std::optional<PlanCoverage> plan;
    if (compilation.plan) plan.emplace(*compilation.plan, *compilation.typed, context_.files());

    // The same scenario may have several runs: its traces count once.
    const auto& name = loaded.scenario.name;
    const bool is_new = std::find(coverage_.scenarios.begin(), coverage_.scenarios.end(), name) ==
                        coverage_.scenarios.end();
    if (is_new) coverage_.scenarios.push_back(name);
    for (const auto& [key, text] : model.all()) coverage_.items[key].text = text;
    if (plan) {
      for (const auto& key : plan->all()) coverage_.items[key];
    }
    ++coverage_.runs;
    coverage_.all_traces = coverage_.all_traces && listed->all;
    const auto simulated = simulations(journal);
    for (const auto& trace : listed->traces) {
      if (context_.stopped()) break;
      auto covered = model.covered_by(trace);
      if (plan) covered.merge(plan->covered_by(trace));
      covered.insert({CoverageGroup::kTraces, name, 1, 1, trace.key});
      const auto found = simulated.find(trace.number);
      const auto hits = found == simulated.end() ? 0 : found->second;
      coverage_.simulations += hits;
      for (const auto& key : covered) {
        auto& count = coverage_.items[key];
        count.hits += hits;
        if (is_new) ++count.traces;
      }
    }
    return base::Unit{};
  }

  /// By trace. Losses show nothing, and repetitions nothing new.
  static std::map<std::int64_t, std::int64_t> simulations(const harness::JournalText& journal) {
    std::map<std::int64_t, std::int64_t> counts;
    for (const auto& [key, record] : journal.samples) {
      const bool counts_as_one = std::get<2>(key) == harness::DrawPhase::kCertify &&
                                 record.status == harness::SampleStatus::kOk;
      if (counts_as_one) ++counts[std::get<0>(key)];
    }
    return counts;
  }

  const CoverageOptions& options_;
  Context& context_;
  Coverage coverage_;
};

}  // namespace

base::Result<Coverage> coverage_of(const CoverageOptions& options, Context& context) {
  Collector collector(options, context);
  for (const auto& folder : options.folders) {
    if (!collector.add(folder)) return context.sink().already_reported();
  }
  return collector.take();
}

}  // namespace parallax::tools
