#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/lsp/project.h"

namespace parallax::compiler {
class Ast;
struct Statement;
}  // namespace parallax::compiler

namespace parallax::tools::lsp {

enum class NameKind : std::uint8_t {
  kSort,
  kConstant,
  kFluent,
  kEvent,
  kPredicate,
  kFunction,
  // Names of plans: an entry of a binding table, and a function of a plan.
  kDesignator,
  kPlanFunction,
};
inline constexpr std::size_t kNameKinds = 8;

constexpr bool is_of_plans(NameKind kind) { return kind >= NameKind::kDesignator; }

/// A name that a model, a binding table or a plan declares.
struct DeclaredName {
  std::string key;   // unique: the name itself, of plans with what it names, "motion going"
  std::string name;  // as it stands in texts
  NameKind kind = NameKind::kConstant;
  std::string declaration;  // "fluent BoxIn(region)"
  std::string comment;      // the lines above it
  std::string path;
  std::size_t begin = 0, end = 0;  // of the name in the file's text
  std::string event;               // kDesignator: the model's event that it performs; may be empty
};

struct NamedPlace {
  std::string path;
  std::size_t begin = 0, end = 0;
  friend bool operator==(const NamedPlace&, const NamedPlace&) = default;
};

/// Declared names of some files, and where they stand in all of them: models, plans, binding tables
/// and scenarios. Works on texts that are half typed: what cannot be parsed is left out.
class NameMap {
 public:
  NameMap(const std::vector<std::string>& paths, const TextOf& text_of);

  /// A place of a declared name in a file.
  struct Word {
    std::size_t begin = 0, end = 0;
    std::string key;
  };

  const std::map<std::string, DeclaredName, std::less<>>& declared() const { return declared_; }
  /// Null if nothing has this key.
  const DeclaredName* find(std::string_view key) const;
  /// The name at an offset of a file, as it is declared: of `region1` the sort `region`.
  const DeclaredName* at(const std::string& path, std::size_t offset) const;
  /// The places of names in a file, ascending.
  const std::vector<Word>& words(const std::string& path) const;
  /// Every place of the name, by file and offset. Of a sort also its variables: the name and
  /// digits.
  std::vector<NamedPlace> places(const DeclaredName& name) const;
  /// The places in plans that perform an event, by the entries of tables that name it.
  std::vector<NamedPlace> performs(const DeclaredName& event) const;
  /// The effect axioms that have the name as their event or fluent, one line each.
  std::vector<std::string> effects(const DeclaredName& name) const;

 private:
  void declare(const std::string& path, const std::string& text);
  void note_effects(const compiler::Ast& ast, const compiler::Statement& statement);
  const DeclaredName* resolve(std::string_view word) const;
  void add_words(const std::string& path, const std::string& text);

  std::map<std::string, DeclaredName, std::less<>> declared_;
  std::map<std::string, std::vector<Word>> words_;            // by path
  std::vector<std::pair<std::string, std::string>> effects_;  // a name in it, the axiom
};

}  // namespace parallax::tools::lsp
