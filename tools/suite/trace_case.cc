#include "tools/suite/trace_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <system_error>

#include "compiler/base/clock_time.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/whole_number.h"
#include "compiler/base/words.h"
#include "tools/app/plan_reservations.h"
#include "tools/suite/case_process.h"
#include "tools/suite/expectation.h"
#include "tools/suite/golden_witness.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

/// One trace more than expected; 0, for all, if the expected number is unknown.
std::int64_t one_too_many(const harness::TraceExpectation& expect) {
  if (expect.traces) return *expect.traces + 1;
  base::DiagnosticSink unread;
  const auto golden = base::read_file(expect.golden->text, unread);
  const auto listed = golden ? listed_traces(*golden) : std::nullopt;
  return listed ? *listed + 1 : 0;
}

enum class StatedConstraints : std::uint8_t { kCount, kIgnored };

/// Options for every process of the case: horizon, constraints, limits, permissions, models.
CommandWords model_words(const harness::ManifestCase& one, const RunnerOptions& options,
                         StatedConstraints constraints = StatedConstraints::kCount) {
  CommandWords command;
  auto& words = command.options;
  for (const auto& constraint : one.constraints) {
    if (constraints == StatedConstraints::kIgnored) break;
    words.push_back("--until=" + constraint.text);  // also one that begins with `-`
  }
  if (one.horizon) words.insert(words.end(), {"--horizon", std::to_string(*one.horizon)});
  if (!options.ends_early) {
    words.insert(words.end(), {"--time-limit", fmt::format("{}", one.time_limit_s)});
  }
  if (one.memory_limit_mb) {
    words.insert(words.end(), {"--memory-limit", std::to_string(*one.memory_limit_mb)});
  }
  words.insert(words.end(), {"--quiet", "--color=never"});
  add_permissions(options, false, words);
  for (const auto& model : one.models) command.files.push_back(model.text);
  return command;
}

CommandWords traces_command(const harness::ManifestCase& one, const RunnerOptions& options) {
  auto command = model_words(one, options);
  auto limit = one.expect.complete ? 0 : one.expect.traces.value_or(0);
  if (options.ends_early && one.expect.complete) limit = one_too_many(one.expect);
  command.options.insert(command.options.begin(), {"traces", "--limit", std::to_string(limit)});
  return command;
}

/// Notes that an answer is as expected as far as the plan's executions were explored, by the fields
/// in which `traces` and `verify` tell that they were not all. False: nothing is left out.
bool note_reservation(const nlohmann::json& found, const std::string& said,
                      std::vector<std::string>& open) {
  PlanReservations left_out;
  left_out.orders = !found.value("every_order", true);
  left_out.meaning = found.value("approximated", false);
  left_out.cut = found.value("cut", false);
  if (!left_out.any()) return false;
  open.push_back(fmt::format("{}, but that is {}", said, left_out.words()));
  return true;
}

/// Compares the document of `parallax traces --json` with the expected number. `open`: gets what it
/// leaves open.
void compare_count(const harness::TraceExpectation& expect, const std::string& document,
                   std::vector<std::string>& open, CaseResult& result) {
  const auto found = base::parse_json(document);
  if (found.is_discarded() || !found.is_object() || found.value("status", "") != "ok") {
    result.problems.push_back("the program printed no result");
    return;
  }
  const auto traces = found.value("traces", std::int64_t{-1});
  // A case only asks for completeness up to the horizon.
  const bool complete = found.value("exploration", "stopped") != "stopped";
  const auto phrase = [](std::int64_t count, bool all) {
    return fmt::format("{}{}", base::counted(count, "trace"), all ? "" : " and more");
  };
  if (traces == *expect.traces && complete == expect.complete) {
    if (complete) (void)note_reservation(found, phrase(traces, true), open);
    return;
  }
  result.problems.push_back(fmt::format("{}, expected {}", phrase(traces, complete),
                                        phrase(*expect.traces, expect.complete)));
}

/// Adds the axioms that contradict each other, for a model without traces.
void add_blame(const harness::ManifestCase& one, const std::string& document,
               const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
               CaseResult& result) {
  const auto found = base::parse_json(document);
  if (!found.is_object() || found.value("traces", std::int64_t{-1}) != 0) return;
  CommandWords words;
  if (one.horizon) words.options = {"--horizon", std::to_string(*one.horizon)};
  for (const auto& model : one.models) words.files.push_back(model.text);
  auto why = blame(explanation_of(std::move(words), one.time_limit_s, options, footprint, stop));
  if (!why.empty()) result.problems.push_back("these contradict each other:\n" + why);
}

