#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/json.h"
#include "harness/report/text_layout.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"
#include "tools/history/bisect.h"

namespace parallax::tools {
namespace {

struct BisectCommandOptions {
  std::string old_revision, new_revision;
  std::vector<std::string> run;  // the scenario, and options of `run`
  bool first_parent = false;
  CommandPermission commands;
};

constexpr std::size_t kShortHash = 12;

std::string name_of(const RevisionVerdict& one) {
  return fmt::format("{} {}", one.revision.substr(0, kShortHash), base::printable(one.subject));
}

/// "no-discrepancy", or "skipped: the scenario is missing".
std::string outcome_of(const RevisionVerdict& one) {
  return one.verdict.empty() ? "skipped: " + base::printable(one.words) : one.verdict;
}

std::string indented(const std::string& text) {
  constexpr std::size_t kMostLines = 20;
  std::string out;
  std::size_t lines = 0;
  for (std::size_t at = 0; at < text.size(); ++lines) {
    const auto end = std::min(text.find('\n', at), text.size());
    if (lines < kMostLines) out += "    " + base::printable(text.substr(at, end - at)) + '\n';
    at = end + 1;
  }
  if (lines > kMostLines) out += fmt::format("    {} more lines\n", lines - kMostLines);
  return out;
}

std::string text_of(const BisectResult& result) {
  const auto& before = result.old_end;
  const auto& after = result.new_end;
  std::string out;
  if (!result.ends_have_verdicts()) {
    for (const auto* end : {&before, &after}) {
      out += fmt::format(
          "{}: {}\n", name_of(*end),
          end->verdict.empty() ? "no verdict: " + base::printable(end->words) : end->verdict);
    }
    return out + "without a verdict at both ends there is nothing to look for\n";
  }
  if (before.verdict == after.verdict) {
    return fmt::format("the verdict is {} at {} and at {}\n", before.verdict, name_of(before),
                       name_of(after));
  }
  if (result.changed_by.size() == 1) {
    const auto& found = result.changed_by.front();
    out += fmt::format("{}\n  changes the verdict from {} to {}\n", name_of(found), before.verdict,
                       after.verdict);
    if (!found.words.empty()) out += harness::wrapped("  ", found.words, 4);
    if (!result.difference.empty()) out += "  what it changes\n" + indented(result.difference);
  } else {
    out += fmt::format("one of these changes the verdict from {} to {}; the others were skipped\n",
                       before.verdict, after.verdict);
    for (const auto& one : result.changed_by) {
      out += fmt::format("  {}: {}\n", name_of(one), outcome_of(one));
    }
  }
  return out;
}

nlohmann::ordered_json json_of(const RevisionVerdict& one) {
  nlohmann::ordered_json out = {{"revision", one.revision}, {"subject", one.subject}};
  if (one.verdict.empty()) {
    out["skipped"] = one.words;
  } else {
    out["verdict"] = one.verdict;
    if (!one.words.empty()) out["words"] = one.words;
  }
  return out;
}

std::string document_of(const BisectResult& result) {
  const auto list = [](const std::vector<RevisionVerdict>& all) {
    auto out = nlohmann::ordered_json::array();
    for (const auto& one : all) out.push_back(json_of(one));
    return out;
  };
  const nlohmann::ordered_json out = {{"status", "ok"},
                                      {"old", json_of(result.old_end)},
                                      {"new", json_of(result.new_end)},
                                      {"tried", list(result.tried)},
                                      {"changed_by", list(result.changed_by)},
                                      {"difference", result.difference}};
  return base::json_text(out) + '\n';
}

/// Options that would change what a run is for.
bool is_reserved(const std::string& word) {
  static constexpr std::string_view kReserved[] = {
      "--out",   "--resume",         "--json",        "--samples",     "--footprint",
      "--quiet", "--allow-commands", "--no-commands", "--diagnostics", "--only"};
  const auto name = word.substr(0, word.find('='));
  return std::find(std::begin(kReserved), std::end(kReserved), name) != std::end(kReserved);
}

/// `FILE:ID` is a case of a manifest, unless there is a file of this name.
void split_case(BisectOptions& asked) {
  const auto colon = asked.scenario.rfind(':');
  std::error_code error;
  if (colon == std::string::npos || std::filesystem::exists(asked.scenario, error)) return;
  const auto file = asked.scenario.substr(0, colon);
  if (!file.ends_with(".yaml") && !file.ends_with(".yml")) return;
  asked.case_id = asked.scenario.substr(colon + 1);
  asked.scenario = file;
}

int bisect(const BisectCommandOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  BisectOptions asked{options.old_revision,
                      options.new_revision,
                      options.run.front(),
                      "",
                      {options.run.begin() + 1, options.run.end()}};
  for (const auto& word : asked.run_options) {
    if (!is_reserved(word)) continue;
    sink.error_about(codes::kUsage, word,
                     "bisect says this itself; permissions stand in front of `--`");
    return 0;
  }
  split_case(asked);
  asked.allow_commands = options.commands.allow;
  asked.allow_outside = invocation.form().allow_outside;
  asked.first_parent = options.first_parent;
  const auto tell = [&](const RevisionVerdict& one) {
    invocation.remark(fmt::format("{}: {}", name_of(one), outcome_of(one)));
  };
  const auto result = bisect_verdict(asked, tell, invocation.stop(), sink);
  if (!result || result->stopped) return result ? 4 : 0;
  if (invocation.options().json) {
    invocation.document(document_of(*result));
  } else {
    invocation.result(text_of(*result));
  }
  if (result->changed_by.size() == 1) return 1;
  if (!result->changed_by.empty()) return 4;
  if (result->ends_have_verdicts()) return 0;
  return result->old_end.input_is_wrong || result->new_end.input_is_wrong ? 3 : 4;
}

}  // namespace

Command bisect_command() {
  auto options = std::make_shared<BisectCommandOptions>();
  OptionTable command(
      "bisect",
      "Which revision changed a verdict, or a case of a suite? (docs/reference/suites.md)");
  command.footer(
      "Examples:\n"
      "  parallax bisect v1.2 HEAD -- scenarios/kitchen/plan2.yaml\n"
      "  parallax bisect HEAD~20 HEAD -- edge.yaml --seed 3\n"
      "  parallax bisect HEAD~20 HEAD -- cases/suite.yaml:lock_opens\n"
      "Revisions are checked out in a temporary folder; your checkout, its index and its refs are\n"
      "left alone, and hooks and filters of the repository are not run. Revisions in which the\n"
      "scenario is missing, is refused or gives no verdict are skipped.\n"
      "Exit codes: 0 the verdict is the same at both, 1 the revision was found, 3 OLD or NEW has "
      "no\n"
      "such scenario, 4 no verdict there, or only skipped revisions are left.");
  command.option("old", options->old_revision, "A revision, as git reads it").required();
  command.option("new", options->new_revision, "A later one").required();
  command
      .option("scenario", options->run,
              "Behind `--`: the scenario with options of `run`, or FILE:ID with those of `suite`")
      .required()
      .file({"yaml"});
  command.flag("--first-parent", options->first_parent, "Of merges follow the first parent only");
  add_command_options(command, options->commands, false);
  return command_of(std::move(command), options, bisect);
}

}  // namespace parallax::tools
