#include "tools/diff/textconv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <variant>

#include "compiler/artifact/artifact_reader.h"
#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/contract.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/compare/model_facts.h"
#include "compiler/syntax/parser.h"
#include "harness/campaign/journal.h"
#include "harness/report/run_report.h"
#include "tools/diff/revision.h"
#include "tools/diff/trace_set.h"

namespace parallax::tools {

using compiler::Fact;
using compiler::FactKind;

namespace {

namespace fs = std::filesystem;

/// `null` for a value that is not reported.
std::string word(const std::string& text) { return text.empty() ? "null" : text; }
template <typename T>
std::string word(const std::optional<T>& number) {
  return number ? base::json_text(nlohmann::json(*number)) : "null";
}

class ReportFacts {
 public:
  ReportFacts(const harness::RunReport& report, std::string file)
      : report_(report), file_(std::move(file)) {}

  std::vector<Fact> run() {
    add(FactKind::kDeclaration, "scenario", word(report_.scenario));
    add(FactKind::kDeclaration, "seed", word(report_.seed));
    add(FactKind::kDeclaration, "tool_version", word(report_.tool_version));
    add(FactKind::kDeclaration, "simulator", word(report_.simulator));
    add(FactKind::kDeclaration, "criterion", word(report_.criterion));
    add(FactKind::kAxiom, "verdict", report_.verdict);
    add(FactKind::kAxiom, "exploration", word(report_.exploration));
    add(FactKind::kAxiom, "simulations", word(report_.simulations));
    for (const auto& trace : *report_.traces) add_trace(trace);
    if (!report_.discrepancies) return std::move(facts_);
    for (const auto& found : *report_.discrepancies) add_discrepancy(found.found);
    return std::move(facts_);
  }

 private:
  void add(FactKind kind, const std::string& key, const std::string& rest) {
    const auto text = key + ": " + rest;
    facts_.push_back({kind, key, text, text, {file_, 0}});
  }

  void add_trace(const harness::ReportedTrace& trace) {
    const auto name = fmt::format("trace [{}] from [{}]", fmt::join(trace.events, ", "),
                                  fmt::join(trace.initial_state, ", "));
    names_[trace.number] = name;
    add(FactKind::kAxiom, name,
        fmt::format("{}, {} simulations, {} clean, confidence {} that p < {}", word(trace.verdict),
                    word(trace.simulations), word(trace.clean), word(trace.confidence),
                    word(trace.epsilon)));
  }

  static std::string text_of(const harness::DivergingFluent& fluent) {
    return fmt::format("{} at {} predicted {}, observed {}", fluent.fluent, fluent.timepoint,
                       fluent.predicted, fluent.observed);
  }

  void add_discrepancy(const harness::Discrepancy& found) {
    const auto trace = names_.find(found.trace);
    std::vector<std::string> differing;
    for (const auto& fluent : found.first) differing.push_back(text_of(fluent));
    // The last state's may be the same ones.
    for (const auto& fluent : found.fluents) {
      auto text = text_of(fluent);
      if (std::find(differing.begin(), differing.end(), text) == differing.end()) {
        differing.push_back(std::move(text));
      }
    }
    const bool transient = found.kind == harness::DiscrepancyKind::kTransient;
    add(FactKind::kAxiom,
        "discrepancy in " +
            (trace == names_.end() ? fmt::format("{}", found.trace) : trace->second),
        fmt::format("{}first at {}: {}", transient ? "transient, " : "", found.first_divergence,
                    fmt::join(differing, "; ")));
  }

