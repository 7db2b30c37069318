#pragma once

#include <string>
#include <vector>

#include "tools/lsp/name_map.h"

namespace parallax::tools::lsp {

/// The entries of a binding table, under keys such as "motion going", "query object-in-hand".
/// Entries that are half typed are taken as far as they go.
std::vector<DeclaredName> designators_of(const std::string& path, const std::string& text);

/// The functions that a plan defines, under keys such as "function fetch-box".
std::vector<DeclaredName> functions_of(const std::string& path, const std::string& text);

/// Places in a binding table that name entries or functions of plans, ascending. Keys that nothing
/// declares are among them.
std::vector<NameMap::Word> words_of_table(const std::string& text);

/// Places in a plan where a designator that is performed, a question or a goal says its type or
/// name, and where functions are defined and called, ascending. Keys that nothing declares are
/// among them.
std::vector<NameMap::Word> words_of_plan(const std::string& text);

}  // namespace parallax::tools::lsp
