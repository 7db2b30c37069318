#include "tools/scaffold/robot_scaffold.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <system_error>

#include "compiler/base/codes/scenarios.h"
#include "compiler/base/file_io.h"
#include "harness/config/scenario.h"
#include "harness/engine/jaws.h"
#include "harness/engine/physics_world.h"
#include "tools/scaffold/robot_arm.h"
#include "tools/scaffold/templates.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using harness::JointSpec;
using harness::JointType;
using harness::WorldSpec;

constexpr double kBaseForce_n = 5000.0, kBaseTorque_nm = 2000.0;  // that hold the root in place
constexpr double kFingerForce_n = 60.0;                           // where the file says nothing
constexpr double kInTheAir_m = 5.0, kOverFloor_m = 0.002;

/// To a thousandth, without zeros that say nothing.
std::string rounded_text(double value) {
  const double rounded = std::round(1000.0 * value) / 1000.0;
  return fmt::format("{}", rounded == 0.0 ? 0.0 : rounded);
}

/// A folder that is gone with this.
class TrialFolder {
 public:
  TrialFolder() {
    auto pattern = (fs::temp_directory_path() / "parallax-new-XXXXXX").string();
    if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~TrialFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  TrialFolder(const TrialFolder&) = delete;
  TrialFolder& operator=(const TrialFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

class RobotScaffolder {
 public:
  RobotScaffolder(std::string_view name, const RobotRequest& request, base::DiagnosticSink& sink)
      : name_(name), request_(request), sink_(sink) {}

  base::Result<std::vector<ScaffoldFile>> run() {
    const auto read = robot_files(request_, sink_);
    if (!read) return sink_.already_reported();
    robot_ = std::move(*read);
    for (const ScaffoldFile& file : robot_.files) {
      if (!write_scaffold_file(trial_.path(), file, sources_, sink_))
        return sink_.already_reported();
    }
    // In the air, as arms may reach below their root where the file has them.
    auto world = imported(import_text(kInTheAir_m, {}));
    if (!world) return sink_.already_reported();
    const auto arm = find_arm(*world);
    if (!arm) {
      return refuse("it has no arm with a gripper of two fingers that slide against each other");
    }
    arm_ = *arm;
    if (arm_.root.empty()) return refuse("its arm does not hang on a link of the robot");
    lift_m_ = lift_above_floor(*world);
    const auto place = find_work_place(*world, arm_, kInTheAir_m - lift_m_);
    if (!place) return refuse("no posture was found in which its gripper points down at a table");
    place_ = *place;
    set_positions(*world);
    world = imported(import_text(kInTheAir_m, positions_));
    if (!world) return sink_.already_reported();
    measure(*world);
    return files();
  }

 private:
  base::Reported refuse(const std::string& why) {
    return sink_.error_about(codes::kBadImport, request_.file, why);
  }

  /// The keys that take the description over, `lift_m` above the floor.
  std::string import_text(double lift_m, const std::map<std::string, double>& positions) const {
    std::string text = "urdf:\n  file: " + robot_.description + "\n";
    if (lift_m != 0.0) text += "  at_m: [0, 0, " + rounded_text(lift_m) + "]\n";
    if (!positions.empty()) {
      text += "  positions:          # in which the gripper points down, above the table\n";
      for (const auto& [joint, position] : positions) {
        text += fmt::format("    {}: {}\n", joint, rounded_text(position));
      }
    }
    return text + "models: robot\n";
  }

  /// The world that the import makes. Its warnings come again when the scenario is checked.
  std::optional<WorldSpec> imported(const std::string& text) {
    const ScaffoldFile file{"trial.yaml", text};
    if (!write_scaffold_file(trial_.path(), file, sources_, sink_)) return std::nullopt;
    base::SourceFiles sources;
    base::DiagnosticSink sink;
    auto world = harness::load_world(trial_.path() / file.name, sources, sink);
    if (world) return std::move(*world);
    for (const auto& one : sink.sorted()) {
      if (base::info(one.code).severity != base::Severity::kError) continue;
      refuse(one.message);
      return std::nullopt;
    }
    refuse("it cannot be simulated");
    return std::nullopt;
  }

  /// As the file counts them: a joint whose stops exclude 0 began elsewhere.
  void set_positions(const WorldSpec& world) {
    for (const auto& [name, position] : place_.positions) {
      const auto joint = std::find_if(world.joints.begin(), world.joints.end(),
                                      [&](const JointSpec& one) { return one.name == name; });
      const auto& low = joint->type == JointType::kHinge ? joint->low_rad : joint->low_m;
      const auto said = robot_.lows.find(name);
      const double begun = low && said != robot_.lows.end() ? said->second - *low : 0.0;
      const double at = std::round(1000.0 * (position + begun)) / 1000.0;
      if (at != 0.0) positions_[name] = at;
    }
  }

  /// The height of the description's origin at which its root stands on the floor.
  double lift_above_floor(const WorldSpec& world) const {
    const auto engine = make_world(world);
    const auto root = *engine->layout().find_body(arm_.root);
    const double lowest = engine->bounds(root).low.z() - kInTheAir_m;
    return std::ceil(1000.0 * std::max(0.0, kOverFloor_m - lowest)) / 1000.0;
  }

  /// Sizes that follow from the gripper.
  void measure(const WorldSpec& world) {
    auto with_follower = world;
    for (JointSpec& joint : with_follower.joints) {
      if (joint.name == arm_.follower) {
        joint.follows = harness::FollowSpec{arm_.roles.finger_joint, arm_.ratio};
      }
    }
    const harness::Jaws jaws(arm_.roles, *make_world(with_follower));
    opening_m_ = std::floor(1000.0 * 0.95 * jaws.opening_limits_m().second) / 1000.0;
    box_m_ = std::clamp(std::round(600.0 * opening_m_) / 1000.0, 0.005, 0.06);
    const auto said = robot_.efforts.find(arm_.roles.finger_joint);
    const bool is_said = said != robot_.efforts.end() && said->second > 0.0;
    finger_n_ = is_said ? said->second : kFingerForce_n;
    effort_n_ = std::min(20.0, std::floor(0.8 * finger_n_ / jaws.gain()));
    const auto root =
        std::find_if(world.bodies.begin(), world.bodies.end(),
                     [&](const harness::BodySpec& one) { return one.name == arm_.root; });
    root_z_m_ = root->p_WB.z() - kInTheAir_m + lift_m_;
  }

  std::string motors() const {
    std::string text;
    for (const std::string& name : arm_.roles.chain) {
      const auto said = robot_.efforts.find(name);
      const bool is_said = said != robot_.efforts.end() && said->second > 0.0;
      const double strength = is_said ? said->second : place_.strengths.at(name);
      const bool is_endless =
          std::find(arm_.endless.begin(), arm_.endless.end(), name) != arm_.endless.end();
      text += fmt::format(
          "  {}: {{{}: {}{}}}{}\n", name,
          arm_.slides.contains(name) ? "max_force_n" : "max_torque_nm", rounded_text(strength),
          is_endless ? fmt::format(", range_rad: [-{0}, {0}]", kEndlessRange_rad) : "",
          is_said ? "" : "   # guessed: three times what holds the arm");
    }
    return text;
  }

  std::string robot_text() const {
    const auto& roles = arm_.roles;
    std::string text = fmt::format(
        "# The robot of {}, as it is imported, and what a description does not say: motors, the "
        "part\n# that each link plays, a camera. `parallax draw robot.yaml --robot` shows it, and "
        "every warning\n# of `parallax check` names something of the file that has no place "
        "here.\n\n",
        fs::path(request_.file).filename().string());
    text += import_text(lift_m_, positions_);
    text += "\nbodies:\n";
    if (!arm_.root_moves) {
      text += fmt::format(
          "  pedestal:             # carries the arm, as its own root stands fast in the world\n"
          "    {{size_m: [0.1, 0.1, 0.02], mass_kg: 30, position_m: [0, 0, {}], collides: "
          "false}}\n",
          rounded_text(root_z_m_ + 0.01));
    }
    for (const std::string& pad : {roles.near_pad_body, roles.far_pad_body}) {
      text += fmt::format("  {}: {{material: pad}}\n", pad);
    }
    const std::string base = arm_.root_moves ? arm_.root : "pedestal";
    text += fmt::format(
        "\njoints:\n  held_in_place: {{type: gantry, child: {}, max_force_n: {:g}, max_torque_nm: "
        "{:g}}}   "
        "# "
        "holds the root\n",
        base, kBaseForce_n, kBaseTorque_nm);
    text += motors();
    if (!arm_.root_moves) {
      text += fmt::format("  {}: {{parent: pedestal}}\n", roles.chain.front());
    }
    text += fmt::format("  {}: {{max_force_n: {}}}\n", roles.finger_joint, rounded_text(finger_n_));
    if (!arm_.is_coupled) {
      text += fmt::format("  {}: {{follows: {{joint: {}, ratio: {:g}}}}}   # guessed\n",
                          arm_.follower, roles.finger_joint, arm_.ratio);
    }
    const double above = place_.top_m - root_z_m_;
    text += fmt::format(
        "\nrobot:\n  base: {{joint: held_in_place, body: {}}}\n"
        "  camera:\n    at_m: [{}, -0.8, {}]   # from the base: beside the table, above it\n"
        "    half_angle_rad: 0.3\n"
        "    detection: {{bias_m: 0.001, noise_m: 0.001, bias_rad: 0.005, noise_rad: 0.005}}\n"
        "  arms:\n    arm:                # the name that the model uses\n      chain: [{}]\n"
        "      finger_joint: {}\n      palm_body: {}\n      near_pad_body: {}\n"
        "      far_pad_body: {}\n      opening_m: {}\n      grip_force_n: {}\n",
        base, rounded_text(place_.x_m), rounded_text(above + 0.7), fmt::join(roles.chain, ", "),
        roles.finger_joint, roles.palm_body, roles.near_pad_body, roles.far_pad_body,
        rounded_text(opening_m_), rounded_text(effort_n_));
    return text;
  }

  std::string filled(std::string text) const {
    const double x = place_.x_m, y = place_.aside_m, top = place_.top_m;
    const double half = std::min(0.12, 0.8 * y), depth = std::min(0.6, 1.2 * x);
    const double height = 1.25 * box_m_;  // pads and palm keep off the table and the box
    const std::vector<std::pair<std::string, double>> marks = {{"X", x},
                                                               {"LEFT", y},
                                                               {"RIGHT", -y},
                                                               {"TOP", top},
                                                               {"TOP_HALF", 0.5 * top},
                                                               {"X_LOW", x - half},
                                                               {"X_HIGH", x + half},
                                                               {"LEFT_LOW", y - half},
                                                               {"LEFT_HIGH", y + half},
                                                               {"RIGHT_LOW", -y - half},
                                                               {"RIGHT_HIGH", -y + half},
                                                               {"BOTTOM_LOW", top - 0.02},
                                                               {"BOTTOM_HIGH", top + 0.02},
                                                               {"START_LOW", x - 0.02},
                                                               {"START_HIGH", x + 0.02},
                                                               {"LEFT_START_LOW", y - 0.02},
                                                               {"LEFT_START_HIGH", y + 0.02},
                                                               {"DEPTH", depth},
                                                               {"WIDTH", 2.0 * (y + half) + 0.2},
                                                               {"BOX", box_m_},
                                                               {"BOX_HEIGHT", height},
                                                               {"BOX_MIDDLE", top + 0.5 * height},
                                                               {"GRASP", 0.25 * height},
                                                               {"EFFORT", effort_n_}};
    for (const auto& [mark, value] : marks)
      text = with_mark(std::move(text), mark, rounded_text(value));
    return with_mark(std::move(text), "NAME", name_);
  }

  std::vector<ScaffoldFile> files() const {
    std::vector<ScaffoldFile> out = robot_.files;
    out.push_back({"robot.yaml", robot_text()});
    for (const TemplateFile& file : template_files()) {
      const auto slash = file.path.find('/');
      const bool shared = slash == std::string_view::npos;
      if (!shared && file.path.substr(0, slash) != "arm") continue;
      out.push_back({std::string(shared ? file.path : file.path.substr(slash + 1)),
                     filled(std::string(file.text))});
    }
    std::sort(out.begin(), out.end(),
              [](const ScaffoldFile& a, const ScaffoldFile& b) { return a.name < b.name; });
    return out;
  }

  std::string name_;
  const RobotRequest& request_;
  base::DiagnosticSink& sink_;
  base::SourceFiles sources_;
  TrialFolder trial_;
  RobotFiles robot_;
  FoundArm arm_;
  WorkPlace place_;
  std::map<std::string, double> positions_;
  double lift_m_ = 0.0, root_z_m_ = 0.0, opening_m_ = 0.0, box_m_ = 0.0, finger_n_ = 0.0,
         effort_n_ = 0.0;
};

}  // namespace

base::Result<std::vector<ScaffoldFile>> robot_scaffold(std::string_view name,
                                                       const RobotRequest& request,
                                                       base::DiagnosticSink& sink) {
  return RobotScaffolder(name, request, sink).run();
}

}  // namespace parallax::tools
