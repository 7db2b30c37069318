#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/random_model.h"

namespace parallax::test {

/// A literal of a property: about the state before a step, its events, or the state after it.
struct StepLiteral {
  enum class Place : std::uint8_t { kBefore, kEvent, kAfter };
  Place place = Place::kBefore;
  std::size_t number = 0;
  bool positive = true;
};

/// A small random model that says the same of every step, facts about the first timepoints, and a
/// property that is broken where all literals of a list are true.
class StepWorld {
 public:
  explicit StepWorld(std::uint64_t seed);

  /// With `range time 0 horizon` and every fact.
  std::string text(int horizon) const;
  std::string property() const;
  /// The first timepoint at which some trace of some horizon breaks the property; none: no trace
  /// does, at any timepoint. Breadth first through explicit states, whose steps are the
  /// assignments that the reference evaluator accepts. A text: the model is not well-formed.
  struct Answer {
    std::optional<int> broken_at;
    std::string error;
  };
  Answer answer() const;

 private:
  struct Fact {
    int time = 0;
    bool event = false;
    std::string atom;  // `HoldsAt(F0(),`, perhaps with `!`
  };
  struct State {
    std::uint32_t holds = 0, released = 0;
    friend auto operator<=>(const State&, const State&) = default;
  };
  struct Step {
    State before, after;
    std::uint32_t events = 0;
  };

  std::string literal(const char* time);
  std::string event_literal(const char* time);
  std::string condition();
  void rule();
  void make_property();
  std::string declarations() const;
  std::string facts(int first, int last, int shift) const;
  bool search(const std::string& given, std::optional<int>& found, std::string& error) const;
  std::vector<State> starts(const std::string& given, std::string& error) const;
  std::vector<Step> steps(const std::string& given, int t, std::string& error) const;
  /// The facts about the state at t.
  bool satisfies(const State& state, int t) const;
  bool breaks(const State& before, std::uint32_t events, const State& after) const;
  bool about_one_state() const;

  FuzzRandom random_;
  std::size_t fluents_ = 2, events_ = 2;
  bool releases_ = false, completed_ = false, predicate_ = false, noninertial_ = false;
  std::vector<std::string> rules_;
  std::vector<Fact> facts_;
  std::vector<StepLiteral> broken_;
  bool always_ = false;
};

}  // namespace parallax::test
