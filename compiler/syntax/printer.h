#pragma once

#include <string>

#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// The formula below `root` on one line with as few parentheses as its shape allows, without a
/// final period. Parsing the text gives the same tree (same_tree).
std::string print_formula(const Ast& ast, NodeId root);

/// One statement or formula on one line; a formula with its label and period.
std::string print_statement(const Ast& ast, const Statement& statement);

/// All statements and formulas, one a line, comments left out. Parsing the text gives the same
/// statements.
std::string print_file(const Ast& ast);

}  // namespace parallax::compiler
