#pragma once

#include <string>
#include <vector>

#include "tools/cli/command_line.h"

namespace parallax::tools {

/// Completion scripts for shells, made from the tables that parse the line. They know every command
/// that is not hidden, its options, the values of those that have a closed set, and where files and
/// folders are taken.
std::string bash_completion(const Program& program);
std::string zsh_completion(const Program& program);
std::string fish_completion(const Program& program);

/// How an option takes its value.
enum class ValueForm {
  kNone,
  kWord,      // the next word, or behind `=`
  kAttached,  // behind `=` alone, and need not be there
  kWords,     // all words up to the next option
};
ValueForm value_form(const Option& option);

/// "-j,--jobs" as {"-j", "--jobs"}.
std::vector<std::string> names_of(const Option& option);
/// Values that a shell offers: a closed set, or words that are offered beside others.
std::vector<std::string> offered_words(const Option& option);
/// The help of an option up to its first pause: what a menu has room for.
std::string brief(const std::string& help);
/// 'text', as every shell reads it; fish within its own rules.
std::string in_quotes(const std::string& text);
/// Does a list take this and all further words?
bool takes_rest(const Option& option);
/// The commands that are not hidden.
std::vector<const OptionTable*> shown_commands(const Program& program);
std::vector<const Option*> positionals_of(const OptionTable& table);
std::vector<const Option*> flags_of(const OptionTable& table);

}  // namespace parallax::tools
