#include "tools/repair/apply.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

/// A file that is to be replaced, and its new text beside it.
struct Replacement {
  fs::path target, fresh;
  fs::perms permissions = fs::perms::none;
};

/// Also checked for the super-user, who may write anything.
bool is_read_only(const fs::path& target, fs::perms permissions) {
  constexpr auto kWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  return (permissions & kWrite) == fs::perms::none || ::access(target.c_str(), W_OK) != 0;
}

base::Result<Replacement> look_at(const ChangedFile& file, const base::WriteGate& gate,
                                  base::DiagnosticSink& sink) {
  std::error_code error;
  Replacement out;
  out.target = fs::canonical(file.name, error);
  if (error) out.target = file.name;
  if (!gate.check(out.target, sink)) return sink.already_reported();
  const auto now = base::read_file(out.target, sink);
  if (!now) return sink.already_reported();
  out.permissions = fs::status(out.target, error).permissions();
  if (is_read_only(out.target, out.permissions)) {
    return sink.error_about(codes::kFileNotWritable, file.name,
                            "it is read-only, and nothing was written; `--json` has the patch");
  }
  if (*now != file.before) {
    return sink.error_about(codes::kFileNotWritable, file.name,
                            "it changed while the repair was looked for");
  }
  out.fresh = out.target.parent_path() /
              fmt::format(".{}.{}.repaired", out.target.filename().string(), ::getpid());
  return out;
}

/// Puts the new texts in the place of the old ones. If that ends halfway, the old ones are put
/// back.
base::Status replace_all(const std::vector<Replacement>& all, const std::vector<ChangedFile>& files,
                         base::DiagnosticSink& sink) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::error_code error;
    fs::rename(all[i].fresh, all[i].target, error);
    if (!error) continue;
    auto reported = sink.error_about(codes::kFileNotWritable, files[i].name,
                                     error.message() + "; nothing was changed");
    for (std::size_t done = 0; done < i; ++done) {
      if (!base::write_file_atomically(all[done].target, files[done].before, sink)) continue;
      fs::permissions(all[done].target, all[done].permissions, error);
    }
    return reported;
  }
  return base::Unit{};
}

}  // namespace

base::Status apply_proposal(const Proposal& proposal, const base::WriteGate& gate,
                            Context& context) {
  auto& sink = context.sink();
  std::vector<Replacement> all;
  for (const auto& file : proposal.files) {
    auto one = look_at(file, gate, sink);
    if (!one) return sink.already_reported();
    all.push_back(*std::move(one));
  }
  bool written = true;
  for (std::size_t i = 0; written && i < all.size(); ++i) {
    written =
        static_cast<bool>(base::write_file_atomically(all[i].fresh, proposal.files[i].after, sink));
    std::error_code error;
    if (written) fs::permissions(all[i].fresh, all[i].permissions, error);
  }
  const bool done = written && replace_all(all, proposal.files, sink);
  for (const auto& one : all) {
    std::error_code error;
    fs::remove(one.fresh, error);
  }
  if (!done) return sink.already_reported();
  return base::Unit{};
}

}  // namespace parallax::tools
