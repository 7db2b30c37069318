#include "tools/cli/man_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "tools/cli/completion.h"
#include "tools/cli/help_topics.h"
#include "tools/cli/roff.h"

namespace parallax::tools {
namespace {

char upper_letter(char letter) {
  return static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
}

std::string upper(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '-' ? ' ' : upper_letter(c);
  return out;
}

/// A range is shown only if it means something, not where it is that of a machine type.
struct RangeText {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const OneOf& one) const {
    return fmt::format("One of: {}.", fmt::join(one.values, ", "));
  }
  std::string operator()(SeedNumber) const { return "A whole number from 0 on, or `new`."; }
  std::string operator()(const WholeNumber& range) const { return whole(range.lower, range.upper); }
  std::string operator()(const IntRange& range) const { return whole(range.lower, range.upper); }
  std::string operator()(const FiniteNumber& range) const {
    return fmt::format("A number from {} to {}.", range.lower, range.upper);
  }
  std::string operator()(NonNegative) const { return "A number from 0 on."; }
  std::string operator()(Positive) const { return "A number greater than 0."; }

 private:
  static std::string whole(std::int64_t lower, std::int64_t upper) {
    constexpr std::int64_t kTellsNothing = std::int64_t{1} << 40U;
    if (upper >= kTellsNothing) return fmt::format("A whole number from {} on.", lower);
    return fmt::format("A whole number from {} to {}.", lower, upper);
  }
};

struct DefaultText {
  std::string operator()(const bool*) const { return ""; }
  std::string operator()(const std::vector<std::string>*) const { return ""; }
  std::string operator()(const std::string* text) const { return *text; }
  template <typename Number>
  std::string operator()(const Number* number) const {
    return fmt::format("{}", *number);
  }
};

/// Placeholder for the value of an option: a word for its kind.
std::string value_word(const Option& option) {
  if (value_form(option) == ValueForm::kNone) return "";
  if (!option.value_name.empty()) return option.value_name;
  std::string word = "TEXT";
  if (option.source == ValueSource::kFiles) word = "FILE";
  if (option.source == ValueSource::kFolders) word = "FOLDER";
  if (!std::holds_alternative<std::monostate>(option.value_check)) word = "N";
  if (!offered_words(option).empty()) word = "WORD";
  return value_form(option) == ValueForm::kWords ? word + "..." : word;
}

std::string option_text(const Option& option) {
  std::string out = option.help;
  const auto add = [&out](const std::string& sentence) {
    if (sentence.empty()) return;
    out += (out.empty() || out.ends_with('.') ? "" : ".") + std::string(out.empty() ? "" : " ");
    out += sentence;
  };
  add(option.more);
  if (!option.is_flag) add(std::visit(RangeText{}, option.value_check));
  if (option.shows_default) {
    const auto value = std::visit(DefaultText{}, option.target);
    if (!value.empty()) add(fmt::format("Default: {}.", value));
  }
  if (!option.partners.empty()) add(fmt::format("Needs {}.", fmt::join(option.partners, ", ")));
  return out.empty() ? "Not documented." : out;
}

void write_option(Roff& roff, const Option& option) {
  roff.entry(fmt::format("{}", fmt::join(names_of(option), ", ")), value_word(option),
             option_text(option));
}

std::string synopsis_of(const OptionTable& command) {
  std::string words = "[OPTION]...";
  for (const auto* option : positionals_of(command)) {
    const auto name = upper(option->names) + (takes_rest(*option) ? "..." : "");
    words += option->is_required ? " " + name : " [" + name + "]";
  }
  return words;
}

/// A footer by its parts: "Examples:", "Exit codes: ...", and what else is told.
struct FooterParts {
  std::string examples, exit, rest;
};
FooterParts parts_of(const std::string& footer) {
  FooterParts parts;
  std::string* now = &parts.rest;
  std::string_view left = footer;
  while (!left.empty()) {
    const auto end = left.find('\n');
    auto line = left.substr(0, end);
    left.remove_prefix(end == std::string_view::npos ? left.size() : end + 1);
    if (line == "Examples:") {
      now = &parts.examples;
      continue;
    }
    if (line.starts_with("Exit code")) {
      now = &parts.exit;
    } else if (now == &parts.examples && !line.starts_with(' ')) {
      now = &parts.rest;
    }
    *now += fmt::format("{}\n", line);
  }
  return parts;
}

void write_options(Roff& roff, const OptionTable& command) {
  const auto positionals = positionals_of(command);
  if (!positionals.empty()) {
    roff.section("ARGUMENTS");
    for (const auto* option : positionals) {
      roff.entry(upper(option->names) + (takes_rest(*option) ? "..." : ""), "",
                 option_text(*option));
    }
  }
  roff.section("OPTIONS");
  std::vector<std::string> headings;
  for (const auto* option : flags_of(command)) {
    if (std::find(headings.begin(), headings.end(), option->heading) == headings.end()) {
      headings.push_back(option->heading);
    }
  }
  for (const auto& heading : headings) {
    if (heading != "Options") roff.subsection(heading);
    for (const auto* option : flags_of(command)) {
      if (option->heading == heading) write_option(roff, *option);
    }
  }
  roff.entry("-h, --help", "", "Print the help of the command and exit.");
}

std::string page_name(const OptionTable& command) { return "parallax-" + command.name(); }

}  // namespace

