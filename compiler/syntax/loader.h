#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

struct Foundation {
  std::string_view path;  // "foundations/EC.e"
  std::string_view text;
};

/// The texts inside the program, by path.
std::span<const Foundation> foundations();
std::optional<Foundation> find_foundation(std::string_view path);

struct LoadOptions {
  std::vector<std::filesystem::path> include_dirs = {};  // -I, in order
  std::vector<std::filesystem::path> named_by = {};      // files that name the models: a scenario
  bool allow_outside = false;                            // load from anywhere
  bool implicit_foundations = true;  // Root.e and EC.e where the model loads no foundation itself
};

/// A model: its texts, and the order in which its statements act.
struct ModelAst {
  struct File {
    Ast ast;
    bool built_in = false;  // one of our foundations
    /// A file on disk with the name of a foundation, which is loaded as well: statements that both
    /// have count as repetitions.
    bool repeats_foundation = false;
  };
  struct Place {
    std::uint32_t file = 0;       // index into `files`
    std::uint32_t statement = 0;  // index into its statements
  };
  std::vector<File> files;
  /// Every statement of every file, a loaded file at the place of its `load`. `load` statements
  /// themselves are not among them.
  std::vector<Place> order;

  const Ast& ast(const Place& place) const { return files[place.file].ast; }
  const Statement& statement(const Place& place) const {
    return files[place.file].ast.statements()[place.statement];
  }
};

/// Reads the model files and what they load. `load PATH` is looked up beside the loading file, in
/// the include folders, in the current folder, among the built-in foundations. A built-in one is
/// loaded by its name even where a file on disk has that name, and the file after it. Each file is
/// read once (by its real path), so cycles are harmless (W1019 says so). Folders, FIFOs and devices
/// are refused (E1015), and so is what a PathGate with the model files, the files that name them,
/// the include folders and the current folder does not admit (E1016), unless `allow_outside`. Fails
/// only if a text could not be read; syntax errors are reported and what is left is returned, so
/// that the checker can go on. Ask the sink before using the model.
base::Result<ModelAst> load_model(std::span<const std::filesystem::path> paths,
                                  const LoadOptions& options, base::SourceFiles& files,
                                  base::DiagnosticSink& sink);

/// A model whose main text is already among `files` (a test, a text inside another document).
/// Loads are looked up as if the file stood in `folder`.
base::Result<ModelAst> load_model_text(base::FileId main, const std::filesystem::path& folder,
                                       const LoadOptions& options, base::SourceFiles& files,
                                       base::DiagnosticSink& sink);

}  // namespace parallax::compiler
