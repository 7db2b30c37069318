#include "tools/history/git.h"

#include <algorithm>
#include <filesystem>

#include "compiler/base/path_gate.h"

namespace parallax::tools {

base::Captured run_git(const std::string& folder, const std::vector<std::string>& arguments,
                       const std::vector<std::string>& emptied) {
  std::vector<std::string> command = {"env"};
  for (const auto* name :
       {"GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_COMMON_DIR", "GIT_OBJECT_DIRECTORY",
        "GIT_ALTERNATE_OBJECT_DIRECTORIES", "GIT_PREFIX", "GIT_NAMESPACE", "GIT_EXTERNAL_DIFF"}) {
    command.insert(command.end(), {"-u", name});
  }
  command.insert(command.end(), {"LC_ALL=C", "GIT_TERMINAL_PROMPT=0", "GIT_NO_LAZY_FETCH=1",
                                 "GIT_OPTIONAL_LOCKS=0"});
  // Passed in the environment, because a setting's name may contain a `=`.
  for (std::size_t i = 0; i < emptied.size(); ++i) {
    const auto number = std::to_string(i);
    command.insert(command.end(), {"GIT_CONFIG_KEY_" + number + "=" + emptied[i],
                                   "GIT_CONFIG_VALUE_" + number + "="});
  }
  command.push_back("GIT_CONFIG_COUNT=" + std::to_string(emptied.size()));
  command.insert(command.end(), {"git", "--no-pager"});
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

namespace {

std::string folder_at(const std::string& path) {
  std::error_code error;
  const auto place = base::real_path(path);
  return (std::filesystem::is_directory(place, error) ? place : place.parent_path()).string();
}

}  // namespace

std::optional<std::string> revision_at(const std::string& path) {
  return ask_git(folder_at(path), {"rev-parse", "--verify", "--quiet", "--short=12", "HEAD"});
}

std::optional<CommitWords> commit_words_at(const std::string& path) {
  const auto words = ask_git(folder_at(path), {"log", "-1", "--format=%cs%n%s", "HEAD"});
  if (!words) return std::nullopt;
  const auto end = std::min(words->find('\n'), words->size());
  return CommitWords{words->substr(std::min(end + 1, words->size())), words->substr(0, end)};
}

namespace {

/// The settings that name programs which git would run over files.
std::optional<std::vector<std::string>> filters_of(const std::string& folder) {
  const auto answer =
      run_git(folder, {"config", "--null", "--name-only", "--get-regexp", "^filter\\."});
  if (answer.code == 1 && answer.out.empty()) return std::vector<std::string>();  // there are none
  if (answer.code != 0) return std::nullopt;
  std::vector<std::string> out;
  for (std::size_t at = 0; at < answer.out.size();) {
    const auto end = std::min(answer.out.find('\0', at), answer.out.size());
    out.push_back(answer.out.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

/// None: git does not tell.
std::optional<bool> has_changes(const std::string& top, const std::set<std::string>& files) {
  const auto filters = filters_of(top);
  if (!filters) return std::nullopt;
  std::vector<std::string> names;
  std::ptrdiff_t expected = 0, tracked = 0;
  for (const auto& file : files) {
    const auto real = base::real_path(file);
    std::error_code error;
    if (!base::lies_below(real, top) || std::filesystem::is_directory(real, error)) continue;
    expected += std::filesystem::exists(real, error) ? 1 : 0;
    names.push_back(real.string());
  }
  constexpr std::size_t kAtOnce = 200;
  for (std::size_t begin = 0; begin < names.size(); begin += kAtOnce) {
    const auto end = std::min(names.size(), begin + kAtOnce);
    const auto ask = [&](std::vector<std::string> command) {
      command.insert(command.begin(), "--literal-pathspecs");
      command.emplace_back("--");
      for (auto i = begin; i < end; ++i) command.push_back(names[i]);
      return run_git(top, command, *filters);
    };
    const auto status = ask({"status", "--porcelain", "--ignore-submodules", "--no-renames",
                             "--ignored", "--untracked-files=all"});
    const auto list = ask({"ls-files", "-z"});
    if (status.code != 0 || list.code != 0) return std::nullopt;
    if (!status.out.empty()) return true;
    tracked += std::count(list.out.begin(), list.out.end(), '\0');
  }
  // git lists no files of a submodule: their state is unknown.
  if (tracked < expected) return std::nullopt;
  return false;
}

}  // namespace

std::optional<std::string> revision_of(const std::string& path,
                                       const std::set<std::string>& files) {
  auto revision = revision_at(path);
  if (!revision) return std::nullopt;
  const auto top = ask_git(folder_at(path), {"rev-parse", "--show-toplevel"});
  const auto changes = top ? has_changes(*top, files) : std::nullopt;
  if (!changes) return *revision + "+unknown";
  return *changes ? *revision + "+changes" : *revision;
}

}  // namespace parallax::tools
