#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/trace/trace.h"
#include "runtime/trace/trace_format.h"

namespace parallax::runtime {

/// `Move(Cat,Floor,On(a,b))`, taken apart: symbol and printed arguments.
struct AtomText {
  std::string symbol;
  std::vector<std::string> arguments;  // nested terms stay in one piece
  friend bool operator==(const AtomText&, const AtomText&) = default;
};

/// None for a text that is no printed atom: no parentheses, unbalanced ones, an empty argument.
std::optional<AtomText> split_atom(std::string_view atom);
std::string join_atom(const AtomText& parts);

/// Metadata of ITF files.
struct ItfOptions {
  std::string tool;    // "parallax 0.3.0"
  std::string source;  // the model as the user named it
  /// Declarations of event symbols, for states whose event is no step of a plan.
  std::map<std::string, compiler::TextPlace, std::less<>> declared;
};

/// Names that the format gives to variables other than fluents.
inline constexpr std::string_view kItfAction = "mbt::actionTaken";
inline constexpr std::string_view kItfPicks = "mbt::nondetPicks";
inline constexpr std::string_view kItfReleased = "ReleasedAt::";
inline constexpr std::string_view kItfPredicate = "predicate::";
inline constexpr std::string_view kItfInit = "init";  // the action before the first state

/// Informal Trace Format (Apalache ADR-015): a state for each timepoint. One variable for each
/// fluent symbol, a map from tuples of arguments to booleans; the same for releases and user
/// predicates, under a prefix; maps do not list open atoms. `mbt::actionTaken` of a state are the
/// events that led to it, joined by `+`; `mbt::nondetPicks` are their arguments by event symbol. A
/// list of traces is one object a line and a closing line.
class ItfFormat final : public ListFormat {
 public:
  /// `model` outlives the format.
  ItfFormat(const CompiledModel& model, ItfOptions options);
  std::string trace(const Trace& trace, const OpenAtoms& open) override;
  std::string end(const ListEnd& end) override;
  /// One trace as a file of its own: a state on each line. Its `#meta` has `end`, if that is known.
  std::string document(const Trace& trace, const OpenAtoms& open,
                       const std::optional<ListEnd>& end) const;

 private:
  std::string meta(const Trace& trace, const std::optional<ListEnd>& end) const;
  std::string vars() const;
  std::string state(const Trace& trace, const OpenAtoms& open, std::size_t t) const;

  const CompiledModel* model_;
  ItfOptions options_;
  Vocabulary vocabulary_;
  std::string hash_;
};

}  // namespace parallax::runtime
