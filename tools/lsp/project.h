#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::compiler {
class Ast;
struct Statement;
}  // namespace parallax::compiler

namespace parallax::tools::lsp {

/// The text of a file as it is edited, or as it lies on disk; none where it cannot be read.
using TextOf = std::function<std::optional<std::string>(const std::string& path)>;

/// The files that `check` has to be asked about to look at a file with all that it reads: a
/// scenario, or one or more model files. Found by names that texts mention beside each other,
/// without compiling anything.
std::vector<std::string> roots_of(const std::string& path, const TextOf& text_of);

/// A root and every file that it mentions, directly or by others, as far as they lie beside each
/// other or below.
std::vector<std::string> files_below(const std::string& root, const TextOf& text_of);

/// The files of all roots that share a file with the roots of this one, and so on: those that a new
/// name concerns.
std::vector<std::string> family_of(const std::string& path, const TextOf& text_of);

enum class NameKind { kSort, kConstant, kFluent, kEvent, kPredicate, kFunction };

/// A name that a model declares.
struct DeclaredName {
  std::string name;
  NameKind kind = NameKind::kConstant;
  std::string declaration;  // "fluent BoxIn(region)"
  std::string comment;      // the lines above it
  std::string path;
  std::size_t begin = 0, end = 0;  // of the name in the file's text
};

struct NamedPlace {
  std::string path;
  std::size_t begin = 0, end = 0;
  friend bool operator==(const NamedPlace&, const NamedPlace&) = default;
};

/// Declared names of some files, and where they stand in all of them: models, binding tables and
/// scenarios. Works on texts that are half typed: what cannot be parsed is left out.
class NameMap {
 public:
  NameMap(const std::vector<std::string>& paths, const TextOf& text_of);

  const std::map<std::string, DeclaredName, std::less<>>& declared() const { return declared_; }
  /// The name at an offset of a file, as it is declared: of `region1` the sort `region`.
  const DeclaredName* at(const std::string& path, std::size_t offset) const;
  /// Every place of the name, by file and offset. Of a sort also its variables: the name and
  /// digits.
  std::vector<NamedPlace> places(const DeclaredName& name) const;
  /// The effect axioms that have the name as their event or fluent, one line each.
  std::vector<std::string> effects(const DeclaredName& name) const;

 private:
  struct Word {
    std::size_t begin = 0, end = 0;
    std::string name;  // as declared
  };
  void declare(const std::string& path, const std::string& text);
  void note_effects(const compiler::Ast& ast, const compiler::Statement& statement);
  const DeclaredName* resolve(std::string_view word) const;
  void add_words(const std::string& path, const std::string& text);

  std::map<std::string, DeclaredName, std::less<>> declared_;
  std::map<std::string, std::vector<Word>> words_;            // by path, ascending
  std::vector<std::pair<std::string, std::string>> effects_;  // a name in it, the axiom
};

std::string_view to_string(NameKind kind);

}  // namespace parallax::tools::lsp
