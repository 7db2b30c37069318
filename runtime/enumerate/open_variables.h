#pragma once

// Which variables do others leave open? What is told is set and propagated. The clauses that are
// left fall into components without a variable in common, most of them small and the same from one
// trace to the next: each is asked about once. Cost: linear in the clauses for each trace, and a
// few calls of a solver for each component that was not met before.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/enumerate/clause_propagation.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

class OpenVariables {
 public:
  using MakeSolver = std::function<std::unique_ptr<SatSolver>()>;
  /// Bounds on what is kept of components, in codes of four bytes. Beyond `all` everything is
  /// forgotten; a component of more than `one` is asked about again each time.
  struct Bounds {
    std::size_t all;
    std::size_t one;
  };
  static constexpr Bounds kBounds = {10'000'000, 100'000};

  /// `asked`: the variables that are asked about, none of them told. `model` outlives the object.
  OpenVariables(const compiler::CompiledModel& model, std::span<const Literal> asked,
                MakeSolver make_solver, Bounds bounds = kBounds);

  /// The variables that can be true and can be false in valuations of the model with these
  /// literals, of which there are some. None if a solver was stopped.
  std::optional<std::vector<std::int32_t>> find(std::span<const Literal> told);

 private:
  using Codes = std::vector<ClausePropagation::Code>;
  /// Clauses one behind the other, each followed by kEnd.
  using Component = Codes;

  void keep(Component component, const std::vector<std::int32_t>& open);
  void set(std::span<const Literal> told);
  std::vector<Component> components();
  std::uint32_t root_of(std::uint32_t variable);
  std::optional<std::vector<std::int32_t>> open_in(const Component& component) const;

  ClausePropagation state_;
  Codes units_;
  std::vector<ClausePropagation::Clause> clauses_;  // of two literals and more
  std::vector<bool> is_asked_;                      // by variable - 1
  std::vector<std::int32_t> asked_;
  MakeSolver make_solver_;
  std::vector<std::uint32_t> parents_;  // of the union of components, by variable - 1
  Bounds bounds_;
  std::map<Component, std::vector<std::int32_t>> known_;
  std::size_t kept_codes_ = 0;  // of all components in known_
};

}  // namespace parallax::runtime
