#pragma once

#include <optional>
#include <string_view>

#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

/// How an artifact writes a kind: the enumerator without its `k`.
std::string_view to_string(AtomKind kind);
std::optional<AtomKind> atom_kind(std::string_view text);

/// True for the kinds that have no meaning outside the clauses and need no name.
inline bool is_nameless(AtomKind kind) {
  return kind == AtomKind::kAuxiliary || kind == AtomKind::kUnused;
}

}  // namespace parallax::compiler
