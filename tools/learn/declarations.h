#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/repair/verification.h"

namespace parallax::tools {

/// A formula about the fluents of one state.
struct StateFormula {
  /// `F(x1,..,xn) <-> right` of a noninertial fluent, for different variables x1 to xn.
  struct Definition {
    std::string fluent;                  // "Visible"
    std::vector<std::string> arguments;  // its variables
    std::string left, right;
  };
  std::string text;                    // as it was written, without comments
  std::string place;                   // "common.e:47"
  std::vector<std::string> variables;  // universally quantified in front
  std::string time;                    // which of them is the timepoint; empty: none is
  std::string body;
  std::optional<Definition> definition;

  /// "[item,time] "; empty without variables.
  std::string quantifier() const;
};

/// The part of a model that does not tell what events do and when they happen.
struct Declarations {
  /// A declaration, a formula about predicates, or one about states.
  struct Piece {
    std::string text;
    std::optional<std::size_t> formula;  // place in `formulas`
  };
  std::vector<Piece> states;
  std::vector<StateFormula> formulas;
  std::string start;        // formulas that name a timepoint
  std::size_t dropped = 0;  // statements about events that were left out
};

/// The statements of the model's files in their order, without their comments. Left out is every
/// formula that mentions an event at a time (`Happens`, `Initiates`, `Terminates`, `Releases`,
/// trajectories), and every statement about them (`completion`, `mutex`, `xor`).
Declarations declarations_of(const DomainModel& model);

}  // namespace parallax::tools
