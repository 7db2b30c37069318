#include "tools/cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <sstream>

#include "compiler/base/whole_number.h"
#include "tools/cli/output.h"

namespace parallax::tools {
namespace {

CLI::Validator finite_range(double lower, double upper) {
  const auto check = [lower, upper](std::string& text) -> std::string {
    double value = 0.0;
    // NaN compares false with everything, so test for the allowed range.
    const bool fine = CLI::detail::lexical_cast(text, value) && value >= lower && value <= upper;
    return fine ? std::string() : fmt::format("{} is no number from {} to {}", text, lower, upper);
  };
  return CLI::Validator(check, fmt::format("[{} - {}]", lower, upper));
}

CLI::Validator whole_number(std::int64_t lower, std::int64_t upper) {
  const auto check = [lower, upper](std::string& text) -> std::string {
    const auto value = base::whole_number<std::int64_t>(text);
    const bool fine = value && *value >= lower && *value <= upper;
    return fine ? std::string()
                : fmt::format("{} is no whole number from {} to {}", text, lower, upper);
  };
  return CLI::Validator(check, "N");
}

/// With its own message: the library prints the greatest double digit by digit.
CLI::Validator number_from_0(bool and_0) {
  const auto check = [and_0](std::string& text) -> std::string {
    double value = 0.0;
    const bool fine =
        CLI::detail::lexical_cast(text, value) && (value > 0.0 || (and_0 && value == 0.0));
    return fine ? std::string()
                : fmt::format("{} is no number {}", text, and_0 ? "from 0 on" : "greater than 0");
  };
  return CLI::Validator(check, and_0 ? "NONNEGATIVE" : "POSITIVE");
}

/// `new` becomes a number that the operating system draws, as if it had been typed.
CLI::Validator seed_number() {
  const auto check = [](std::string& text) -> std::string {
    if (text == "new") {
      std::random_device machine;
      const auto bits = (std::uint64_t{machine()} << 32U) | machine();
      text = std::to_string(bits & static_cast<std::uint64_t>(kMaxSeed));
      return {};
    }
    const auto value = base::whole_number<std::int64_t>(text);
    const bool fine = value && *value >= 0 && *value <= kMaxSeed;
    return fine
               ? std::string()
               : fmt::format("{} is neither `new` nor a whole number from 0 to {}", text, kMaxSeed);
  };
  return CLI::Validator(check, "N");
}

struct AddCheck {
  CLI::Option& option;

  void operator()(std::monostate) const {}
  void operator()(const OneOf& one) const { option.check(CLI::IsMember(one.values)); }
  void operator()(const WholeNumber& range) const {
    option.check(whole_number(range.lower, range.upper));
  }
  void operator()(SeedNumber) const {
    option.transform(seed_number());
    option.type_name("N");
  }
  void operator()(const FiniteNumber& range) const {
    option.check(finite_range(range.lower, range.upper));
  }
  void operator()(const IntRange& range) const {
    option.check(CLI::Range(range.lower, range.upper));
  }
  void operator()(NonNegative) const { option.check(number_from_0(true)); }
  void operator()(Positive) const { option.check(number_from_0(false)); }
};

CLI::Option* add_flag(CLI::App& app, const Option& from) {
  if (auto* const* counter = std::get_if<int*>(&from.target)) {
    return app.add_flag(from.names, **counter, from.help);
  }
  if (auto* const* text = std::get_if<std::string*>(&from.target)) {
    return app.add_flag(from.names, **text, from.help);
  }
  return app.add_flag(from.names, *std::get<bool*>(from.target), from.help);
}

CLI::Option* add_option(CLI::App& app, const Option& from) {
  auto* added =
      from.is_flag
          ? add_flag(app, from)
          : std::visit([&](auto* target) { return app.add_option(from.names, *target, from.help); },
                       from.target);
  if (from.is_required) added->required();
  if (from.form != ListForm::kAsManyAsFollow) {
    added->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }
  if (from.form == ListForm::kOneEachTime) added->allow_extra_args(false);
  std::visit(AddCheck{*added}, from.value_check);
  if (!from.value_name.empty()) added->type_name(from.value_name);
  if (from.shows_default) added->capture_default_str();
  added->group(from.heading);
  return added;
}

/// The declarations of a table, and which of them were given.
class Declared {
 public:
  void add(CLI::App& app, const OptionTable& table) {
    if (!table.footer().empty()) app.footer(table.footer());
    std::map<std::string, CLI::Option*> by_name;
    for (const auto& option : table.options()) {
      auto* added = add_option(app, option);
      by_name[option.names] = added;
      if (option.was_given != nullptr) asked_.emplace_back(added, option.was_given);
    }
    // Declared again, so that it stands last.
    app.set_help_flag("-h,--help", "Print this help message and exit")->group(kGeneralHeading);
    for (const auto& option : table.options()) {
      for (const auto& other : option.partners) by_name.at(option.names)->needs(by_name.at(other));
    }
  }
  void tell() const {
    for (const auto& [option, flag] : asked_) *flag = option->count() > 0;
  }

