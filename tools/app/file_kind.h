#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "tools/app/context.h"

namespace parallax::tools {

/// Kind of a file, by the ending of its name, or by its first bytes where they cannot be text.
enum class FileKind : std::uint8_t {
  kUnknown,  // anything else, and what cannot be read: whoever reads it says what is wrong
  kModel,
  kScenario,
  kManifest,
  kPlan,
  kBinding,
  kCompiled,
  kTraces,
  kProof,
  kRun,  // a folder with a journal
  kBinary,
};
FileKind file_kind(const std::string& path);

/// Reports (E0010) a file whose kind is not among `kinds`, with the command that takes it; `wanted`
/// says what belongs there, "a model".
base::Status expect_kind(const std::string& path, std::initializer_list<FileKind> kinds,
                         std::string_view wanted, Context& context);

}  // namespace parallax::tools
