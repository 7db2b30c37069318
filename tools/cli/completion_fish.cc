#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/cli/completion.h"

namespace parallax::tools {
namespace {

constexpr const char* kFishFrame = R"(
# The command that is being typed, and how many words of its own stand before the cursor.
function __parallax_place
    set -l command
    set -l position 0
    set -l is_value no
    set -l is_rest no
    for word in (commandline -opc)[2..-1]
        if test $is_rest = yes
            set position (math $position + 1)
        else if test $is_value = yes
            set is_value no
        else if test "$word" = --
            set is_rest yes
        else if string match -q -- '-*' $word
            contains -- $word (__parallax_valued "$command"); and set is_value yes
        else if test -z "$command"
            set command $word
        else
            set position (math $position + 1)
        end
    end
    echo $command
    echo $position
end

# __parallax_at COMMAND [FIRST [LAST]]: is it being typed, and such a word of it?
function __parallax_at
    set -l place (__parallax_place)
    test "$place[1]" = "$argv[1]"; or return 1
    test (count $argv) -lt 2; and return 0
    test $place[2] -ge $argv[2]; or return 1
    test (count $argv) -lt 3; or test $place[2] -le $argv[3]
end

complete -c parallax -f
complete -c parallax -n '__parallax_at ""' -s h -l help -d 'Print the help of the program'
complete -c parallax -n '__parallax_at ""' -l version -d 'Print versions'
complete -c parallax -n 'not __parallax_at ""' -s h -l help -d 'Print the help of the command'
)";

/// Within single quotes fish reads a backslash before these two alone.
std::string for_fish(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + '\'';
}

std::string fish_values(const Option& option) {
  const auto words = offered_words(option);
  if (!words.empty()) return " -a " + for_fish(fmt::format("{}", fmt::join(words, " ")));
  switch (option.source) {
    case ValueSource::kFiles: {
      // A list of files behind an optional `=` makes fish offer the option twice.
      if (option.is_flag) return "";
      std::string out = option.endings.empty() ? " -F" : "";
      for (const auto& ending : option.endings) out += " (__fish_complete_suffix ." + ending + ")";
      return option.endings.empty() ? out : " -k -a " + for_fish(out.substr(1));
    }
    case ValueSource::kFolders:
      return " -a '(__fish_complete_directories)'";
    case ValueSource::kPrograms:
      return " -F -a '(__fish_complete_command)'";
    case ValueSource::kWords:
      break;
  }
  return "";
}

/// Files of any name are offered by fish itself.
bool takes_any_file(const Option& option) {
  return option.source == ValueSource::kPrograms ||
         (option.source == ValueSource::kFiles && option.endings.empty());
}

std::string fish_flag(const std::string& condition, const Option& option) {
  std::string out = fmt::format("complete -c parallax -n {}", for_fish(condition));
  for (const auto& name : names_of(option)) {
    out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  switch (value_form(option)) {
    case ValueForm::kNone:
      break;
    case ValueForm::kAttached:
      out += fish_values(option);
      break;
    case ValueForm::kWord:
    case ValueForm::kWords:
      // -r alone would offer files.
      out += (takes_any_file(option) ? " -r" : " -x") + fish_values(option);
      break;
  }
  return out + " -d " + for_fish(brief(option.help)) + "\n";
}

std::string fish_command(const OptionTable& command) {
  const auto at = "__parallax_at " + command.name();
  std::string out = fmt::format("\ncomplete -c parallax -n '__parallax_at \"\"' -a {} -d {}\n",
                                command.name(), for_fish(brief(command.description())));
  for (const auto* option : flags_of(command)) {
    if (option->heading != kGeneralHeading) out += fish_flag(at, *option);
  }
  std::size_t place = 0;
  for (const auto* option : positionals_of(command)) {
    const auto values = fish_values(*option);
    const auto last = takes_rest(*option) ? "" : fmt::format(" {}", place);
    if (!values.empty()) {
      out += fmt::format("complete -c parallax -n '{} {}{}'{}\n", at, place, last, values);
    }
    ++place;
  }
  return out;
}

/// Options whose value is the next word, which is then none of the command's own.
std::string fish_valued(const Program& program) {
  std::string out = "\nfunction __parallax_valued\n    switch $argv[1]\n";
  for (const auto* command : shown_commands(program)) {
    std::string names;
    for (const auto* option : flags_of(*command)) {
      if (option->is_flag) continue;
      for (const auto& name : names_of(*option)) names += " " + name;
    }
    out += fmt::format("        case {}\n            printf '%s\\n'{}\n", command->name(), names);
  }
  return out + "    end\nend\n";
}

}  // namespace

std::string fish_completion(const Program& program) {
  std::string out = "# fish completion for parallax, made by `parallax completion fish`\n";
  out += fish_valued(program) + kFishFrame;
  for (const auto* option : flags_of(*program.commands.front())) {
    if (option->heading == kGeneralHeading) out += fish_flag("not __parallax_at \"\"", *option);
  }
  for (const auto* command : shown_commands(program)) out += fish_command(*command);
  return out;
}

}  // namespace parallax::tools
