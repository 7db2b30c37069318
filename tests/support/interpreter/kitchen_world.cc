#include "tests/support/interpreter/kitchen_world.h"

#include <algorithm>
#include <stdexcept>

namespace parallax::test {
namespace {

constexpr std::array<const char*, 4> kItems = {"milk1", "cereal1", "bowl1", "spoon1"};
constexpr std::array<const char*, 4> kTypes = {"milk", "breakfastCereal", "bowl", "spoon"};
constexpr std::array<const char*, 3> kDrawers = {"dTop", "dMid", "dLow"};

template <std::size_t N>
std::size_t number(const std::array<const char*, N>& names, const std::string& name) {
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i] == name) return i;
  }
  throw std::runtime_error("the kitchen has no " + name);
}

/// `d-top` is dTop, `breakfast-cereal` breakfastCereal.
std::string model_name(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool rises = text[i] == '-' && i + 1 < text.size();
    out += rises ? static_cast<char>(text[++i] - 'a' + 'A') : text[i];
  }
  return out;
}

bool within(double value, double low, double high) { return value >= low && value <= high; }

/// The place that a location points to: `(a location (pose ?p))`, `(in (an object (name d)))`, a
/// pose itself.
std::string place_name(const PlanItem& target, bool base) {
  const PlanItem* at = &target;
  while (at->kind == PlanItem::Kind::kDesignator) {
    if (const auto* name = at->key("name")) return model_name(name->text);
    at = &at->keys.front().second;
  }
  const double x = at->items.at(0).number;
  const double y = at->items.at(1).number;
  if (base) {
    if (within(x, 0.64, 0.80) && within(y, -0.02, 0.14)) return "bWork";
    if (within(x, -0.25, 0.05) && within(y, 0.43, 0.73)) return "bTable";
  } else {
    for (int i = 0; i < 4; ++i) {
      if (i < 3 && x > 1.0 && within(y, 0.15 * i, 0.15 * i + 0.149))
        return "pw" + std::to_string(i + 1);
      if (x < 0.0 && within(y, 0.40 + 0.15 * i, 0.549 + 0.15 * i))
        return "pt" + std::to_string(i + 1);
    }
  }
  throw std::runtime_error("a pose outside all regions");
}

std::string place_of(const PlanItem& designator, bool base) {
  for (const auto* key : {"target", "pose", "location", "goal"}) {
    if (const auto* value = designator.key(key)) return place_name(*value, base);
  }
  throw std::runtime_error("no target");
}

std::size_t arm_of(const PlanItem& designator) {
  return designator.key("arm")->text == "left" ? 0 : 1;
}
const char* arm_name(std::size_t arm) { return arm == 0 ? "left" : "right"; }

}  // namespace

KitchenWorld::KitchenWorld(Goal goal, bool untidy) : goal_(goal) {
  std::array<std::string, 3> cells = {"pw1", "pw2", "pw3"};
  do {
    for (const auto* drawer : kDrawers) {
      for (unsigned open = 0; open < (untidy ? 8U : 1U); ++open) {
        State state;
        for (std::size_t i = 0; i < 3; ++i) {
          state.place[i] = cells[i];
          state.open[i] = ((open >> i) & 1U) != 0;
        }
        state.place[3] = drawer;
        starts_.push_back(state);
      }
    }
  } while (std::next_permutation(cells.begin(), cells.end()));
}

void KitchenWorld::reset(std::size_t initial_state) {
  now_ = starts_[initial_state];
  hit_ = false;
}

bool KitchenWorld::serves(const std::string& place) const {
  if (now_.base == "bWork") return place.starts_with("pw") || place.starts_with("d");
  return now_.base == "bTable" && place.starts_with("pt");
}

bool KitchenWorld::accessible(const std::string& place) const {
  if (!place.starts_with("d")) return true;
  const auto drawer = number(kDrawers, place);
  for (std::size_t above = 0; above < drawer; ++above) {
    if (now_.open[above]) return false;
  }
  return now_.open[drawer];
}

bool KitchenWorld::reachable(std::size_t item) const {
  const auto& place = now_.place[item];
  return !place.empty() && serves(place) && accessible(place);
}

bool KitchenWorld::visible(std::size_t item) const {
  return reachable(item) && now_.gaze == now_.place[item];
}

World::Outcome KitchenWorld::go(const PlanItem& designator) {
  const auto base = place_of(designator, true);
  if (now_.parked[0] && now_.parked[1]) {
    if (now_.base != base) now_.gaze.clear();
    now_.base = base;
  }
  return {"Go(" + base + ")", now_.base == base, "navigation-pose-unreachable", {}};
}

