#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "tools/cli/completion.h"

namespace parallax::tools {
namespace {

/// The part that is the same for every program: finds the word that is being typed and answers it.
constexpr const char* kBashFrame = R"(
# Sets COMPREPLY to the words, files, folders or programs that begin with $cur.
_parallax_reply() {
  local ending
  case $kind in
    words) mapfile -t COMPREPLY < <(compgen -W "$values" -- "$cur") ;;
    folders) mapfile -t COMPREPLY < <(compgen -d -- "$cur") ;;
    programs) mapfile -t COMPREPLY < <(compgen -c -- "$cur") ;;
    files)
      if [[ $values ]]; then
        mapfile -t COMPREPLY < <(
          compgen -d -- "$cur"
          for ending in $values; do compgen -f -X "!*.$ending" -- "$cur"; done)
      else
        mapfile -t COMPREPLY < <(compgen -f -- "$cur")
      fi ;;
  esac
  case $kind in files | folders) compopt -o filenames 2>/dev/null ;; esac
}

_parallax() {
  local cur kind='' values='' many='' attached='' command='' pending='' rest='' word
  local -i i position=0
  local -a line=()
  COMPREPLY=()
  # bash splits --name=value at the sign.
  for ((i = 1; i <= COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if ((${#line[@]} > 0)) && [[ ${line[-1]} == --* ]] &&
       { [[ $word == = && ${line[-1]} != *=* ]] || [[ ${line[-1]} == --*= ]]; }; then
      line[-1]+=$word
    else
      line+=("$word")
    fi
  done
  cur=${line[-1]}
  unset 'line[-1]'
  for word in "${line[@]}"; do
    if [[ $rest ]]; then
      position+=1
    elif [[ $word == -- ]]; then
      rest=yes pending=
    elif [[ $word == -?* ]]; then
      pending=
      [[ $word == *=* ]] && continue
      _parallax_value "$command" "$word"
      [[ $kind && ! $attached ]] && pending=$word
    elif [[ $pending ]]; then
      _parallax_value "$command" "$pending"
      [[ $many ]] || pending=
    elif [[ ! $command ]]; then
      command=$word
    else
      position+=1
    fi
  done
  kind='' values=''
  if [[ ! $rest && $cur == --*=* ]]; then
    local name=${cur%%=*} i
    _parallax_value "$command" "$name"
    cur=${cur#*=}
    _parallax_reply
    if [[ $COMP_WORDBREAKS != *=* ]]; then COMPREPLY=("${COMPREPLY[@]/#/$name=}"); fi
    return
  fi
  if [[ ! $rest && $cur == -* ]]; then
    _parallax_flags "$command"
  elif [[ $pending ]]; then
    _parallax_value "$command" "$pending"
  elif [[ ! $command ]]; then
    _parallax_commands
  else
    _parallax_positional "$command" "$position"
  fi
  _parallax_reply
}

complete -F _parallax parallax
)";

/// `kind=files values='yaml'`: what a value is, as the frame reads it.
std::string bash_kind(const Option& option) {
  const auto words = offered_words(option);
  if (!words.empty())
    return "kind=words values=" + in_quotes(fmt::format("{}", fmt::join(words, " ")));
  switch (option.source) {
    case ValueSource::kFiles:
      return "kind=files values=" + in_quotes(fmt::format("{}", fmt::join(option.endings, " ")));
    case ValueSource::kFolders:
      return "kind=folders";
    case ValueSource::kPrograms:
      return "kind=programs";
    case ValueSource::kWords:
      break;
  }
  return "kind=text";
}

/// `case` over a command and another word: patterns by what they do.
class BashCases {
 public:
  void add(const std::string& pattern, const std::string& does) {
    auto& patterns = by_act_[does];
    if (patterns.empty()) acts_.push_back(does);
    if (patterns.find("|" + pattern + "|") != std::string::npos) return;
    patterns += (patterns.empty() ? "|" : "") + pattern + "|";
  }
  std::string text() const {
    std::string out = "  case \"$1 $2\" in\n";
    for (const auto& act : acts_) {
      const auto& patterns = by_act_.at(act);
      out += fmt::format("    {}) {} ;;\n", patterns.substr(1, patterns.size() - 2), act);
    }
    return out + "  esac\n";
  }

 private:
  std::vector<std::string> acts_;
  std::map<std::string, std::string> by_act_;
};

std::string bash_function(const std::string& name, const std::string& body) {
  return fmt::format("\n{}() {{\n  kind='' values='' many='' attached=''\n{}}}\n", name, body);
}

std::string bash_values(const Program& program) {
  BashCases cases;
  for (const auto* command : shown_commands(program)) {
    for (const auto* option : flags_of(*command)) {
      const auto form = value_form(*option);
      if (form == ValueForm::kNone) continue;
      auto act = bash_kind(*option);
      if (form == ValueForm::kWords) act += " many=yes";
      if (form == ValueForm::kAttached) act += " attached=yes";
      // Options that every command has appear once.
      const bool is_general = option->heading == kGeneralHeading;
      for (const auto& name : names_of(*option)) {
        const auto pattern =
            is_general ? "*" + in_quotes(" " + name) : in_quotes(command->name() + " " + name);
        cases.add(pattern, act);
      }
    }
  }
  return bash_function("_parallax_value", cases.text());
}

std::string bash_positionals(const Program& program) {
  BashCases cases;
  BashCases rests;
  for (const auto* command : shown_commands(program)) {
    std::size_t at = 0;
    for (const auto* option : positionals_of(*command)) {
      const auto act = bash_kind(*option);
      if (!takes_rest(*option)) {
        cases.add(in_quotes(fmt::format("{} {}", command->name(), at++)), act);
      } else if (option->source == ValueSource::kPrograms) {
        cases.add(in_quotes(fmt::format("{} {}", command->name(), at)), act);
        rests.add(in_quotes(command->name() + " ") + "*", "kind=files");
      } else {
        rests.add(in_quotes(command->name() + " ") + "*", act);
      }
    }
  }
  return bash_function("_parallax_positional",
                       cases.text() + "  [[ $kind ]] && return\n" + rests.text());
}

std::string bash_flags(const Program& program) {
  std::string out = "\n_parallax_flags() {\n  kind=words\n  case $1 in\n";
  for (const auto* command : shown_commands(program)) {
    std::string words = "-h --help";
    for (const auto* option : flags_of(*command)) {
      for (const auto& name : names_of(*option)) words += " " + name;
    }
    out += fmt::format("    {}) values='{}' ;;\n", command->name(), words);
  }
  return out + "    *) values='-h --help --version' ;;\n  esac\n}\n";
}

}  // namespace

std::string bash_completion(const Program& program) {
  std::string commands;
  for (const auto* command : shown_commands(program)) {
    commands += (commands.empty() ? "" : " ") + command->name();
  }
  return "# bash completion for parallax, made by `parallax completion bash`\n" +
         fmt::format("\n_parallax_commands() {{\n  kind=words values='{}'\n}}\n", commands) +
         bash_flags(program) + bash_values(program) + bash_positionals(program) + kBashFrame;
}

}  // namespace parallax::tools
