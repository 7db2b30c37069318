#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "compiler/plan/lisp_data.h"

namespace parallax::compiler {

enum class LoopKind : std::uint8_t { kIn, kRange, kRepeat, kWhile, kUntil, kDo, kCollect };

/// One clause of the extended `loop`.
struct LoopClause {
  LoopKind kind = LoopKind::kDo;
  std::string variable;          // kIn, kRange
  std::optional<DatumId> form;   // the list, the start, the count, the test or the value
  std::optional<DatumId> limit;  // kRange; none: for ever
  std::optional<DatumId> step;   // kRange
  bool down = false;             // kRange: counts down
  bool exclusive = false;        // kRange: `below`, `above`
  std::vector<DatumId> body;     // kDo
  bool bounded() const {
    return kind == LoopKind::kIn || kind == LoopKind::kRepeat ||
           (kind == LoopKind::kRange && limit.has_value());
  }
};

struct LoopError {
  std::string text;
  std::optional<DatumId> at;
};

/// Parses what follows the word `loop`: for v in L, for i from a to|upto|below|downto|above b
/// [by s], repeat n, while c, until c, do forms, collect v; or bare forms, which repeat for ever.
std::variant<std::vector<LoopClause>, LoopError> parse_loop(const LispData& data,
                                                            std::span<const DatumId> items);

}  // namespace parallax::compiler
