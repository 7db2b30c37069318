#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace parallax::tools {

/// Checks of an option's value. This one allows a word of the list.
struct OneOf {
  std::vector<std::string> values;
};
/// One of the words of an enum.
template <std::size_t kCount>
OneOf one_of(const std::array<std::string_view, kCount>& words) {
  return {{words.begin(), words.end()}};
}
struct WholeNumber {  // every character of it
  std::int64_t lower, upper;
};
/// Seeds stay below 2^53, so that every JSON reader keeps them.
inline constexpr std::int64_t kMaxSeed = (std::int64_t{1} << 53U) - 1;
/// A whole number from 0 to kMaxSeed, or `new`: a fresh one from the operating system.
struct SeedNumber {};
struct FiniteNumber {  // refuses what is no number, which compares with nothing
  double lower, upper;
};
struct IntRange {
  int lower, upper;
};
struct NonNegative {};
struct Positive {};
using ValueCheck = std::variant<std::monostate, OneOf, WholeNumber, SeedNumber, FiniteNumber,
                                IntRange, NonNegative, Positive>;

/// Where a value goes. A flag sets a bool, counts in an int, or takes a text after `=`.
using OptionTarget = std::variant<bool*, int*, std::int64_t*, std::uint64_t*, double*, std::string*,
                                  std::vector<std::string>*>;

/// How many values a list takes where it is named.
enum class ListForm {
  kAsManyAsFollow,
  kAsManyAsFollowFromOne,  // repeated, and words that follow are values as well
  kOneEachTime,            // repeated; a word that follows is a positional argument
};

/// The heading of what every command has.
inline constexpr const char* kGeneralHeading = "General";

/// Where values come from that are no closed set: what a shell offers for them.
enum class ValueSource { kWords, kFiles, kFolders, kPrograms };

/// One option, flag or positional argument, as data. Declared by chaining:
///     table.option("--horizon", horizon, "Last timepoint").check(IntRange{0, 100});
struct Option {
  std::string names;  // "-j,--jobs"; without dashes: positional
  OptionTarget target;
  std::string help;  // one line of --help, at most 90 characters
  bool is_flag = false;
  bool is_required = false;
  bool shows_default = false;
  ListForm form = ListForm::kAsManyAsFollow;
  ValueCheck value_check = {};
  std::string value_name = {};             // in the help, instead of the type
  std::vector<std::string> partners = {};  // options of the table without which this one is refused
  bool* was_given = nullptr;               // set after parsing
  std::string heading = {};                // in the help, above it and its like
  ValueSource source = ValueSource::kWords;
  std::vector<std::string> endings = {};  // of the files; empty: any
  std::vector<std::string> offered = {};  // words that a shell offers, beside others
  std::string more = {};                  // sentences for the manual page, below the help

  Option& details(std::string sentences) { return more = std::move(sentences), *this; }
  Option& required() { return is_required = true, *this; }
  /// The help shows what the target holds now.
  Option& show_default() { return shows_default = true, *this; }
  Option& list(ListForm how) { return form = how, *this; }
  Option& check(ValueCheck what) { return value_check = std::move(what), *this; }
  Option& named_value(std::string name) { return value_name = std::move(name), *this; }
  Option& needs(std::string other) { return partners.push_back(std::move(other)), *this; }
  Option& given(bool& flag) { return was_given = &flag, *this; }
  /// The value is a file, whose name ends in one of these words behind a dot if there are some.
  Option& file(std::vector<std::string> ends = {}) {
    return source = ValueSource::kFiles, endings = std::move(ends), *this;
  }
  Option& folder() { return source = ValueSource::kFolders, *this; }
  /// The value is a program, and what follows are its arguments.
  Option& program() { return source = ValueSource::kPrograms, *this; }
  Option& offers(std::vector<std::string> words) { return offered = std::move(words), *this; }
  bool is_positional() const { return !names.starts_with('-'); }
};

/// The options of a program or of one of its commands. Targets outlive the parsing.
class OptionTable {
 public:
  OptionTable(std::string name, std::string description)
      : name_(std::move(name)), description_(std::move(description)) {}

  const std::string& name() const { return name_; }
  const std::string& description() const { return description_; }
  const std::string& footer() const { return footer_; }
  bool is_hidden() const { return hidden_; }
  const std::deque<Option>& options() const { return options_; }

  /// Printed below the help.
  void footer(std::string text) { footer_ = std::move(text); }
  /// Leaves the command out of the help.
  void hide() { hidden_ = true; }
  /// The task that the command is for: the help of the program lists it under that.
  const std::string& subject() const { return subject_; }
  void set_subject(std::string text) { subject_ = std::move(text); }
  /// Options that are added from here on stand below this heading. Returns the one before.
  std::string heading(std::string text) { return std::exchange(heading_, std::move(text)); }
  /// The reference stays valid while the table lives.
  template <typename T>
  Option& option(std::string names, T& target, std::string help = "") {
    auto& made = options_.emplace_back(Option{std::move(names), &target, std::move(help)});
    made.heading = heading_;
    return made;
  }
  template <typename T>
  Option& flag(std::string names, T& target, std::string help = "") {
    auto& made = option(std::move(names), target, std::move(help));
    made.is_flag = true;
    return made;
  }

 private:
  std::string name_, description_, footer_, subject_, heading_ = "Options";
  bool hidden_ = false;
  std::deque<Option> options_;
};

/// Options that are added while it lives stand below a heading of their own.
class UnderHeading {
 public:
  UnderHeading(OptionTable& table, std::string text)
      : table_(table), before_(table.heading(std::move(text))) {}
  ~UnderHeading() { table_.heading(std::move(before_)); }
  UnderHeading(const UnderHeading&) = delete;
  UnderHeading& operator=(const UnderHeading&) = delete;

 private:
  OptionTable& table_;
  std::string before_;
};

}  // namespace parallax::tools
