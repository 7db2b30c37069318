#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace parallax::tools {

/// A name with arguments, such as `Drive(spot1,spot2)`.
struct TermText {
  std::string name;
  std::vector<std::string> arguments;

  std::string to_text() const;
};

/// A term within a text, and where it stands there.
struct TermPlace {
  TermText term;
  std::size_t begin = 0, length = 0;
};

/// Terms of these names in a text, also those inside one another, from left to right.
std::vector<TermPlace> terms_in(const std::string& text, const std::set<std::string>& names);

/// `text` as a whole is one term; nullopt if it is not.
std::optional<TermText> read_term(const std::string& text);

/// The parts of a text between separators outside of all brackets.
std::vector<std::string> split_outside(const std::string& text, const std::string& separator);

std::string joined(const std::vector<std::string>& parts, const std::string& separator);

/// A formula of a rules file, taken apart as text without regard to what it means. It stands on one
/// line, with one blank around every connective.
struct AxiomText {
  enum class Kind {
    kEffect,
    kRamification,  // an effect with an effect in its condition
    kTrigger,
    kPrecondition,
    kDefinition,
    kConstraint,
    kFact,   // a value of a function
    kOther,  // `load`, comments
  };

  Kind kind = Kind::kOther;
  std::vector<std::string> variables;   // of the outer quantifier
  std::vector<std::string> condition;   // conjuncts in front of the arrow
  std::string arrow;                    // " -> ", " <-> " or nothing
  std::string inner;                    // quantifier behind the arrow, with its blank
  std::vector<std::string> conclusion;  // conjuncts behind it, or all there are

  std::string to_text() const;
};

AxiomText read_axiom(const std::string& line);

/// The declarations of a model that stand alone on their lines.
struct DeclarationText {
  std::map<std::string, std::vector<std::string>> fluents, events;  // sorts of their arguments
  std::set<std::string> derived;                                    // noninertial fluents
  std::map<std::string, std::vector<std::string>> constants;        // of each sort, numbers too
};

DeclarationText read_declarations(const std::vector<std::string>& lines);

/// A variable's sort: its name without trailing digits.
std::string sort_of_variable(const std::string& variable);

}  // namespace parallax::tools
