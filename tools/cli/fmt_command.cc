#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/write_gate.h"
#include "compiler/syntax/formatter.h"
#include "tools/app/file_kind.h"
#include "tools/cli/command.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

struct FmtOptions {
  std::vector<std::string> files;
  bool check = false;
  bool to_stdout = false;
};

base::Result<base::FileId> read_standard_input(Invocation& invocation) {
  std::string text;
  std::string chunk(std::size_t{1} << 16U, '\0');
  for (;;) {
    const auto count = ::read(STDIN_FILENO, chunk.data(), chunk.size());
    if (count == 0) break;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      return invocation.sink().error_about(codes::kFileUnreadable, "standard input",
                                           std::strerror(errno));
    }
    text.append(chunk, 0, static_cast<std::size_t>(count));
    constexpr std::size_t kLimit = std::size_t{64} << 20U;
    if (text.size() > kLimit) {
      return invocation.sink().error_about(codes::kFileTooLarge, "standard input", kLimit);
    }
  }
  return base::register_text("<stdin>", std::move(text), invocation.files(), invocation.sink());
}

/// Replaces the file that a link leads to, not the link, and keeps its permissions.
void write_back(const std::string& path, const std::string& text, Invocation& invocation) {
  std::error_code error;
  auto target = fs::canonical(path, error);
  if (error) target = path;
  base::WriteGate gate(invocation.form().allow_outside);
  gate.admit_beside(path);
  if (!gate.check(target, invocation.sink())) return;
  const auto status = fs::status(target, error);
  if (!base::write_file_atomically(target, text, invocation.sink())) return;
  if (!error) fs::permissions(target, status.permissions(), error);
}

/// True if the file was, or would be, changed.
bool format_one(const std::string& path, const FmtOptions& options, Invocation& invocation) {
  const bool standard = path == "-";
  if (!standard && !expect_kind(path, {FileKind::kModel}, "a model", invocation)) return false;
  const auto file = standard ? read_standard_input(invocation)
                             : base::load_text(path, invocation.files(), invocation.sink());
  if (!file) return false;
  const auto formatted = compiler::format_text(*file, invocation.files(), invocation.sink());
  if (!formatted) return false;
  // A byte order mark is not part of the registered text, but goes as well.
  bool changed = invocation.files()[*file].text() != *formatted;
  if (!standard && !changed) {
    std::error_code error;
    changed = fs::file_size(path, error) != formatted->size() && !error;
  }
  if (options.check) return changed;
  if (standard || options.to_stdout) {
    invocation.exact_result(*formatted);
  } else if (changed) {
    write_back(path, *formatted, invocation);
  }
  return changed;
}

int format(const FmtOptions& options, Invocation& invocation) {
  const bool prints = options.to_stdout || std::find(options.files.begin(), options.files.end(),
                                                     "-") != options.files.end();
  if (prints && !options.check && invocation.options().json) {
    invocation.sink().error_about(codes::kUsage, "",
                                  "--json and the formatted text cannot both go to the output");
    return 0;
  }
  auto changed = nlohmann::json::array();
  for (const auto& path : options.files) {
    if (!format_one(path, options, invocation)) continue;
    changed.push_back(base::printable(path));
    if (options.check && !invocation.options().json)
      invocation.result(base::printable(path) + '\n');
  }
  if (invocation.sink().has_errors()) return 0;
  if (invocation.options().json) {
    invocation.document("{\"status\":\"ok\",\"changed\":" + base::json_text(changed) + "}\n");
  }
  return options.check && !changed.empty() ? 1 : 0;
}

}  // namespace

Command fmt_command() {
  auto options = std::make_shared<FmtOptions>();
  OptionTable command("fmt", "Bring model files into the standard layout");
  command.footer(
      "Examples:\n"
      "  parallax fmt domain.e problem.e\n"
      "  parallax fmt --check scenarios/two_regions/domain.e\n"
      "  parallax fmt - < domain.e\n"
      "Files are rewritten in place; one with a syntax error is left as it is.");
  command.option("files", options->files, "Model files (.e); - for standard input")
      .required()
      .file({"e"});
  command.flag("--check", options->check,
               "Write nothing; name the files that would change and exit with 1 if any would");
  command.flag("--stdout", options->to_stdout, "Print instead of rewriting");
  return command_of(std::move(command), options, format);
}

}  // namespace parallax::tools
