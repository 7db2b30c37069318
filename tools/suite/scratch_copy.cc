#include "tools/suite/scratch_copy.h"

#include <system_error>

#include "compiler/base/file_io.h"
#include "compiler/base/file_names.h"
#include "compiler/base/path_gate.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

base::Status write_new(const fs::path& target, const std::string& text,
                       base::DiagnosticSink& sink) {
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  return base::write_file_atomically(target, text, sink);
}

}  // namespace

base::Result<ScratchCopy> ScratchCopy::make(const SuiteTexts& texts, const fs::path& folder,
                                            base::DiagnosticSink& sink) {
  ScratchCopy out;
  out.folder_ = folder;
  out.root_ = base::common_folder(texts);
  // Marks the folder as the root, so that names that the originals may use stay allowed in the
  // copy.
  if (!write_new(folder / base::kRootMarker, "", sink)) return sink.already_reported();
  for (const auto& [name, text] : texts) {
    const auto target = folder / fs::path(name).lexically_relative(out.root_);
    if (!write_new(target, text, sink)) return sink.already_reported();
    out.copies_.emplace(name, Copy{target, base::real_path(name), text});
  }
  return out;
}

fs::path ScratchCopy::place_of(const std::string& name) const {
  const auto copy = copies_.find(base::absolute_name(name));
  return copy == copies_.end() ? fs::path(name) : copy->second.target;
}

base::Status ScratchCopy::write(const std::string& name, const std::string& text,
                                base::DiagnosticSink& sink) const {
  const auto& original = copies_.at(base::absolute_name(name)).original;
  for (const auto& [other, copy] : copies_) {
    if (copy.original != original) continue;
    if (!base::write_file_atomically(copy.target, text, sink)) return sink.already_reported();
  }
  return base::Unit{};
}

base::Status ScratchCopy::restore(const std::string& name, base::DiagnosticSink& sink) const {
  return write(name, copies_.at(base::absolute_name(name)).text, sink);
}

}  // namespace parallax::tools