  const harness::RunReport& report_;
  const std::string file_;
  std::map<std::int64_t, std::string> names_;  // by number
  std::vector<Fact> facts_;
};

/// The hash of the run's scenario, models and plan, from its journal.
std::optional<Fact> texts_fact(const fs::path& folder) {
  base::DiagnosticSink unread;
  const auto journal = base::read_file_of(folder, harness::kJournalName, unread);
  if (!journal) return std::nullopt;
  const auto header =
      harness::decode_header(std::string_view(*journal).substr(0, journal->find('\n')));
  const auto* found = std::get_if<harness::JournalHeader>(&header);
  if (found == nullptr) return std::nullopt;
  const std::string key = "hash of scenario, models and plan";
  const auto text = key + ": " + found->scenario_hash;
  return Fact{
      FactKind::kDeclaration, key, text, text, {(folder / harness::kJournalName).string(), 1}};
}

using Text = base::Result<std::string>;

Text model_text(const std::string& path, Context& context) {
  const auto file = base::load_text(path, context.files(), context.sink());
  if (!file) return context.sink().already_reported();
  const auto ast = compiler::parse_file(*file, context.files(), context.sink());
  if (context.sink().has_errors()) return context.sink().already_reported();
  return canonical_text(compiler::text_facts(ast, context.files()));
}

Text artifact_text(const std::string& path, Context& context) {
  const auto model = compiler::load_artifact(path, context.files(), context.sink());
  if (!model) return context.sink().already_reported();
  return canonical_text(compiler::artifact_facts(*model));
}

Text plan_text(const std::string& path, RevisionKind kind, Context& context) {
  const auto plan = load_plan_revision(path, kind, context);
  if (!plan) return context.sink().already_reported();
  return plan->lisp ? compiler::canonical_plan(*plan->lisp) : canonical_text(plan->facts);
}

}  // namespace

namespace {

fs::path report_file(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? fs::path(path) / "report.json" : fs::path(path);
}

}  // namespace

Text load_run_report(const std::string& path, Context& context) {
  std::error_code error;
  const auto file = report_file(path);
  const auto refuse = [&](const char* why) {
    auto built = context.sink().error_about(codes::kNoJournal, file.string());
    built.note(why);
    return built;
  };
  if (!fs::exists(file, error)) return refuse("there is no such file");
  auto text = file == fs::path(path) ? base::read_file(file, context.sink())
                                     : base::read_file_of(path, "report.json", context.sink());
  if (!text) return context.sink().already_reported();
  const auto report = harness::read_run_report(*text);
  if (!report) return refuse("it is no JSON object");
  if (report->verdict.empty() || !report->traces) {
    return refuse("it has no `verdict` and `traces`");
  }
  return text;
}

base::Result<std::vector<Fact>> load_run_facts(const std::string& path, Context& context) {
  const auto text = load_run_report(path, context);
  if (!text) return context.sink().already_reported();
  const auto file = report_file(path);
  const auto report = harness::read_run_report(*text);
  PARALLAX_REQUIRE(report.has_value(), "a report that was loaded can be read");
  auto facts = ReportFacts(*report, file.string()).run();
  if (auto read = texts_fact(file.parent_path())) facts.push_back(*std::move(read));
  return facts;
}

Text canonical_text_of(const std::string& path, Context& context) {
  const auto kind = kind_of(path);
  if (kind) {
    switch (*kind) {
      case RevisionKind::kModel:
        return model_text(path, context);
      case RevisionKind::kArtifact:
        return artifact_text(path, context);
      case RevisionKind::kPlan:
      case RevisionKind::kBinding:
        return plan_text(path, *kind, context);
      case RevisionKind::kTraces: {
        const auto set = load_trace_set(path, context);
        if (!set) return context.sink().already_reported();
        return canonical_text(*set);
      }
      case RevisionKind::kRun: {
        const auto facts = load_run_facts(path, context);
        if (!facts) return context.sink().already_reported();
        return canonical_text(*facts);
      }
      case RevisionKind::kRates:
      case RevisionKind::kScenario:
        break;
    }
  }
  return context.sink().error_about(
      codes::kUsage, path,
      "there is a canonical text of models (.e, .dec.cnf), plans (.lisp, .bind), trace files "
      "(.jsonl) and runs only");
}

}  // namespace parallax::tools
