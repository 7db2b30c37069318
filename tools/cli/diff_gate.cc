#include "tools/cli/diff_gate.h"

#include <csignal>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/subprocess.h"
#include "compiler/base/temporary_folder.h"
#include "tools/app/simulator_factory.h"
#include "tools/cli/limits.h"
#include "tools/cli/replaceable.h"
#include "tools/diff/tree_gate.h"
#include "tools/history/borrowed_repository.h"
#include "tools/history/git.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

/// Names files below the root of a checkout as seen from there.
void without_root(const std::string& root, std::string& text) {
  for (auto at = text.find(root); at != std::string::npos; at = text.find(root, at)) {
    const auto end = at + root.size();
    const bool is_whole = end == text.size() || text[end] != '/';
    text.replace(at, root.size() + (is_whole ? 0 : 1), is_whole ? "." : "");
  }
}

bool is_gate_report(std::string_view head) { return head.starts_with(kGateMark); }

/// Draws the discrepancy into a folder beside the Markdown, and returns the picture of the parting,
/// relative to the Markdown. Empty where none can be drawn, which is reported.
std::string draw_witness(const DrawnWitness& witness, const fs::path& markdown,
                         Invocation& invocation) {
  const auto folder = fs::path(markdown).replace_extension(".pictures");
  std::vector<std::string> command = {"parallax",     "draw", "--sample",
                                      witness.sample, "-o",   folder.string()};
  if (invocation.form().allow_outside) command.emplace_back("--allow-outside");
  command.insert(command.end(), {"--quiet", "--color=never", "--json", "--", witness.folder});
  base::CaptureOptions options;
  options.program = "/proc/self/exe";
  options.max_errors = std::size_t{64} << 10U;
  options.ends_with_us = true;
  options.signal_when = [told = false]() mutable {
    if (told || !stop_flag().load()) return 0;
    told = true;
    return SIGTERM;
  };
  const auto child = base::capture(command, options);
  const auto name = fmt::format("{:02}.svg", witness.timepoint);
  std::error_code error;
  if (child.code == 0 && fs::is_regular_file(folder / name, error)) {
    return (folder.filename() / name).string();
  }
  const auto document = base::parse_json(child.out);
  std::string why = "it cannot be drawn";
  if (const auto* reported = base::json_member(document, "diagnostics");
      reported != nullptr && !reported->empty()) {
    const auto* message = base::json_member(reported->front(), "message");
    if (message != nullptr && message->is_string()) why = message->get<std::string>();
  }
  invocation.remark(fmt::format("no picture of simulation {}: {}", witness.sample, why));
  return {};
}

using Hold = std::function<base::Result<GateReport>(const harness::GateRules&)>;

/// Reads the rules, holds the change against them, and tells the answer.
int tell_gate(const Hold& hold, const GateFiles& files, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto rules = harness::load_gate_rules(files.rules, invocation.files(), sink);
  if (!rules) return 0;
  if (!files.markdown.empty() &&
      !check_replaceable(files.markdown, is_gate_report, invocation.files(), sink)) {
    return 0;
  }
  const auto report = hold(*rules);
  if (!report) return 0;
  if (!files.markdown.empty()) {
    const auto picture =
        report->drawn ? draw_witness(*report->drawn, files.markdown, invocation) : std::string();
    if (!base::write_output(files.markdown, gate_markdown(*report, picture), invocation.files(),
                            sink)) {
      return 0;
    }
  }
  if (invocation.options().json) {
    const auto quoted = [](const std::string& text) {
      return base::json_quoted(base::printable(text));
    };
    invocation.document(fmt::format(
        "{{\"status\":\"ok\",\"kind\":\"{}\",\"old\":{},\"new\":{},\"gate\":{}}}\n", report->kind,
        quoted(report->old_name), quoted(report->new_name), gate_json(*report)));
  } else {
    invocation.result(gate_text(*report));
  }
  invocation.answered();  // what a limit left open is a rule that is not decidable
  return report->passes() ? 0 : 1;
}

}  // namespace

