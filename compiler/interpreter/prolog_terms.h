#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/id.h"
#include "compiler/builtins/plan_value.h"

namespace parallax::compiler {

struct PrologTermTag {};
using PrologTermId = base::Id<PrologTermTag>;

/// The terms of one proof: values of the plan, pairs and variables. A list that is a value is taken
/// apart only where a variable may come to stand in it. Bindings are undone back to a mark.
class TermStore {
 public:
  explicit TermStore(ValueStore& values) : values_(values) {}

  PrologTermId atom(ValueId value);
  PrologTermId variable();
  PrologTermId pair(PrologTermId head, PrologTermId tail);
  PrologTermId nil() { return atom(values_.nil()); }
  PrologTermId list(const std::vector<PrologTermId>& items);
  /// Quoted data as a term: symbols that begin with `?` become variables, those of one name one.
  PrologTermId from_data(ValueId data, std::map<std::string, PrologTermId>& variables);

  /// Current binding of the term: an atom, a pair or a free variable.
  PrologTermId walk(PrologTermId term) const;
  bool is_variable(PrologTermId term) const {
    return nodes_[walk(term).index()].kind == Kind::kVariable;
  }
  /// The value of an atom; none for pairs and free variables.
  std::optional<ValueId> atom_value(PrologTermId term) const;
  /// Head and tail of a pair, or of a list that is a value.
  std::optional<std::pair<PrologTermId, PrologTermId>> split(PrologTermId term);
  /// The elements of a proper list.
  std::optional<std::vector<PrologTermId>> elements(PrologTermId term);
  bool is_nil(PrologTermId term) const;
  /// The name of a symbol or keyword.
  std::optional<std::string> symbol(PrologTermId term) const;

  /// Makes them equal, or leaves bindings behind that are to be undone. No term comes to stand in
  /// itself.
  bool unify(PrologTermId left, PrologTermId right);
  std::size_t mark() const { return trail_.size(); }
  void undo(std::size_t mark);
  /// The whole term as a value; none if a variable in it is free.
  std::optional<ValueId> value(PrologTermId term);
  /// A copy with its own variables in the place of the free ones.
  PrologTermId copy(PrologTermId term);
  /// More work than any rule needs: a term that doubles with each step holds few nodes, but walking
  /// over it takes for ever. What is said of terms from then on is wrong; the proof must end.
  bool exhausted() const { return work_ > kMaxWork || nodes_.size() > kMaxNodes; }

 private:
  enum class Kind : std::uint8_t { kAtom, kPair, kVariable };
  struct Node {
    Kind kind = Kind::kAtom;
    bool bound = false;  // kVariable: to `first`
    std::uint32_t first = 0;
    std::uint32_t second = 0;
  };
  static constexpr std::int64_t kMaxWork = 20'000'000;
  static constexpr std::size_t kMaxNodes = 5'000'000;
  bool occurs(PrologTermId variable, PrologTermId term) const;

  ValueStore& values_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> trail_;
  mutable std::int64_t work_ = 0;
};

}  // namespace parallax::compiler
