#include "tools/cli/diff_gate.h"

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/subprocess.h"
#include "tools/cli/limits.h"
#include "tools/cli/replaceable.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

int run_gate(const GateInput& input, const GateFiles& files, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto rules = harness::load_gate_rules(files.rules, invocation.files(), sink);
  if (!rules) return 0;
  if (!files.markdown.empty() &&
      !check_replaceable(files.markdown, is_gate_report, invocation.files(), sink)) {
    return 0;
  }
  const auto report = hold_gate(input, *rules, invocation);
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

}  // namespace parallax::tools
