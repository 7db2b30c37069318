#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/cli/completion.h"

namespace parallax::tools {
namespace {

/// Characters that end a part of a specification of `_arguments`.
std::string in_spec(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_action(const Option& option) {
  const auto words = offered_words(option);
  if (!words.empty()) return fmt::format("({})", fmt::join(words, " "));
  switch (option.source) {
    case ValueSource::kFiles:
      if (option.endings.empty()) return "_files";
      // Without an alternative the brackets would be something else.
      if (option.endings.size() == 1) return "_files -g \"*." + option.endings.front() + "\"";
      return fmt::format("_files -g \"*.({})\"", fmt::join(option.endings, "|"));
    case ValueSource::kFolders:
      return "_files -/";
    case ValueSource::kPrograms:
      return "_normal";
    case ValueSource::kWords:
      break;
  }
  return " ";
}

/// One specification for each name: they may all be given, and again where that makes a list.
std::string zsh_flag(const Option& option) {
  std::string out;
  const auto names = names_of(option);
  const auto form = value_form(option);
  const bool repeats = takes_rest(option) || std::holds_alternative<int*>(option.target);
  for (const auto& name : names) {
    std::string spec = repeats ? "*" : fmt::format("({})", fmt::join(names, " "));
    const bool is_long = name.starts_with("--");
    spec += name;
    if (form == ValueForm::kAttached) spec += "=-";
    if (form == ValueForm::kWord) spec += is_long ? "=" : "+";
    spec += fmt::format("[{}]", in_spec(brief(option.help)));
    const auto value = in_spec(is_long ? name.substr(2) : names.back().substr(2));
    if (form == ValueForm::kAttached) spec += fmt::format("::{}:{}", value, zsh_action(option));
    if (form == ValueForm::kWord) spec += fmt::format(":{}:{}", value, zsh_action(option));
    if (form == ValueForm::kWords) spec += fmt::format(":*-*:{}:{}", value, zsh_action(option));
    out += " \\\n        " + in_quotes(spec);
  }
  return out;
}

std::string zsh_positionals(const OptionTable& command) {
  std::string out;
  std::size_t at = 1;
  for (const auto* option : positionals_of(command)) {
    const char* colons = option->source == ValueSource::kPrograms ? ":::" : ":";
    const auto spec = takes_rest(*option)
                          ? fmt::format("*{}{}:{}", colons, option->names, zsh_action(*option))
                          : fmt::format("{}:{}:{}", at, option->names, zsh_action(*option));
    ++at;
    out += " \\\n        " + in_quotes(spec);
  }
  return out;
}

std::string zsh_general(const Program& program) {
  std::string out;
  for (const auto* option : flags_of(*program.commands.front())) {
    if (option->heading == kGeneralHeading) out += zsh_flag(*option);
  }
  return out;
}

}  // namespace

std::string zsh_completion(const Program& program) {
  std::string out =
      "#compdef parallax\n"
      "# zsh completion for parallax, made by `parallax completion zsh`\n"
      "\n"
      "_parallax() {\n"
      "  local curcontext=$curcontext state state_descr line\n"
      "  typeset -A opt_args\n"
      "  local -a commands general\n"
      "  general=(";
  out += zsh_general(program);
  out +=
      " \\\n        '(- *)'{-h,--help}'[Print the help of the command]')\n"
      "  commands=(\n";
  for (const auto* command : shown_commands(program)) {
    out += fmt::format("    {}\n",
                       in_quotes(command->name() + ":" + in_spec(brief(command->description()))));
  }
  out +=
      "  )\n"
      "  _arguments -C '(- *)'{-h,--help}'[Print the help of the program]' \\\n"
      "    '(- *)--version[Print versions]' \\\n"
      "    '1:command:->commands' '*::argument:->arguments'\n"
      "  case $state in\n"
      "    commands) _describe -t commands command commands ;;\n"
      "    arguments)\n"
      "      curcontext=${curcontext%:*}-$words[1]:\n"
      "      case $words[1] in\n";
  for (const auto* command : shown_commands(program)) {
    out += fmt::format("        {}) _arguments -s -S $general", command->name());
    for (const auto* option : flags_of(*command)) {
      if (option->heading != kGeneralHeading) out += zsh_flag(*option);
    }
    out += zsh_positionals(*command) + " ;;\n";
  }
  return out +
         "      esac ;;\n"
         "  esac\n"
         "}\n"
         "\n"
         "if [[ $funcstack[1] == _parallax ]]; then _parallax \"$@\"; else compdef _parallax "
         "parallax; fi\n";
}

}  // namespace parallax::tools
