#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "compiler/base/open_texts.h"
#include "tools/app/context.h"

namespace parallax::compiler {
struct Compilation;
}  // namespace parallax::compiler

namespace parallax::tools::lsp {

/// The result of compiling the texts of a model: the clauses of each axiom, declaration, perform
/// and constraint, and what they cost.
class CompiledTexts {
 public:
  /// Compiles a model or scenario as it is edited. After `seconds` it is given up.
  CompiledTexts(const std::string& root, const base::OpenTexts& texts, double seconds);

  /// Markdown about the shortest text around an offset of a file; empty where none is known, as
  /// in a model with errors.
  std::string about(const std::string& path, std::size_t offset) const;

 private:
  struct Compiled {
    std::size_t begin = 0, end = 0;
    std::string words;
  };

  void note(const compiler::Compilation& compilation, const Context& context);

  double seconds_;
  bool gave_up_ = false;
  std::map<std::string, std::vector<Compiled>> by_path_;
};

}  // namespace parallax::tools::lsp
