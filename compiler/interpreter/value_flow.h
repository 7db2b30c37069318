#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "compiler/interpreter/plan_compiler.h"

namespace parallax::compiler {

/// A value that lies at place `slot` of its frame when instruction `pc` of the unit is about to
/// run.
struct ValuePlace {
  std::uint32_t unit = 0;
  std::uint32_t pc = 0;
  std::uint32_t slot = 0;
};

/// Follows a value through the code of a plan, without running it. The value is followed from its
/// place through every instruction that moves it: copies of variables, parts of lists, multiple
/// values, jumps and exits, results of calls to all their callers. Each pair of an instruction and
/// a place on the stack is visited once.
class ValueFlow {
 public:
  /// Steps that one ValueFlow takes, over all questions; beyond them every value counts as used.
  static constexpr std::size_t kMaxSteps = 1'000'000;

  explicit ValueFlow(const PlanCode& code);

  /// The height of the stack, counted from the frame's base, before the instruction.
  std::uint32_t height(std::uint32_t unit, std::uint32_t pc) const { return heights_[unit][pc]; }
  /// The result of the unit may be used where the code does not show it.
  void note_unknown_caller(std::uint32_t unit) { unknown_callers_[unit] = true; }
  /// The unit carries out performs: its result is theirs.
  void note_performed(std::uint32_t unit) { performed_[unit] = true; }

  /// May anything look at the value? False only if every way ends where the value is dropped.
  /// Appends to `returned` the units that return it on the way.
  bool may_be_used(const ValuePlace& from, std::vector<std::uint32_t>& returned);

 private:
  struct CallSite {
    std::uint32_t unit = 0;
    std::uint32_t pc = 0;
  };
  using Key = std::array<std::uint32_t, 3>;

  void find_heights(std::uint32_t unit);
  void note_links(std::uint32_t unit);
  void note_captured(std::uint32_t unit, std::uint32_t level, std::uint32_t index);
  void find_reached();
  const PlanInstruction& at(const ValuePlace& place) const;
  void open(std::uint32_t unit, std::uint32_t pc, std::uint32_t slot);
  void open_exit(std::uint32_t exit, std::uint32_t slot);
  void open_result(const CallSite& site);
  void stay(const ValuePlace& place) { open(place.unit, place.pc + 1, place.slot); }
  bool taken(const ValuePlace& place, std::uint32_t values, bool kept);
  bool step(const ValuePlace& place, std::vector<std::uint32_t>& returned);
  bool jump(const ValuePlace& place);
  bool exit(const ValuePlace& place);
  bool store(const ValuePlace& place);
  bool returns(const ValuePlace& place, std::vector<std::uint32_t>& returned);
  bool end_branch(const ValuePlace& place);
  bool shared(const ValuePlace& place);

  const PlanCode& code_;
  std::vector<std::vector<std::uint32_t>> heights_;      // by unit and instruction
  std::vector<std::vector<bool>> labels_;                // where jumps and exits come in
  std::vector<std::set<std::uint32_t>> captured_;        // places that units within the unit read
  std::vector<std::vector<std::uint32_t>> from_inside_;  // exits that units within the unit take
  std::vector<std::vector<CallSite>> callers_;
  std::vector<CallSite> branch_starts_;  // by unit: the kPar that starts it
  std::vector<CallSite> performs_;
  std::vector<bool> unknown_callers_;
  std::vector<bool> performed_;
  std::vector<bool> reached_;  // units that may run, once a question needs them
  std::vector<bool> keeping_;  // built-ins whose result holds their arguments and nothing else

  std::set<Key> visited_;
  std::vector<ValuePlace> open_;
  std::size_t steps_ = 0;
};

}  // namespace parallax::compiler