/// Is this output of `parallax traces`, so that a newer list may replace it?
bool is_list_of_traces(std::string_view text) {
  return text.find_last_not_of('\n') == std::string_view::npos || listed_traces(text);
}

/// Why the golden file must not be written; empty: it may. Manifests come from others, so a golden
/// file must replace no model, no manifest and no file that other programs read.
std::string unfit_for_golden(const std::string& path, const fs::path& folder,
                             const base::Result<std::string>& text) {
  if (!base::lies_below(path, folder)) return "does not lie below the manifest's folder";
  const auto inside = base::real_path(path).lexically_relative(base::real_path(folder));
  for (const auto& part : inside) {
    if (part.string().starts_with('.')) return "is hidden, or lies in a hidden folder";
  }
  if (!text) return "cannot be read";
  if (!is_list_of_traces(*text)) return "is there already and holds no list of traces";
  return {};
}

/// Names the axiom that excludes an expected trace.
std::string why_lost(const harness::ManifestCase& one, const ListedTrace& lost,
                     const RunnerOptions& options, Footprint& footprint,
                     const std::atomic<bool>& stop) {
  const auto line = jsonl_of(lost);
  const auto file = footprint.file() + ".jsonl";
  base::DiagnosticSink unread;
  if (line.empty() || !base::write_file_atomically(file, line, unread)) return {};
  auto words = model_words(one, options);
  words.options.insert(words.options.begin(),
                       {"traces", "--json", "--other-model", "--replay", file});
  const auto child = run_this_program(words, footprint, stop);
  std::error_code error;
  fs::remove(file, error);
  return refusal_of(child.out);
}

/// Names a lost trace with the axiom that excludes it, and a gained one.
void add_witnesses(const harness::ManifestCase& one, const std::string& golden,
                   const std::string& found, const RunnerOptions& options, Footprint& footprint,
                   const std::atomic<bool>& stop, CaseResult& result) {
  const auto difference = list_difference(golden, found);
  if (difference.lost) {
    auto text = fmt::format("lost: trace {} of {}\n{}", difference.lost->number,
                            one.expect.golden->text, difference.lost->text);
    text += why_lost(one, *difference.lost, options, footprint, stop);
    result.problems.push_back(std::move(text));
  }
  if (difference.gained) {
    auto text =
        fmt::format("gained: trace {}\n{}", difference.gained->number, difference.gained->text);
    text.pop_back();  // its last line end
    result.problems.push_back(std::move(text));
  }
}

void compare_golden(const std::string& path, const std::string& text, const fs::path& manifest,
                    bool update, CaseResult& result) {
  base::DiagnosticSink sink;
  std::error_code error;
  const bool exists = fs::exists(path, error);
  const auto expected = exists ? base::read_file(path, sink) : base::Result<std::string>("");
  if (exists && expected && *expected == text) return;
  if (update && result.problems.empty()) {
    const auto unfit = unfit_for_golden(path, manifest.parent_path(), expected);
    if (!unfit.empty()) {
      result.problems.push_back(fmt::format("{} {}, so it is not written", path, unfit));
      return;
    }
    fs::create_directories(fs::path(path).parent_path(), error);
    if (base::write_file_atomically(path, text, sink)) {
      result.golden_written = path;
    } else {
      result.problems.push_back(fmt::format("cannot write {}", path));
    }
    return;
  }
  if (!exists) {
    result.problems.push_back(
        fmt::format("there is no golden file {}; --update-goldens writes it", path));
  } else if (!expected) {
    result.problems.push_back(fmt::format("cannot read {}", path));
  } else {
    result.problems.push_back(
        fmt::format("the traces are not those of {}\n{}", path, text_difference(*expected, text)));
  }
}

/// Words for a property that `parallax verify --json` found violated: where, and which part of it
/// breaks.
std::string violation_words(const nlohmann::json& found) {
  auto out = fmt::format("violated at timepoint {}", found.value("timepoint", 0));
  const auto broken = found.find("broken");
  if (broken == found.end()) return out;
  return out + fmt::format(": `{}` {}", broken->value("formula", ""), broken->value("words", ""));
}