SimulatorMaker gate_simulator(bool permitted, const Invocation& invocation) {
  return [permitted, &invocation](
             const ScenarioModel& loaded, Context& context,
             const std::atomic<bool>& stop) -> base::Result<harness::SimulatorFactory> {
    const auto& spec = loaded.scenario.simulator;
    if (!spec.command.empty()) {
      const auto text = base::command_text(spec.command);
      if (!permitted) return context.sink().error(codes::kCommandNotPermitted, spec.source, text);
      invocation.remark(
          fmt::format("starting `{}`, as {} says", text, context.files().place(spec.source)));
    }
    std::vector<std::string> worker = {"/proc/self/exe", "worker"};
    if (context.form().allow_outside) worker.emplace_back("--allow-outside");
    return simulator_factory(loaded, worker, stop, {"/proc/self/exe", "supervise", "--"});
  };
}

int run_gate(const GateInput& input, const GateFiles& files, Invocation& invocation) {
  const bool trees = is_tree(input.old_path) && is_tree(input.new_path);
  const auto hold = [&](const harness::GateRules& rules) {
    if (!trees) return hold_gate(input, rules, invocation);
    return hold_tree_gate(input, rules, invocation);
  };
  return tell_gate(hold, files, invocation);
}

int run_revision_gate(const GateRevisions& revisions, const GateInput& input,
                      const GateFiles& files, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto refuse = [&](const std::string& subject, const char* why) {
    sink.error_about(codes::kUsage, subject, why);
    return 0;
  };
  const auto path = base::real_path(revisions.path.empty() ? "." : revisions.path);
  std::error_code error;
  const auto folder = fs::is_directory(path, error) ? path : path.parent_path();
  const auto top = ask_git(folder.string(), {"rev-parse", "--show-toplevel"});
  if (!top || top->empty()) {
    return refuse(folder.string(), "it lies in no checkout of a git repository that may be read");
  }
  const auto before = commit_of(folder.string(), revisions.before, sink);
  const auto after = commit_of(folder.string(), revisions.after, sink);
  if (!before || !after) return 0;
  const base::TemporaryFolder scratch("gate");
  if (scratch.path().empty()) return refuse("", "no temporary folder can be made");
  // As messages name it, also where a link leads there.
  const auto trees = base::real_path(scratch.path());
  const auto old_tree = trees / "old", new_tree = trees / "new";
  BorrowedRepository repository(old_tree);
  if (!repository.make(folder.string(), *before, sink)) return 0;
  if (!repository.add_tree(new_tree, *after)) {
    return refuse(revisions.after, "git cannot check it out");
  }
  const auto own_tree = base::real_path(*top), here = base::real_path(".");
  const auto inside = path.lexically_relative(own_tree);
  const bool is_top = inside == ".";
  const auto old_place = is_top ? old_tree : old_tree / inside;
  const auto new_place = is_top ? new_tree : new_tree / inside;
  if (!fs::is_directory(old_place, error) || !fs::is_directory(new_place, error)) {
    return refuse(revisions.path, "it is no folder in both revisions");
  }
  const auto commands_in = [&](const fs::path& tree) {
    const bool is_inside = base::lies_below(here, own_tree);
    const auto current = (tree / here.lexically_relative(own_tree)).lexically_normal();
    return CommandFolder{tree, {is_inside ? current : here}, {own_tree}};
  };
  auto own = input;
  own.old_path = old_place.string();
  own.new_path = new_place.string();
  own.models.old_commands = commands_in(old_tree);
  own.models.new_commands = commands_in(new_tree);
  const auto hold = [&](const harness::GateRules& rules) {
    auto report = hold_tree_gate(own, rules, invocation);
    if (report) {
      report->old_name = revisions.before;
      report->new_name = revisions.after;
      std::vector<std::string*> texts;
      for (auto& rule : report->rules) texts.insert(texts.end(), {&rule.words, &rule.witness});
      for (auto& remark : report->remarks) texts.push_back(&remark);
      for (auto* text : texts) {
        without_root(old_tree.string(), *text);
        without_root(new_tree.string(), *text);
      }
    }
    return report;
  };
  return tell_gate(hold, files, invocation);
}

}  // namespace parallax::tools
