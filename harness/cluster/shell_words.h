#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::harness {

/// Words of a command line, or what is wrong with it.
struct ShellWords {
  std::vector<std::string> words;
  std::string fault;         // empty: none
  std::size_t fault_at = 0;  // byte
};

/// Takes a command apart as a POSIX shell does: blanks, quotes of both kinds, backslashes. What a
/// shell would do beyond that (variables, patterns, pipes, comments) is a fault, for here nobody
/// does it; in quotes such characters stand for themselves.
ShellWords split_shell_words(std::string_view text);

}  // namespace parallax::harness
