#include "compiler/ground/ground_term.h"

#include <utility>

namespace parallax::compiler {

GroundTermId GroundTermStore::intern(Key key, GroundTerm term) {
  const auto found = index_.find(key);
  if (found != index_.end()) return found->second;
  const auto id = terms_.add(std::move(term));
  index_.emplace(std::move(key), id);
  return id;
}

GroundTermId GroundTermStore::object(ObjectId id) {
  GroundTerm term;
  term.kind = TermKind::kObject;
  term.object = id;
  return intern({0, id.index(), {}}, std::move(term));
}

GroundTermId GroundTermStore::integer(std::int64_t value) {
  GroundTerm term;
  term.kind = TermKind::kInteger;
  term.integer = value;
  return intern({1, value, {}}, std::move(term));
}

GroundTermId GroundTermStore::apply(SymbolId symbol, std::vector<GroundTermId> arguments) {
  std::vector<std::uint32_t> key;
  key.reserve(arguments.size());
  for (const auto argument : arguments) key.push_back(argument.index());
  GroundTerm term;
  term.kind = TermKind::kApply;
  term.symbol = symbol;
  term.arguments = std::move(arguments);
  return intern({2, symbol.index(), std::move(key)}, std::move(term));
}

std::string GroundTermStore::text(GroundTermId id, const TypedModel& model) const {
  // Pieces still to print, the last first; a term is replaced by its parts.
  struct Piece {
    bool is_term = false;
    GroundTermId term;
    const char* text = "";
  };
  std::string out;
  std::vector<Piece> todo = {{true, id, ""}};
  while (!todo.empty()) {
    const auto piece = todo.back();
    todo.pop_back();
    if (!piece.is_term) {
      out += piece.text;
      continue;
    }
    const auto& term = terms_[piece.term];
    if (term.kind == TermKind::kObject) {
      out += model.objects[term.object].name;
    } else if (term.kind == TermKind::kInteger) {
      out += std::to_string(term.integer);
    } else {
      out += model.symbols[term.symbol].name + "(";
      todo.push_back({false, {}, ")"});
      for (std::size_t i = term.arguments.size(); i-- > 0;) {
        todo.push_back({true, term.arguments[i], ""});
        if (i > 0) todo.push_back({false, {}, ","});
      }
    }
  }
  return out;
}

}  // namespace parallax::compiler
