#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/support/interpreter/world.h"

namespace parallax::test {

/// The shelf of tests/plans/shelf.e, written down a second time as a program. A trace ends when
/// both fresh products are on boards.
class ShelfWorld final : public World {
 public:
  ShelfWorld();
  std::size_t initial_states() const override { return starts_.size(); }
  void reset(std::size_t initial_state) override;
  Outcome perform(const PlanItem& designator) override;
  bool holds(const std::vector<PlanItem>& fluent) const override;
  bool hit() const override;

 private:
  using Places = std::array<std::string, 3>;  // of fresh1, fresh2, stale1; an arm, if it is held
  bool within_reach(const std::string& spot) const;
  bool somewhere(const std::string& place) const;

  std::vector<Places> starts_;
  Places place_;
  bool facing_shelf_ = false;
};

}  // namespace parallax::test
