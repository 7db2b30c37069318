#include <algorithm>
#include <array>

#include "harness/robot/line_controller.h"
#include "harness/robot/mobile_controller.h"

namespace parallax::harness {
namespace {

struct NamedFactory {
  std::string_view name;  // in controllers()
  ControllerFactory make;
};

constexpr std::array<NamedFactory, 14> kFactories = {{
    {"close-drawer", &make_close_drawer},
    {"detect", &make_detect},
    {"drive", &make_drive},
    {"going", &make_going},
    {"look", &make_look},
    {"move-torso", &make_move_torso},
    {"open-drawer", &make_open_drawer},
    {"open-gripper", &make_open_gripper},
    {"park", &make_park},
    {"pick-up", &make_pick_up},
    {"picking-up", &make_picking_up},
    {"place", &make_place},
    {"placing", &make_placing},
    {"regrip", &make_regrip},
}};

}  // namespace

ControllerFactory find_factory(std::string_view name) {
  const auto found = std::find_if(kFactories.begin(), kFactories.end(),
                                  [&](const NamedFactory& one) { return one.name == name; });
  return found == kFactories.end() ? nullptr : found->make;
}

}  // namespace parallax::harness
