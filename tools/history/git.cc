#include "tools/history/git.h"

#include <filesystem>

#include "compiler/base/path_gate.h"

namespace parallax::tools {

base::Captured run_git(const std::string& folder, const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {"env"};
  for (const auto* name :
       {"GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_COMMON_DIR", "GIT_OBJECT_DIRECTORY",
        "GIT_ALTERNATE_OBJECT_DIRECTORIES", "GIT_PREFIX", "GIT_NAMESPACE", "GIT_EXTERNAL_DIFF"}) {
    command.insert(command.end(), {"-u", name});
  }
  command.insert(command.end(), {"LC_ALL=C", "GIT_TERMINAL_PROMPT=0", "GIT_NO_LAZY_FETCH=1",
                                 "GIT_OPTIONAL_LOCKS=0", "git", "--no-pager"});
  for (const auto* setting :
       {"core.hooksPath=/dev/null", "core.fsmonitor=false", "protocol.allow=never",
        "log.showSignature=false", "submodule.recurse=false", "advice.detachedHead=false"}) {
    command.insert(command.end(), {"-c", setting});
  }
  command.insert(command.end(), arguments.begin(), arguments.end());
  base::CaptureOptions options;
  options.folder = folder;
  options.ends_with_us = true;
  options.without_input = true;
  return base::capture(command, options);
}

std::optional<std::string> ask_git(const std::string& folder,
                                   const std::vector<std::string>& arguments) {
  auto answer = run_git(folder, arguments);
  if (answer.code != 0) return std::nullopt;
  while (answer.out.ends_with('\n')) answer.out.pop_back();
  return std::move(answer.out);
}

std::optional<std::string> revision_at(const std::string& path) {
  std::error_code error;
  auto folder = base::real_path(path);
  if (!std::filesystem::is_directory(folder, error)) folder = folder.parent_path();
  return ask_git(folder.string(), {"rev-parse", "--verify", "--quiet", "--short=12", "HEAD"});
}

}  // namespace parallax::tools
