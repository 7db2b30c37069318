#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "harness/campaign/journal.h"
#include "tools/app/explain.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

using compiler::AtomKind;
using compiler::Literal;
using compiler::Timepoint;
using nlohmann::json;

/// One discrepancy of report.json; none if the run has none, or not this one.
base::Result<std::optional<json>> find_discrepancy(const std::string& run_dir,
                                                   const std::string& sample,
                                                   base::DiagnosticSink& sink) {
  const auto path = (std::filesystem::path(run_dir) / "report.json").string();
  const auto text = base::read_file(path, sink);
  if (!text) return sink.already_reported();
  const auto report = json::parse(*text, nullptr, false);
  if (!report.is_object() || !report.contains("discrepancies") ||
      !report["discrepancies"].is_array()) {
    return sink.error_about(base::DiagnosticCode::kUsage, path, "this is no report of a run");
  }
  for (const auto& found : report["discrepancies"]) {
    const auto name = fmt::format("{}.{}", found.value("trace", 0), found.value("sample", 0));
    if (sample.empty() || sample == name) return std::optional<json>(found);
  }
  if (!sample.empty()) {
    return sink.error_about(base::DiagnosticCode::kNoSuchSample, run_dir,
                            sample + " with a discrepancy");
  }
  return std::optional<json>();
}

/// The start and the events of the trace, as far as the divergence, and what was seen there.
class Observation {
 public:
  Observation(const compiler::CompiledModel& model, const harness::TraceLine& trace)
      : model_(model), trace_(trace), index_(model) {}

  ObservedRun make(const json& discrepancy) {
    const auto last = discrepancy.value("first_divergence", 0);
    run_.observed.length = std::clamp(last, 0, model_.horizon);
    model_.for_each_atom([&](const compiler::AtomRef& atom) {
      if (!atom.time || *atom.time >= run_.observed.length) return;
      const auto t = static_cast<std::size_t>(*atom.time);
      if (atom.kind == AtomKind::kHappens && t < trace_.events.size()) {
        state(atom.variable, trace_.events[t] == atom.name);
      }
      if (atom.kind == AtomKind::kHoldsAt && t == 0 && !trace_.holds.empty()) {
        const auto& holds = trace_.holds.front();
        state(atom.variable, std::find(holds.begin(), holds.end(), atom.name) != holds.end());
      }
    });
    for (Timepoint t = 0; t < run_.observed.length; ++t) {
      if (static_cast<std::size_t>(t) >= trace_.events.size()) break;
      run_.lines.push_back(
          fmt::format("{} happens at {}", trace_.events[static_cast<std::size_t>(t)], t));
    }
    const auto fluents = discrepancy.value("first", json::array());
    for (const auto& fluent : fluents) see(fluent);
    return std::move(run_);
  }

 private:
  void state(std::int32_t variable, bool value) {
    const auto literal = Literal::positive(variable);
    run_.observed.facts.push_back(value ? literal : ~literal);
  }
  void see(const json& fluent) {
    const auto time = fluent.value("timepoint", 0);
    if (time != run_.observed.length) return;
    const auto name = fluent.value("fluent", std::string());
    const bool observed = fluent.value("observed", false);
    run_.lines.push_back(
        fmt::format("{} {} at {}", name, observed ? "holds" : "does not hold", time));
    const auto atom = index_.find(AtomKind::kHoldsAt, name, time);
    if (atom) run_.observed.facts.push_back(observed ? *atom : ~*atom);
  }

  const compiler::CompiledModel& model_;
  const harness::TraceLine& trace_;
  compiler::AtomIndex index_;
  ObservedRun run_;
};

}  // namespace

base::Result<std::optional<ObservedDiscrepancy>> load_discrepancy(const std::string& run_dir,
                                                                  const std::string& sample,
                                                                  Context& context) {
  auto& sink = context.sink();
  // The journal is no source of the scenario: it is read into a set of its own.
  base::SourceFiles journal_files;
  const auto journal = harness::read_journal(run_dir, journal_files, sink);
  if (!journal) return sink.already_reported();
  const auto discrepancy = find_discrepancy(run_dir, sample, sink);
  if (!discrepancy) return sink.already_reported();
  if (!*discrepancy || !journal->header) return std::optional<ObservedDiscrepancy>();
  auto loaded = load_plain_scenario(journal->header->scenario, context);
  if (!loaded) return sink.already_reported();
  if (loaded->sources_hash != journal->header->scenario_hash) {
    return sink.error_about(base::DiagnosticCode::kJournalMismatch, run_dir, "scenario_hash",
                            journal->header->scenario_hash, loaded->sources_hash);
  }
  const auto trace = journal->traces.find((*discrepancy)->value("trace", 0));
  if (trace == journal->traces.end()) {
    return sink.error_about(base::DiagnosticCode::kNoSuchSample, run_dir, "of this trace");
  }
  auto run = Observation(loaded->compilation.model, trace->second).make(**discrepancy);
  return std::optional(ObservedDiscrepancy{*std::move(loaded), std::move(run)});
}

}  // namespace parallax::tools