 private:
  std::vector<std::pair<const CLI::Option*, bool*>> asked_;
};

/// The long options of the application and of the subcommand that was parsed; without one, the
/// names of all commands.
std::vector<std::string> known_names(const CLI::App& app) {
  std::vector<std::string> names;
  const auto collect = [&](const CLI::App& from) {
    for (const auto* option : from.get_options()) {
      for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    }
  };
  collect(app);
  for (const auto* sub : app.get_subcommands()) collect(*sub);
  if (app.get_subcommands().empty()) {
    for (const auto* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(sub->get_name());
    }
  }
  return names;
}

/// The library leaves two empty lines between groups of options.
std::string with_single_gaps(std::string text) {
  for (auto at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n", at)) {
    text.erase(at, 1);
  }
  return text;
}

bool ends_in_one_of(const std::string& word, const std::vector<std::string>& endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](const std::string& ending) { return word.ends_with('.' + ending); });
}

/// Is `word`, which stands behind the flag, the file that belongs behind its `=`? As a positional
/// argument it would be one that is read.
bool is_value_of(const Option& flag, const OptionTable& table, const std::string& word) {
  if (word.empty() || word.front() == '-') return false;
  if (ends_in_one_of(word, flag.endings)) return true;
  for (const auto& option : table.options()) {
    if (option.is_positional() && ends_in_one_of(word, option.endings)) return false;
  }
  std::error_code error;
  return !std::filesystem::exists(word, error);
}

/// Detects `--certify FILE` without `=`: a blank ends a flag with an optional value, so the file
/// would be taken for an argument. Returns the message, or an empty text.
std::string detached_value(const OptionTable& table, int argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;
    for (const auto& option : table.options()) {
      const bool takes_file = option.is_flag && option.source == ValueSource::kFiles &&
                              std::holds_alternative<std::string*>(option.target);
      if (!takes_file || option.names != word || !is_value_of(option, table, argv[i + 1])) continue;
      return fmt::format("the file of {0} stands behind `=`: write `{0}={1}`", word, argv[i + 1]);
    }
  }
  return {};
}

}  // namespace

ParsedLine parse_command_line(const Program& program, int argc, char** argv) {
  CLI::App app(program.table.description(), program.table.name());
  Declared declared;
  if (!program.version.empty()) {
    app.set_version_flag("--version", program.version)->group(kGeneralHeading);
  }
  if (program.needs_command) app.require_subcommand(1);
  declared.add(app, program.table);
  std::vector<const CLI::App*> commands;
  for (const auto* table : program.commands) {
    auto* command = app.add_subcommand(table->name(), table->description());
    if (!table->subject().empty()) command->group(table->subject());
    if (table->is_hidden()) command->group("");
    declared.add(*command, *table);
    commands.push_back(command);
  }
  ParsedLine line;
  std::ostringstream output, messages;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {  // also --help and --version
    line.exit_code = app.exit(error, output, messages);
    line.output = with_single_gaps(output.str());
    line.messages = messages.str();
    if (dynamic_cast<const CLI::Success*>(&error) == nullptr) {
      line.error = error.what();
      line.known = known_names(app);
    }
  }
  if (!app.get_subcommands().empty()) {
    const auto at = std::find(commands.begin(), commands.end(), app.get_subcommands().front());
    line.command = static_cast<std::size_t>(at - commands.begin());
  }
  declared.tell();
  if (line.error.empty() && line.command) {
    line.error = detached_value(*program.commands[*line.command], argc, argv);
    if (!line.error.empty()) line.exit_code = 2;
  }
  return line;
}

ParsedLine parse_and_print(const Program& program, int argc, char** argv) {
  auto line = parse_command_line(program, argc, argv);
  print(line.output);
  write_error(line.messages);
  return line;
}

}  // namespace parallax::tools
