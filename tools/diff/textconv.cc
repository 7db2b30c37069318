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
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/compare/model_facts.h"
#include "compiler/syntax/parser.h"
#include "harness/campaign/journal.h"
#include "tools/diff/revision.h"
#include "tools/diff/trace_set.h"

namespace parallax::tools {

using compiler::Fact;
using compiler::FactKind;

namespace {

namespace fs = std::filesystem;
using SortedJson = nlohmann::json;

/// A text as it is, anything else as JSON.
std::string word(const SortedJson& value) {
  return value.is_string() ? value.get<std::string>() : base::json_text(value);
}

std::string joined(const SortedJson& list) {
  std::string out;
  if (!list.is_array()) return word(list);
  for (const auto& item : list) out += (out.empty() ? "" : ", ") + word(item);
  return out;
}

const SortedJson& field(const SortedJson& object, const char* name) {
  static const SortedJson kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(name);
  return found == object.end() ? kNothing : *found;
}

class ReportReader {
 public:
  ReportReader(const SortedJson& report, std::string file)
      : report_(report), file_(std::move(file)) {}

  std::vector<Fact> run() {
    for (const auto* name : {"scenario", "seed", "tool_version", "simulator", "criterion"}) {
      add(FactKind::kDeclaration, name, word(field(report_, name)));
    }
    for (const auto* name : {"verdict", "exploration", "simulations"}) {
      add(FactKind::kAxiom, name, word(field(report_, name)));
    }
    const auto& traces = field(report_, "traces");
    for (std::size_t i = 0; traces.is_array() && i < traces.size(); ++i) add_trace(traces[i]);
    const auto& found = field(report_, "discrepancies");
    for (std::size_t i = 0; found.is_array() && i < found.size(); ++i) add_discrepancy(found[i]);
    return std::move(facts_);
  }

 private:
  void add(FactKind kind, const std::string& key, const std::string& rest) {
    const auto text = key + ": " + rest;
    facts_.push_back({kind, key, text, text, {file_, 0}});
  }

  void add_trace(const SortedJson& trace) {
    const auto name = fmt::format("trace [{}] from [{}]", joined(field(trace, "events")),
                                  joined(field(trace, "initial_state")));
    names_[word(field(trace, "trace"))] = name;
    const auto& certified = field(trace, "certified");
    add(FactKind::kAxiom, name,
        fmt::format("{}, {} simulations, {} clean, confidence {} that p < {}",
                    word(field(trace, "verdict")), word(field(trace, "simulations")),
                    word(field(trace, "clean")), word(field(certified, "confidence")),
                    word(field(certified, "epsilon"))));
  }

  static std::vector<std::string> texts(const SortedJson& fluents) {
    std::vector<std::string> out;
    for (std::size_t i = 0; fluents.is_array() && i < fluents.size(); ++i) {
      out.push_back(
          fmt::format("{} at {} predicted {}, observed {}", word(field(fluents[i], "fluent")),
                      word(field(fluents[i], "timepoint")), word(field(fluents[i], "predicted")),
                      word(field(fluents[i], "observed"))));
    }
    return out;
  }

  void add_discrepancy(const SortedJson& found) {
    const auto trace = names_.find(word(field(found, "trace")));
    auto differing = texts(field(found, "first"));
    // The last state's may be the same ones.
    for (auto& text : texts(field(found, "fluents"))) {
      if (std::find(differing.begin(), differing.end(), text) == differing.end()) {
        differing.push_back(std::move(text));
      }
    }
    const auto kind = word(field(found, "kind"));
    add(FactKind::kAxiom,
        "discrepancy in " + (trace == names_.end() ? word(field(found, "trace")) : trace->second),
        fmt::format("{}first at {}: {}", kind == "transient" ? "transient, " : "",
                    word(field(found, "first_divergence")), fmt::join(differing, "; ")));
  }

  const SortedJson& report_;
  const std::string file_;
  std::map<std::string, std::string> names_;  // by number
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
  const auto report = base::parse_json(*text);
  if (report.is_discarded() || !report.is_object()) return refuse("it is no JSON object");
  if (!field(report, "verdict").is_string() || !field(report, "traces").is_array()) {
    return refuse("it has no `verdict` and `traces`");
  }
  return text;
}

base::Result<std::vector<Fact>> load_run_facts(const std::string& path, Context& context) {
  const auto text = load_run_report(path, context);
  if (!text) return context.sink().already_reported();
  const auto file = report_file(path);
  const auto report = base::parse_json(*text);
  auto facts = ReportReader(report, file.string()).run();
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