World::Outcome KitchenWorld::look(const PlanItem& designator) {
  const auto place = place_of(designator, false);
  if (serves(place)) now_.gaze = place;
  return {"LookAt(" + place + ")", now_.gaze == place, "ptu-goal-unreachable", {}};
}

World::Outcome KitchenWorld::detect(const PlanItem& designator) {
  const auto type = model_name(designator.key("object")->key("type")->text);
  Outcome out{"Detect(" + type + ")", false, "perception-object-not-found", {}};
  const auto item = number(kTypes, type);
  now_.perceived[item] = visible(item);
  out.success = now_.perceived[item];
  if (out.success) out.returns.emplace_back(kItems[item]);
  return out;
}

World::Outcome KitchenWorld::pick_up(const PlanItem& designator) {
  const auto arm = arm_of(designator);
  const auto item = number(kItems, designator.key("object")->text);
  if (now_.perceived[item] && reachable(item) && now_.held[arm] == kNobody) {
    now_.held[arm] = static_cast<int>(item);
    now_.place[item].clear();
    if (goal_ == Goal::kGrasped) hit_ = true;
  }
  now_.parked[arm] = false;
  return {std::string("PickUp(") + arm_name(arm) + "," + kItems[item] + ")",
          now_.held[arm] == static_cast<int>(item),
          "manipulation-pose-unreachable",
          {}};
}

World::Outcome KitchenWorld::place(const PlanItem& designator) {
  const auto arm = arm_of(designator);
  const auto item = number(kItems, designator.key("object")->text);
  const auto place = place_of(designator, false);
  const bool occupied = std::find(now_.place.begin(), now_.place.end(), place) != now_.place.end();
  if (now_.held[arm] == static_cast<int>(item) && serves(place) && accessible(place) && !occupied) {
    now_.place[item] = place;
    now_.held[arm] = kNobody;
  }
  now_.parked[arm] = false;
  return {std::string("PlaceAt(") + arm_name(arm) + "," + kItems[item] + "," + place + ")",
          now_.place[item] == place,
          "manipulation-goal-not-reached",
          {}};
}

World::Outcome KitchenWorld::drawer(const PlanItem& designator, bool opens) {
  const auto arm = arm_of(designator);
  const auto name = model_name(designator.key("object")->key("name")->text);
  const auto which = number(kDrawers, name);
  bool possible = serves(name) && now_.held[arm] == kNobody;
  for (std::size_t above = 0; above < which; ++above) {
    if (opens && now_.open[above]) possible = false;
  }
  if (possible) {
    now_.open[which] = opens;
    now_.parked[arm] = false;
  }
  return {std::string(opens ? "OpenDrawer(" : "CloseDrawer(") + arm_name(arm) + "," + name + ")",
          now_.open[which] == opens,
          "manipulation-goal-not-reached",
          {}};
}

World::Outcome KitchenWorld::park(const PlanItem& designator) {
  const auto arm = arm_of(designator);
  now_.parked[arm] = true;
  return {std::string("ParkArm(") + arm_name(arm) + ")", true, "manipulation-goal-not-reached", {}};
}

World::Outcome KitchenWorld::perform(const PlanItem& designator) {
  const auto type = designator.key("type")->text;
  hit_ = false;
  if (type == "going" || type == "navigating") {
    const auto out = go(designator);
    hit_ = goal_ == Goal::kArrived && out.success;
    return out;
  }
  if (type == "looking" || type == "turning-towards") return look(designator);
  if (type == "detecting") return detect(designator);
  if (type == "picking-up") return pick_up(designator);
  if (type == "placing") return place(designator);
  if (type == "opening" || type == "accessing") return drawer(designator, true);
  if (type == "closing" || type == "sealing") return drawer(designator, false);
  if (type == "parking-arms") return park(designator);
  throw std::runtime_error("the kitchen cannot do " + type);
}

bool KitchenWorld::holds(const std::vector<PlanItem>& fluent) const {
  const auto& name = fluent.at(0).text;
  if (name == "drawer-open") return now_.open[number(kDrawers, model_name(fluent.at(1).text))];
  if (name == "parked") return now_.parked[fluent.at(1).text == "left" ? 0 : 1];
  if (name == "hand-free") return now_.held[fluent.at(1).text == "left" ? 0 : 1] == kNobody;
  if (name == "perceived") return now_.perceived[number(kItems, fluent.at(1).text)];
  throw std::runtime_error("the kitchen knows no fluent " + name);
}

}  // namespace parallax::test
