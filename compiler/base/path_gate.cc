#include "compiler/base/path_gate.h"

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <system_error>

#include "compiler/base/codes/texts.h"
#include "compiler/base/diagnostic_printer.h"

namespace parallax::base {
namespace {

namespace fs = std::filesystem;

bool begins_with(const fs::path& real, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first ==
         folder.end();
}

/// The home folder of the user, by the environment and by the system.
std::vector<fs::path> own_homes() {
  std::vector<fs::path> homes;
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    homes.push_back(real_path(home));
  }
  passwd entry{};
  passwd* found = nullptr;
  std::array<char, 1 << 14> buffer;
  if (::getpwuid_r(::geteuid(), &entry, buffer.data(), buffer.size(), &found) == 0 &&
      found != nullptr) {
    homes.push_back(real_path(found->pw_dir));
  }
  return homes;
}

/// `real` is `/`, a home folder, or the folder of all of them.
bool is_too_wide(const fs::path& real, const std::vector<fs::path>& homes) {
  if (real == real.root_path() || real == "/home" || real == "/root" ||
      real.parent_path() == "/home") {
    return true;
  }
  return std::find(homes.begin(), homes.end(), real) != homes.end();
}

/// The nearest folder above `real`, or itself, that is marked and no home. `look` is told every
/// folder that was looked at.
template <typename Look>
std::optional<fs::path> marked_root(fs::path real, const std::vector<fs::path>& homes,
                                    const Look& look) {
  for (; !is_too_wide(real, homes); real = real.parent_path()) {
    look(real);
    if (is_marked_root(real)) return real;
  }
  return std::nullopt;
}

}  // namespace

bool is_marked_root(const fs::path& folder) {
  struct ::stat status {};
  // Other users who can write to a folder could plant a marker there.
  if (::stat(folder.empty() ? "." : folder.c_str(), &status) != 0) return false;
  if ((status.st_mode & S_IWOTH) != 0) return false;
  std::error_code error;
  return fs::is_regular_file(fs::symlink_status(folder / kRootMarker, error));
}

namespace {

/// A link whose target does not exist, in the existing part of the path; the part after it goes to
/// `rest`.
std::optional<fs::path> dangling_link(const fs::path& path, fs::path& rest) {
  std::error_code error;
  std::optional<fs::path> link;
  fs::path before;
  for (const auto& part : path) {
    if (link) {
      rest /= part;
      continue;
    }
    before /= part;
    if (fs::is_symlink(fs::symlink_status(before, error))) link = before;
  }
  return link;
}

}  // namespace

fs::path real_path(const fs::path& path) {
  constexpr int kMaxLinks = 40;  // as Linux follows
  std::error_code error;
  auto whole = fs::absolute(path.empty() ? fs::path(".") : path, error);
  fs::path real;
  for (int links = 0; links < kMaxLinks; ++links) {
    real = fs::weakly_canonical(whole, error);
    if (error) real = whole.lexically_normal();
    // Where a link leads does not depend on whether anything is there.
    fs::path rest;
    const auto link = error ? std::nullopt : dangling_link(real, rest);
    if (!link) break;
    const auto target = fs::read_symlink(*link, error);
    if (error) break;
    whole = link->parent_path() / target;
    if (!rest.empty()) whole /= rest;
  }
  // A folder that is named with a final slash is the same folder.
  if (!real.has_filename() && real.has_relative_path()) real = real.parent_path();
  return real;
}

bool lies_below(const fs::path& path, const fs::path& folder) {
  return begins_with(real_path(path), real_path(folder));
}

void PathGate::admit_from(const fs::path& folder) {
  const auto homes = own_homes();
  auto real = real_path(folder);
  // Named from the current folder where the user did so: a checkout may lie elsewhere tomorrow.
  const auto here = folder.is_absolute() ? fs::path() : real_path(".");
  const auto note = [&](const fs::path& one) {
    if (files_ == nullptr || is_open_) return;
    const auto named = here.empty() ? one : one.lexically_relative(here);
    files_->note_input((named / kRootMarker).lexically_normal().string());
  };
  if (auto root = marked_root(real, homes, note)) real = *std::move(root);
  const bool whole = !is_too_wide(real, homes);
  roots_.push_back({std::move(real), whole});
}

void PathGate::admit_folder(const fs::path& folder) { roots_.push_back({real_path(folder), true}); }

void PathGate::admit_current_folder() {
  auto real = real_path(".");
  if (!is_too_wide(real, own_homes())) roots_.push_back({std::move(real), true});
}

bool PathGate::admits(const fs::path& path) const {
  if (is_open_) return true;
  const auto real = real_path(path);
  return std::any_of(roots_.begin(), roots_.end(), [&](const Root& root) {
    if (root.whole) return begins_with(real, root.folder);
    return real.parent_path() == root.folder && !real.filename().string().starts_with('.');
  });
}

Status PathGate::check(const fs::path& path, const SourceRange& place, DiagnosticSink& sink) const {
  if (admits(path)) return Unit{};
  const auto shown = path.lexically_normal();
  auto report = sink.error(codes::kLoadOutside, place, printable(shown.string()));
  const auto real = real_path(path);
  if (real != shown) report.note("its real path is `" + printable(real.string()) + "`");
  report.fix("make an empty file `" + std::string(kRootMarker) +
             "` in the folder that both share, or permit it with --allow-outside");
  return report;
}

}  // namespace parallax::base
