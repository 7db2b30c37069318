#pragma once

#include <string>
#include <string_view>

namespace parallax::base {

/// The symbol of a ground atom: "Go" for "Go(r2)". A name without arguments is its own symbol.
inline std::string symbol_of(std::string_view atom) {
  return std::string(atom.substr(0, atom.find('(')));
}

/// Is the ground atom the one that was asked for, or an instance of the symbol that was?
inline bool is_instance(std::string_view ground, std::string_view asked) {
  return ground == asked || symbol_of(ground) == asked;
}

}  // namespace parallax::base