std::string command_page(const Program& program, const OptionTable& command,
                         const ManualEdition& edition) {
  const auto parts = parts_of(command.footer());
  auto title = page_name(command);
  for (auto& letter : title) letter = upper_letter(letter);
  Roff roff(title, edition.date, program.table.name() + " " + edition.version);
  roff.section("NAME");
  roff.title_line(page_name(command), command.description());
  roff.section("SYNOPSIS");
  roff.synopsis("parallax " + command.name(), synopsis_of(command));
  if (!parts.rest.empty()) {
    roff.section("DESCRIPTION");
    roff.mixed(parts.rest);
  }
  write_options(roff, command);
  if (!parts.exit.empty()) {
    roff.section("EXIT STATUS");
    roff.mixed(parts.exit);
  }
  if (!parts.examples.empty()) {
    roff.section("EXAMPLES");
    roff.mixed(parts.examples);
  }
  roff.section("SEE ALSO");
  roff.text(
      "parallax(1), which says what is true of all commands: exit codes, files, what is "
      "printed where, seeds, trust and limits.");
  return roff.page();
}

std::string program_page(const Program& program, const ManualEdition& edition) {
  Roff roff("PARALLAX", edition.date, program.table.name() + " " + edition.version);
  const auto parts = parts_of(program.table.footer());
  roff.section("NAME");
  auto description = program.table.description();
  if (description.ends_with('.')) description.pop_back();
  roff.title_line("parallax", description);
  roff.section("SYNOPSIS");
  roff.synopsis("parallax", "COMMAND [OPTION]... [ARGUMENT]...");
  roff.section("COMMANDS");
  const auto commands = shown_commands(program);
  std::vector<std::string> subjects;
  for (const auto* command : commands) {
    if (std::find(subjects.begin(), subjects.end(), command->subject()) == subjects.end()) {
      subjects.push_back(command->subject());
    }
  }
  for (const auto& subject : subjects) {
    roff.subsection(subject);
    for (const auto* command : commands) {
      if (command->subject() == subject) {
        roff.entry(page_name(*command) + "(1)", "", command->description());
      }
    }
  }
  roff.section("OPTIONS");
  roff.entry("-h, --help", "", "Print the commands and exit; behind a command, its options.");
  roff.entry("--version", "", "Print versions and exit.");
  for (const auto& topic : help_topics()) {
    roff.section(topic.name == "exit-codes" ? "EXIT STATUS" : upper(topic.name));
    roff.mixed(topic.text);
  }
  roff.section("EXAMPLES");
  roff.mixed(parts.examples);
  return roff.page();
}

}  // namespace parallax::tools
