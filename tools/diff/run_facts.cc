#include "tools/diff/run_facts.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using SortedJson = nlohmann::json;
using compiler::Fact;
using compiler::FactKind;

/// A text as it is, anything else as JSON.
std::string word(const SortedJson& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
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

  void add_discrepancy(const SortedJson& found) {
    const auto trace = names_.find(word(field(found, "trace")));
    std::string fluents;
    const auto& list = field(found, "fluents");
    for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
      fluents += fmt::format("{}{} at {} predicted {}, observed {}", i == 0 ? "" : "; ",
                             word(field(list[i], "fluent")), word(field(list[i], "timepoint")),
                             word(field(list[i], "predicted")), word(field(list[i], "observed")));
    }
    add(FactKind::kAxiom,
        "discrepancy in " + (trace == names_.end() ? word(field(found, "trace")) : trace->second),
        fmt::format("first at {}: {}", word(field(found, "first_divergence")), fluents));
  }

  const SortedJson& report_;
  const std::string file_;
  std::map<std::string, std::string> names_;  // by number
  std::vector<Fact> facts_;
};

}  // namespace

base::Result<std::vector<Fact>> load_run_facts(const std::string& path, Context& context) {
  std::error_code error;
  const auto file = fs::is_directory(path, error) ? fs::path(path) / "report.json" : fs::path(path);
  const auto refuse = [&](const char* why) {
    auto built = context.sink().error_about(base::DiagnosticCode::kNoJournal, file.string());
    built.note(why);
    return built;
  };
  if (!fs::exists(file, error)) return refuse("there is no such file");
  const auto text = base::read_file(file, context.sink());
  if (!text) return context.sink().already_reported();
  const auto report = SortedJson::parse(*text, nullptr, false);
  if (report.is_discarded() || !report.is_object()) return refuse("it is no JSON object");
  if (!field(report, "verdict").is_string() || !field(report, "traces").is_array()) {
    return refuse("it has no `verdict` and `traces`");
  }
  return ReportReader(report, file.string()).run();
}

}  // namespace parallax::tools
