#include "tools/history/borrowed_repository.h"

#include <algorithm>
#include <system_error>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"
#include "tools/history/git.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

base::Reported refuse_git(const std::string& subject, const std::string& why,
                          base::DiagnosticSink& sink) {
  return sink.error_about(codes::kUsage, subject, why);
}

fs::path git_path(const std::string& folder, const char* name) {
  const auto path = ask_git(folder, {"rev-parse", "--git-path", name});
  return path ? base::real_path(fs::path(folder) / *path) : fs::path();
}

}  // namespace

bool is_git_hash(std::string_view word) {
  constexpr std::size_t kShortest = 40;
  return word.size() >= kShortest && std::all_of(word.begin(), word.end(), [](char c) {
           return base::is_digit(c) || (c >= 'a' && c <= 'f');
         });
}

std::string git_complaint(const base::Captured& git) {
  if (git.code < 0 || git.code == 127) return "git cannot be started";
  auto text = git.err.empty() ? git.out : git.err;
  while (text.ends_with('\n')) text.pop_back();
  return "git: " + text.substr(0, text.find('\n'));
}

base::Result<std::string> commit_of(const std::string& folder, const std::string& revision,
                                    base::DiagnosticSink& sink) {
  const auto hash =
      revision.empty() || revision.front() == '-'
          ? std::nullopt
          : ask_git(folder, {"rev-parse", "--verify", "--quiet", revision + "^{commit}"});
  if (!hash || !is_git_hash(*hash)) {
    return refuse_git(revision, "git knows no such revision here", sink);
  }
  return *hash;
}

base::Status BorrowedRepository::make(const std::string& user_folder, const std::string& commit,
                                      base::DiagnosticSink& sink) {
  const auto format = ask_git(user_folder, {"rev-parse", "--show-object-format"});
  const auto objects = git_path(user_folder, "objects"), shallow = git_path(user_folder, "shallow");
  if (objects.empty() || objects.string().find_first_of("\n\"#") != std::string::npos) {
    return refuse_git(objects.string(), "git cannot borrow objects from a folder of this name",
                      sink);
  }
  const auto made = run_git(
      "/",
      {"init", "--quiet", "--template=", "--object-format=" + format.value_or("sha1"), path()});
  if (made.code != 0) return refuse_git(path(), git_complaint(made), sink);
  const auto own = folder_ / ".git";
  std::error_code error;
  fs::create_directories(own / "objects/info", error);
  if (!base::write_file_atomically(own / "objects/info/alternates", objects.string() + '\n',
                                   sink)) {
    return sink.already_reported();
  }
  if (fs::exists(shallow, error)) fs::copy_file(shallow, own / "shallow", error);
  return check_out(commit, sink);
}

base::Status BorrowedRepository::check_out(const std::string& commit, base::DiagnosticSink& sink) {
  const auto done = run_git(path(), {"checkout", "--quiet", "--force", "--detach", commit});
  if (done.code != 0) return refuse_git(commit, git_complaint(done), sink);
  return base::Unit{};
}

bool BorrowedRepository::add_tree(const fs::path& folder, const std::string& commit) const {
  return run_git(path(),
                 {"worktree", "add", "--quiet", "--force", "--detach", folder.string(), commit})
             .code == 0;
}

std::string BorrowedRepository::subject(const std::string& commit) const {
  return ask_git(path(), {"log", "-1", "--no-show-signature", "--format=%s", commit}).value_or("");
}

}  // namespace parallax::tools
