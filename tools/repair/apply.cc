#include "tools/repair/apply.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"

namespace parallax::tools {

base::Status apply_proposal(const Proposal& proposal, Context& context) {
  auto& sink = context.sink();
  std::vector<std::filesystem::path> targets;
  for (const auto& file : proposal.files) {
    std::error_code error;
    auto target = std::filesystem::canonical(file.name, error);
    if (error) target = file.name;
    if (::access(target.c_str(), W_OK) != 0) {
      return sink.error_about(base::DiagnosticCode::kFileNotWritable, file.name,
                              "it is read-only; `--json` has the patch");
    }
    const auto now = base::read_file(target, sink);
    if (!now) return sink.already_reported();
    if (*now != file.before) {
      return sink.error_about(base::DiagnosticCode::kFileNotWritable, file.name,
                              "it changed while the repair was looked for");
    }
    targets.push_back(std::move(target));
  }
  for (std::size_t i = 0; i < targets.size(); ++i) {
    std::error_code error;
    const auto status = std::filesystem::status(targets[i], error);
    if (!base::write_file_atomically(targets[i], proposal.files[i].after, sink)) {
      return sink.already_reported();
    }
    if (!error) std::filesystem::permissions(targets[i], status.permissions(), error);
  }
  return base::Unit{};
}

}  // namespace parallax::tools