/// Is the property as expected? False: there is no answer. `open`: gets what the answer leaves
/// open.
bool check_property(const harness::ManifestCase& one, const std::string& property, bool holds,
                    const RunnerOptions& options, Footprint& footprint,
                    const std::atomic<bool>& stop, std::optional<std::uint64_t> cpu_limit_s,
                    std::vector<std::string>& open, CaseResult& result) {
  auto words = model_words(one, options, StatedConstraints::kIgnored);
  words.options.insert(words.options.begin(), {"verify", "--json", "--property=" + property});
  const auto child = run_this_program(words, footprint, stop, cpu_limit_s);
  result.messages = child.err;
  const auto found = base::parse_json(child.out);
  const auto verdict = found.is_object() ? found.value("verdict", "") : std::string();
  if ((child.code != 0 && child.code != 1) || (verdict != "holds" && verdict != "violated")) {
    report_no_answer(child, result);
    return false;
  }
  if (holds && verdict == "holds" && found.value("open_ended", false)) {
    // The executions that go on may never keep the promise.
    auto problem = fmt::format("expected to hold: {}\nit holds of executions that end by {}",
                               property, found.value("horizon", 0));
    const auto bounds = found.find("bounds");
    if (bounds != found.end() && bounds->is_array() && !bounds->empty()) {
      problem += ", but " + bounds->front().get<std::string>();
    }
    result.problems.push_back(std::move(problem));
    return true;
  }
  if (verdict == "holds" && note_reservation(found, property + ": no violation", open)) {
    return true;
  }
  if ((verdict == "holds") == holds) return true;
  result.problems.push_back(
      holds ? fmt::format("expected to hold: {}\n{}", property, violation_words(found))
            : fmt::format("expected to be violated: {}\nit holds up to horizon {}", property,
                          found.value("horizon", 0)));
  return true;
}

}  // namespace

std::optional<std::int64_t> listed_traces(std::string_view text) {
  const auto end = text.find_last_not_of('\n');
  if (end == std::string_view::npos) return std::nullopt;
  text = text.substr(0, end + 1);
  const auto newline = text.rfind('\n');
  if (newline != std::string_view::npos) text.remove_prefix(newline + 1);
  const auto digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const auto rest = text.substr(digits);
  if (!rest.starts_with(" trace, ") && !rest.starts_with(" traces, ")) return std::nullopt;
  return base::whole_number<std::int64_t>(text.substr(0, digits));
}

namespace {

void run_questions(const harness::ManifestCase& one, const fs::path& manifest,
                   const RunnerOptions& options, Footprint& footprint,
                   const std::atomic<bool>& stop, std::vector<std::string>& open,
                   CaseResult& result) {
  std::optional<std::uint64_t> cpu_limit_s;
  if (options.ends_early) cpu_limit_s = base::whole_seconds(one.time_limit_s);
  for (const auto* properties : {&one.expect.holds, &one.expect.violated}) {
    const bool holds = properties == &one.expect.holds;
    for (const auto& property : *properties) {
      if (!check_property(one, property.text, holds, options, footprint, stop, cpu_limit_s, open,
                          result)) {
        return;
      }
    }
  }
  if (!one.expect.lists_traces()) return;
  const auto command = traces_command(one, options);
  // A complete list equal to the golden file has the right number of traces.
  const bool listed = options.ends_early && one.expect.golden && one.expect.complete;
  if (one.expect.traces && !listed) {
    auto words = command;
    words.options.emplace_back("--json");
    // Counting goes on to the end, so it answers only whether these are all.
    if (one.expect.complete && !options.ends_early) words.options.emplace_back("--count");
    const auto child = run_this_program(words, footprint, stop, cpu_limit_s);
    result.messages = child.err;
    if (child.code != 0) return report_no_answer(child, result);
    compare_count(one.expect, child.out, open, result);
    if (!result.problems.empty() && !options.ends_early) {
      add_blame(one, child.out, options, footprint, stop, result);
    }
  }
  if (one.expect.golden) {
    const auto child = run_this_program(command, footprint, stop, cpu_limit_s);
    result.messages = child.err;
    if (child.code != 0) return report_no_answer(child, result);
    footprint.add_input(one.expect.golden->text);
    const auto problems = result.problems.size();
    compare_golden(one.expect.golden->text, child.out, manifest, options.update_goldens, result);
    base::DiagnosticSink unread;
    const auto golden = base::read_file(one.expect.golden->text, unread);
    if (result.problems.size() > problems && golden && one.expect.complete && !options.ends_early) {
      add_witnesses(one, *golden, child.out, options, footprint, stop, result);
    }
  }
}

}  // namespace

void run_traces(const harness::ManifestCase& one, const fs::path& manifest,
                const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
                CaseResult& result) {
  std::vector<std::string> open;  // as expected, as far as the plan was explored
  run_questions(one, manifest, options, footprint, stop, open, result);
  if (open.empty() || result.outcome != Outcome::kPassed || !result.problems.empty()) return;
  result.outcome = Outcome::kInconclusive;
  result.problems = std::move(open);
}

}  // namespace parallax::tools
