#include "tools/cli/completion.h"

#include <algorithm>
#include <string_view>

namespace parallax::tools {

ValueForm value_form(const Option& option) {
  if (option.is_flag) {
    const bool takes_text = std::holds_alternative<std::string*>(option.target);
    return takes_text ? ValueForm::kAttached : ValueForm::kNone;
  }
  const bool is_list = std::holds_alternative<std::vector<std::string>*>(option.target);
  return is_list && option.form != ListForm::kOneEachTime ? ValueForm::kWords : ValueForm::kWord;
}

std::vector<std::string> names_of(const Option& option) {
  std::vector<std::string> names;
  std::string_view rest = option.names;
  while (true) {
    const auto comma = rest.find(',');
    names.emplace_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) return names;
    rest.remove_prefix(comma + 1);
  }
}

std::vector<std::string> offered_words(const Option& option) {
  if (const auto* one = std::get_if<OneOf>(&option.value_check)) return one->values;
  return option.offered;
}

std::string brief(const std::string& help) {
  constexpr std::string_view kPauses[] = {"; ", ": ", ". ", " ("};
  auto end = help.size();
  for (const auto pause : kPauses) end = std::min(end, help.find(pause));
  return help.substr(0, end);
}

std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  return out + '\'';
}

bool takes_rest(const Option& option) {
  return std::holds_alternative<std::vector<std::string>*>(option.target);
}

std::vector<const OptionTable*> shown_commands(const Program& program) {
  std::vector<const OptionTable*> shown;
  for (const auto* command : program.commands) {
    if (!command->is_hidden()) shown.push_back(command);
  }
  return shown;
}

std::vector<const Option*> positionals_of(const OptionTable& table) {
  std::vector<const Option*> found;
  for (const auto& option : table.options()) {
    if (option.is_positional()) found.push_back(&option);
  }
  return found;
}

std::vector<const Option*> flags_of(const OptionTable& table) {
  std::vector<const Option*> found;
  for (const auto& option : table.options()) {
    if (!option.is_positional()) found.push_back(&option);
  }
  return found;
}

}  // namespace parallax::tools
