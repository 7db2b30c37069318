#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "compiler/lisp/lisp_data.h"

namespace parallax::compiler {

enum class LoopKind : std::uint8_t {
  kIn,
  kOn,
  kRange,
  kEquals,  // for v = a [then b]
  kRepeat,
  kWith,
  kWhile,
  kUntil,
  kDo,
  kCollect,
  kAppend,
  kSum,
  kCount,
  kMaximize,
  kMinimize,
  kWhen,  // when, if, unless
  kReturn,
  kAlways,
  kNever,
  kThereis,
  kInitially,
  kFinally,
};

/// One clause of the extended `loop`.
struct LoopClause {
  LoopKind kind = LoopKind::kDo;
  std::optional<DatumId> variable;  // a name or a pattern
  std::optional<DatumId> form;      // the list, the start, the count, the test or the value
  std::optional<DatumId> limit;     // kRange; none: for ever
  std::optional<DatumId> step;      // kRange; kIn, kOn: the function to the rest
  std::optional<DatumId> then;      // kEquals
  std::optional<DatumId> second;    // kIn over a table: the variable behind `using`
  std::string_view list = {};       // kIn: the function that makes a list of the form's value
  bool values = false;              // kIn over a table: the first variable is the value
  std::string into;                 // variable to collect into
  std::optional<DatumId> result;    // the same, as written
  bool down = false;                // kRange: counts down
  bool exclusive = false;           // kRange: `below`, `above`
  bool negated = false;             // kWhen: unless
  bool joined = false;              // kWith: by `and` to the one before
  std::vector<DatumId> body;        // kDo, kInitially, kFinally
  std::vector<LoopClause> inner;    // kWhen
  std::vector<LoopClause> otherwise;

  bool bounded() const {
    return kind == LoopKind::kIn || kind == LoopKind::kOn || kind == LoopKind::kRepeat ||
           (kind == LoopKind::kRange && limit.has_value());
  }
  bool iterates() const {
    return bounded() || kind == LoopKind::kRange || kind == LoopKind::kEquals;
  }
};

struct LoopClauses {
  std::string name = "nil";  // named
  std::vector<LoopClause> clauses;
};

struct LoopError {
  std::string text;
  std::optional<DatumId> at;
};

/// Parses the clauses after the word `loop`; bare forms repeat for ever.
std::variant<LoopClauses, LoopError> parse_loop(const LispData& data,
                                                std::span<const DatumId> items);

}  // namespace parallax::compiler
