#include "compiler/base/write_gate.h"

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

#include "compiler/base/codes/files.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/shown_text.h"

namespace parallax::base {
namespace {

namespace fs = std::filesystem;

/// The nearest folder above `real`, or itself, that is a repository or a marked root; else `real`.
fs::path tree_of(const fs::path& real) {
  std::error_code error;
  for (fs::path at = real; at != at.root_path(); at = at.parent_path()) {
    if (fs::exists(fs::symlink_status(at / ".git", error)) ||
        fs::is_regular_file(fs::symlink_status(at / kRootMarker, error))) {
      return at;
    }
  }
  return real;
}

/// A link at `path` or below it that leads out of `folder`, links themselves not followed.
std::optional<fs::path> link_out_of(const fs::path& path, const fs::path& folder) {
  if (!lies_below(path, folder)) return path;
  std::error_code error;
  using Options = fs::directory_options;
  fs::recursive_directory_iterator at(path, Options::skip_permission_denied, error), end;
  for (; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    if (at->is_symlink(ignored) && !lies_below(at->path(), folder)) return at->path();
  }
  return std::nullopt;
}

}  // namespace

WriteGate::WriteGate(bool allow_outside) : is_open_(allow_outside) {
  roots_.push_back(tree_of(real_path(".")));
}

void WriteGate::admit_beside(const fs::path& file) {
  roots_.push_back(tree_of(real_path(file.parent_path())));
}

bool WriteGate::admits(const fs::path& path) const {
  return is_open_ || std::any_of(roots_.begin(), roots_.end(),
                                 [&](const auto& root) { return lies_below(path, root); });
}

Status WriteGate::check(const fs::path& path, DiagnosticSink& sink) const {
  if (admits(path)) return Unit{};
  return sink
      .error_about(codes::kWriteOutside, printable(path.string()),
                   printable(roots_.front().string()))
      .fix(
          "go to the folder of that project, name the scenario that is meant with --scenario, or "
          "permit it with --allow-outside");
}

Status check_unnamed_output(const fs::path& path, const fs::path& folder, std::string_view option,
                            DiagnosticSink& sink) {
  const auto link = link_out_of(path, folder.empty() ? fs::path(".") : folder);
  if (!link) return Unit{};
  return sink
      .error_about(codes::kOutputLeadsOut, printable(path.string()), printable(link->string()),
                   printable(real_path(*link).string()))
      .fix("remove the link, or name the place with " + std::string(option));
}

}  // namespace parallax::base
