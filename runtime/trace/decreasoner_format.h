#pragma once

#include <string>
#include <vector>

#include "runtime/trace/trace_format.h"

namespace parallax::runtime {

using Lines = std::vector<std::string>;

/// Options of a model for its printed form, and facts that the compiled model does not tell.
struct DecreasonerOptions {
  bool time_diff = true;        // changes instead of full states
  bool model_diff = false;      // from model 2 on, the difference from the one before
  bool show_predicates = true;  // the block `P`
  /// `completion Happens`: the events of the last timepoint are printed as false.
  bool events_completed = false;
};

/// The printed form of the Discrete Event Calculus Reasoner 1.0, from `model K:` on. False atoms
/// are listed only where that program has a proposition for them, that is where some formula
/// mentions them; a model that was compiled with its meaning knows which these are. The number of
/// models, which that program prints first, comes last, because models are printed as they are
/// found.
class DecreasonerFormat final : public ListFormat {
 public:
  /// `model` outlives the format.
  DecreasonerFormat(const CompiledModel& model, const DecreasonerOptions& options);
  std::string trace(const Trace& trace, const OpenAtoms& open) override;
  std::string end(const ListEnd& end) override;
  /// The lines below `model K:`. Open atoms have none.
  Lines lines(const Trace& trace, const OpenAtoms& open) const;

 private:
  struct Proposition {
    compiler::AtomKind kind;
    std::string name;
    std::uint32_t number = 0;  // of the fluent or event
    std::optional<Timepoint> time;
    std::string line;  // "Happens(Go(a, b), 3)"
  };

  void collect(const CompiledModel& model);
  void append_changes(const Trace& trace, std::size_t t, Lines& out) const;
  void append_state(const Trace& trace, const OpenAtoms& open, std::size_t t, Lines& out) const;
  void append_rest(const Trace& trace, const OpenAtoms& open, Lines& out) const;
  static bool is_open(const OpenAtoms& open, const Proposition& proposition);
  static bool is_true(const Trace& trace, const Proposition& proposition);
  bool is_shown_with_time(const Proposition& proposition, Timepoint length) const;

  DecreasonerOptions options_;
  std::vector<Proposition> propositions_;  // sorted by line
  /// By timepoint: fluents with a proposition, ascending.
  std::vector<std::vector<compiler::FluentId>> holds_;
  std::int64_t printed_ = 0;
  Lines last_;  // for model_diff
};

}  // namespace parallax::runtime
