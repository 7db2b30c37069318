#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/campaign/journal.h"
#include "tools/app/explain.h"

namespace parallax::tools {
namespace {

using compiler::AtomKind;
using compiler::Literal;
using compiler::Timepoint;
using nlohmann::json;

/// A discrepancy as report.json has it.
struct ReportedDiscrepancy {
  struct Fluent {
    std::string name;
    std::int64_t timepoint = 0;
    bool observed = false;
  };
  std::int64_t trace = 0, sample = 0, first_divergence = 0;
  std::vector<Fluent> first;  // that differed there

  std::string id() const { return fmt::format("{}.{}", trace, sample); }
};

/// None if an entry is none that `parallax run` writes.
std::optional<ReportedDiscrepancy> decode(const json& entry) {
  const auto integer = [](const json& object, const char* name) {
    const auto* value = base::json_member(object, name);
    return value == nullptr ? std::nullopt : base::json_as<std::int64_t>(*value);
  };
  const auto trace = integer(entry, "trace"), sample = integer(entry, "sample"),
             divergence = integer(entry, "first_divergence");
  const auto* first = base::json_member(entry, "first");
  if (!trace || !sample || !divergence || *divergence < 0 || first == nullptr ||
      !first->is_array()) {
    return std::nullopt;
  }
  ReportedDiscrepancy out{*trace, *sample, *divergence, {}};
  for (const auto& fluent : *first) {
    const auto time = integer(fluent, "timepoint");
    const auto *name = base::json_member(fluent, "fluent"),
               *observed = base::json_member(fluent, "observed");
    if (!time || name == nullptr || !name->is_string() || observed == nullptr ||
        !observed->is_boolean()) {
      return std::nullopt;
    }
    out.first.push_back({name->get<std::string>(), *time, observed->get<bool>()});
  }
  return out;
}

/// One discrepancy of report.json; none if the run has none. Reports one that is not there.
base::Result<std::optional<ReportedDiscrepancy>> find_discrepancy(const std::string& run_dir,
                                                                  const std::string& sample,
                                                                  base::DiagnosticSink& sink) {
  const auto path = (std::filesystem::path(run_dir) / "report.json").string();
  const auto text = base::read_file(path, sink);
  if (!text) return sink.already_reported();
  const auto report = json::parse(*text, nullptr, false);
  const auto refuse = [&] {
    return sink.error_about(base::DiagnosticCode::kUsage, path, "this is no report of a run");
  };
  const auto* list = base::json_member(report, "discrepancies");
  if (list == nullptr || !list->is_array()) return refuse();
  std::string others;
  for (const auto& entry : *list) {
    auto found = decode(entry);
    if (!found) return refuse();
    if (sample.empty() || sample == found->id()) return std::optional(*std::move(found));
    others += (others.empty() ? "" : ", ") + found->id();
  }
  if (sample.empty()) return std::optional<ReportedDiscrepancy>();
  return sink
      .error_about(base::DiagnosticCode::kNoSuchSample, run_dir, sample + " with a discrepancy")
      .note(others.empty() ? "the run found no discrepancy"
                           : "it found discrepancies in " + others);
}

/// The start and the events of the trace, as far as the divergence, and what was seen there.
class Observation {
 public:
  Observation(const compiler::CompiledModel& model, const harness::TraceLine& trace)
      : model_(model), trace_(trace), index_(model) {}

  ObservedRun make(const ReportedDiscrepancy& discrepancy) {
    run_.observed.length = static_cast<Timepoint>(
        std::min(discrepancy.first_divergence, std::int64_t{model_.horizon}));
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
    for (const auto& fluent : discrepancy.first) see(fluent);
    return std::move(run_);
  }

 private:
  void state(std::int32_t variable, bool value) {
    const auto literal = Literal::positive(variable);
    run_.observed.facts.push_back(value ? literal : ~literal);
  }
  void see(const ReportedDiscrepancy::Fluent& fluent) {
    const auto time = run_.observed.length;
    if (fluent.timepoint != time) return;
    run_.lines.push_back(
        fmt::format("{} {} at {}", fluent.name, fluent.observed ? "holds" : "does not hold", time));
    const auto atom = index_.find(AtomKind::kHoldsAt, fluent.name, time);
    if (atom) run_.observed.facts.push_back(fluent.observed ? *atom : ~*atom);
  }

  const compiler::CompiledModel& model_;
  const harness::TraceLine& trace_;
  compiler::AtomIndex index_;
  ObservedRun run_;
};

}  // namespace

base::Result<std::optional<ObservedDiscrepancy>> load_discrepancy(const RunFolderOptions& folder,
                                                                  const std::string& sample,
                                                                  Context& context) {
  auto& sink = context.sink();
  const auto journal = harness::read_journal(folder.folder, context.files(), sink);
  if (!journal) return sink.already_reported();
  const auto discrepancy = find_discrepancy(folder.folder, sample, sink);
  if (!discrepancy) return sink.already_reported();
  if (!*discrepancy || !journal->header) return std::optional<ObservedDiscrepancy>();
  auto loaded = load_recorded_scenario(folder, *journal->header, ScenarioUse::kExplain, context);
  if (!loaded) return sink.already_reported();
  const auto trace = journal->traces.find((*discrepancy)->trace);
  if (trace == journal->traces.end()) {
    return sink
        .error_about(base::DiagnosticCode::kNoSuchSample, folder.folder, (*discrepancy)->id())
        .note("report.json tells of it, the journal does not");
  }
  auto run = Observation(loaded->compilation.model, trace->second).make(**discrepancy);
  return std::optional(ObservedDiscrepancy{*std::move(loaded), std::move(run)});
}

}  // namespace parallax::tools
