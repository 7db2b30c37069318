#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/interpreter/world.h"

namespace parallax::test {

/// The kitchen of scenarios/kitchen/domain.e, written down a second time as a program. Items are
/// milk1, cereal1, bowl1 and spoon1; a place is its name.
class KitchenWorld final : public World {
 public:
  /// The end of a trace: a drive that arrives, or a grasp that holds.
  enum class Goal { kArrived, kGrasped };
  /// `untidy`: drawers may be open at the start.
  KitchenWorld(Goal goal, bool untidy);

  std::size_t initial_states() const override { return starts_.size(); }
  void reset(std::size_t initial_state) override;
  Outcome perform(const PlanItem& designator) override;
  bool holds(const std::vector<PlanItem>& fluent) const override;
  bool hit() const override { return hit_; }

 private:
  static constexpr int kNobody = -1;
  struct State {
    std::string base = "bWork";
    std::string gaze;
    std::array<bool, 2> parked = {true, true};
    std::array<int, 2> held = {kNobody, kNobody};      // by arm: the item
    std::array<std::string, 4> place;                  // by item; empty in a hand
    std::array<bool, 3> open = {false, false, false};  // top, middle, low
    std::array<bool, 4> perceived = {false, false, false, false};
  };

  bool serves(const std::string& place) const;
  bool accessible(const std::string& place) const;
  bool visible(std::size_t item) const;
  bool reachable(std::size_t item) const;
  Outcome go(const PlanItem& designator);
  Outcome look(const PlanItem& designator);
  Outcome detect(const PlanItem& designator);
  Outcome pick_up(const PlanItem& designator);
  Outcome place(const PlanItem& designator);
  Outcome drawer(const PlanItem& designator, bool opens);
  Outcome park(const PlanItem& designator);

  Goal goal_;
  std::vector<State> starts_;
  State now_;
  bool hit_ = false;
};

}  // namespace parallax::test
