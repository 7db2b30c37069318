#include "tests/support/interpreter/shelf_world.h"

#include <algorithm>
#include <stdexcept>

namespace parallax::test {
namespace {

constexpr std::array<const char*, 3> kProducts = {"fresh1", "fresh2", "stale1"};

std::size_t number(const std::string& product) {
  for (std::size_t i = 0; i < kProducts.size(); ++i) {
    if (kProducts[i] == product) return i;
  }
  throw std::runtime_error("no product " + product);
}

bool is_board(const std::string& spot) {
  return spot == "upper" || spot == "middle" || spot == "lower";
}

}  // namespace

ShelfWorld::ShelfWorld() {
  for (const auto* fresh : {"crate", "upper", "middle", "lower"}) {
    for (const auto* stale : {"crate", "upper", "middle", "lower"}) {
      if (is_board(fresh) && std::string(fresh) == stale) continue;
      starts_.push_back({fresh, "crate", stale});
    }
  }
}

void ShelfWorld::reset(std::size_t initial_state) {
  place_ = starts_[initial_state];
  facing_shelf_ = false;
}

bool ShelfWorld::within_reach(const std::string& spot) const {
  return is_board(spot) ? facing_shelf_ : spot == "crate" && !facing_shelf_;
}

bool ShelfWorld::somewhere(const std::string& place) const {
  return std::find(place_.begin(), place_.end(), place) != place_.end();
}

World::Outcome ShelfWorld::perform(const PlanItem& designator) {
  const auto type = designator.key("type")->text;
  if (type == "turning-to-shelf" || type == "turning-to-crate") {
    facing_shelf_ = type == "turning-to-shelf";
    return {facing_shelf_ ? "FaceShelf()" : "FaceCrate()", true, "navigation-goal-not-reached", {}};
  }
  if (type == "detecting") {
    const auto board = designator.key("location")->text;
    Outcome out{"Inspect(" + board + ")", false, "perception-object-not-found", {}};
    for (std::size_t i = 0; i < kProducts.size(); ++i) {
      if (place_[i] == board && within_reach(board)) out.returns.emplace_back(kProducts[i]);
    }
    out.success = !out.returns.empty();
    return out;
  }
  const auto arm = designator.key("arm")->text;
  const auto product = designator.key("object")->text;
  auto& place = place_[number(product)];
  if (type == "picking-up") {
    if (within_reach(place) && !somewhere(arm)) place = arm;
    return {
        "Grasp(" + arm + "," + product + ")", place == arm, "manipulation-pose-unreachable", {}};
  }
  if (type != "placing") throw std::runtime_error("nobody can do " + type);
  const auto spot = designator.key("target")->text;
  const bool taken = is_board(spot) && somewhere(spot);
  if (place == arm && within_reach(spot) && !taken) place = spot;
  return {"Put(" + arm + "," + product + "," + spot + ")",
          place == spot,
          "manipulation-goal-not-reached",
          {}};
}

bool ShelfWorld::holds(const std::vector<PlanItem>&) const {
  throw std::runtime_error("the plan asks for no fluents");
}

bool ShelfWorld::hit() const { return is_board(place_[0]) && is_board(place_[1]); }

}  // namespace parallax::test
