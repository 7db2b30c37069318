#pragma once

#include <string_view>

namespace parallax::compiler {

/// `Origin::what` of the clauses that deny, in the meaning of the 2005 reasoner, what no formula
/// mentions.
inline constexpr std::string_view kUnmentionedOrigin = "atom without a mention";

}  // namespace parallax::compiler
