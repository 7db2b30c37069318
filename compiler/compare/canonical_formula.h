#pragma once

#include <string>

#include "compiler/syntax/ast.h"

namespace parallax::compiler {

/// The formula as one line that is the same for every way of writing it that differs in layout,
/// parentheses, names of bound variables, order of the variables of a quantifier, nesting of equal
/// quantifiers, or order of the operands of `&`, `|`, `<->`, `=` and `!=`. Bound variables are
/// called by their sort and a number, in order of occurrence. Reading the line gives a formula with
/// the same canonical line.
///
/// Variables that nothing tells apart but the order of the text keep that order (the general
/// problem is graph isomorphism), and so do the operands of formulas whose size times depth times
/// variables exceeds kCanonicalWork. No recursion.
std::string canonical_formula(const Ast& ast, NodeId root);

inline constexpr std::size_t kCanonicalWork = 200'000'000;  // bytes written while sorting

}  // namespace parallax::compiler
