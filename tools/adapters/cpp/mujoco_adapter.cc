// MuJoCo behind the simulator protocol, through its C API: a slider on a rail pushes a box. One
// file, to be copied: the world is that of mujoco_pusher.xml, the rest is what any program in C++
// needs.
//
//     mujoco_adapter mujoco_pusher.xml

#include <mujoco/mujoco.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

namespace {

using Json = nlohmann::json;
using Params = std::map<std::string, double>;

/// The scenario asks for something that is not there.
struct Unsupported : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The start is impossible.
struct InvalidStart : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The simulator has failed, which is never reported as an observation.
struct Lost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Param {
  const char* name;
  const char* unit;
  bool settable;
  double fallback, lower, upper;
};
constexpr Param kParams[] = {{"rail.x", "m", true, 0.0, 0.0, 2.0},
                             {"box.x", "m", true, 0.5, 0.1, 2.0},
                             {"box.y", "m", true, 0.0, -0.05, 0.05},
                             {"box.yaw", "rad", true, 0.0, -0.5, 0.5},
                             {"box.z", "m", false, 0.0, 0.0, 0.0}};
constexpr double kTouching_m = 0.001, kTolerance_m = 0.01, kSettle_s = 0.05;

/// No exception goes through a library of C: whoever asked sees that the process is gone.
[[noreturn]] void on_error(const char* text) {
  std::cerr << "MuJoCo: " << text << std::endl;
  std::_Exit(1);
}
void on_warning(const char* text) { std::cerr << "MuJoCo: " << text << '\n'; }

/// The world: what is put, what is done, what is seen.
class Pusher {
 public:
  explicit Pusher(const std::string& file) {
    mju_user_error = &on_error;
    mju_user_warning = &on_warning;
    char why[500] = "";
    model_.reset(mj_loadXML(file.c_str(), nullptr, why, sizeof(why)));
    if (model_ == nullptr) throw std::runtime_error(why);
    data_.reset(mj_makeData(model_.get()));
    rail_ = id(mjOBJ_JOINT, "rail");
    box_ = id(mjOBJ_JOINT, "box");
    table_ = id(mjOBJ_GEOM, "table");
  }

  double time_step() const { return model_->opt.timestep; }
  double time() const { return data_->time; }

  /// Sets the interval of recorded frames from the next reset on; 0: no frames.
  void record(double interval_s) { interval_s_ = interval_s; }
  /// Returns the frames recorded since the last call.
  Json take_frames() { return std::exchange(frames_, Json::array()); }

  void reset(const Params& start, std::uint64_t seed) {
    noise_.seed(seed);
    mj_resetData(model_.get(), data_.get());
    // Noise: the friction of the table varies. The larger of two frictions counts.
    model_->geom_friction[3 * table_] = 0.5 * std::exp(0.1 * normal());
    rail() = start.at("rail.x");
    mjtNum* box = data_->qpos + model_->jnt_qposadr[box_];
    box[0] = start.at("box.x");
    box[1] = start.at("box.y");
    box[3] = std::cos(0.5 * start.at("box.yaw"));
    box[6] = std::sin(0.5 * start.at("box.yaw"));
    data_->ctrl[0] = rail();
    mj_forward(model_.get(), data_.get());
    frames_ = Json::array();
    next_frame_s_ = 0.0;
    take_frame();
    for (int i = 0; i < data_->ncon; ++i) {
      const mjContact& contact = data_->contact[i];
      if (contact.dist > -kTouching_m) continue;
      throw InvalidStart(std::string("`") + name(contact.geom1) + "` and `" + name(contact.geom2) +
                         "` interpenetrate");
    }
  }

  Json observe() const {
    const mjtNum* box = data_->qpos + model_->jnt_qposadr[box_];
    const double yaw = std::atan2(2.0 * (box[3] * box[6] + box[4] * box[5]),
                                  1.0 - 2.0 * (box[5] * box[5] + box[6] * box[6]));
    return {{"rail.x", data_->qpos[model_->jnt_qposadr[rail_]]},
            {"box.x", box[0]},
            {"box.y", box[1]},
            {"box.yaw", yaw},
            {"box.z", box[2]}};
  }

  /// False at the limit. Afterwards the slider has stopped for a moment, or does not get there.
  bool push(double target_x, double speed_m_s, double limit_s) {
    const double aim = target_x - 0.05 - 0.02 + 0.001 * normal(), end = time() + limit_s;
    double still_s = 0.0;
    while (still_s < kSettle_s) {
      if (time() >= end - 0.5 * time_step()) return false;
      const double way = speed_m_s * time_step();
      data_->ctrl[0] += std::max(-way, std::min(way, aim - data_->ctrl[0]));
      mj_step(model_.get(), data_.get());
      take_frame();
      if (data_->warning[mjWARN_BADQPOS].number + data_->warning[mjWARN_BADQVEL].number +
              data_->warning[mjWARN_BADQACC].number >
          0) {
        throw Lost("the simulation is unstable");
      }
      const double speed = data_->qvel[model_->jnt_dofadr[rail_]];
      const bool rests = data_->ctrl[0] == aim && std::abs(speed) < 1e-3;
      still_s = rests ? still_s + time_step() : 0.0;
    }
    return true;
  }

 private:
  struct Free {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  void take_frame() {
    if (interval_s_ <= 0.0 || time() < next_frame_s_ - 1e-9) return;
    next_frame_s_ = time() + interval_s_;
    const mjtNum* box = data_->qpos + model_->jnt_qposadr[box_];
    Json at = Json::array();
    for (int i = 0; i < 7; ++i) at.push_back(box[i]);
    frames_.push_back(
        {{"t", time()},
         {"bodies",
          {{"box", at}, {"slider", {data_->qpos[model_->jnt_qposadr[rail_]], 0.0, 0.06}}}}});
  }

  int id(int kind, const char* text) const {
    const int found = mj_name2id(model_.get(), kind, text);
    if (found < 0) throw std::runtime_error(std::string("the world has no `") + text + "`");
    return found;
  }
  const char* name(int geom) const { return mj_id2name(model_.get(), mjOBJ_GEOM, geom); }
  mjtNum& rail() { return data_->qpos[model_->jnt_qposadr[rail_]]; }

  /// Not std::normal_distribution, whose values differ between standard libraries.
  double normal() {
    const auto uniform = [&] { return (static_cast<double>(noise_() >> 11) + 0.5) * 0x1p-53; };
    const double u = uniform(), v = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
  }

  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
  std::mt19937_64 noise_;
  Json frames_ = Json::array();
  double interval_s_ = 0.0, next_frame_s_ = 0.0;
  int rail_ = 0, box_ = 0, table_ = 0;
};

/// Requests and replies.
class Adapter {
 public:
  explicit Adapter(const std::string& file) : world_(file) {}

  Json answer(const std::string& method, const Json& params) {
    if (method == "hello") return hello();
    if (method == "describe") return {{"params", described_params()}, {"actions", actions()}};
    if (method == "close") return {{"status", "ok"}};
    if (method == "observe") return {{"state", world_.observe()}};
    if (method == "reset") return outcome([&](Json&) { return reset(params); });
    if (method == "act") return outcome([&](Json& said) { return act(params, said); });
    throw Unsupported("no method `" + method + "`");
  }

 private:
  static Json described_params() {
    Json out = Json::array();
    for (const Param& param : kParams) {
      Json one{{"name", param.name}, {"unit", param.unit}, {"settable", param.settable}};
      if (param.settable) {
        one["lower"] = param.lower;
        one["upper"] = param.upper;
      }
      out.push_back(std::move(one));
    }
    return out;
  }

  static Json actions() {
    return {{{"name", "push"},
             {"args",
              {{{"name", "target.x"}, {"unit", "m"}, {"required", true}, {"example", 1.2}},
               {{"name", "max_speed_m_s"}, {"required", false}, {"example", 0.4}}}}}};
  }

  /// The bodies of mujoco_pusher.xml, as recordings have them.
  static Json pose_scene() {
    const auto body = [](const char* name, const char* kind, Json size) {
      return Json{{"name", name}, {"kind", kind}, {"shapes", {{{"box", std::move(size)}}}}};
    };
    Json wall = body("wall", "furniture", {0.04, 1.0, 0.2});
    wall["pose"] = {2.2, 0.0, 0.1};
    Json slider = body("slider", "robot", {0.04, 0.2, 0.08});
    Json box = body("box", "item", {0.1, 0.1, 0.1});
    slider["moves"] = box["moves"] = true;
    return {{"bodies", {wall, slider, box}}};
  }

  Json hello() const {
    return {{"protocol", 1},
            {"name", "mujoco-pusher"},
            {"version", mj_versionString()},
            {"determinism", "bitwise"},
            {"seeds", true},
            {"time_step", world_.time_step()},
            {"capabilities", {"describe", "margins", "noise", "perform", "poses"}},
            {"pose", pose_scene()},
            {"params", described_params()},
            {"actions", {{{"name", "push"}}}}};
  }

  /// "ok" or another word for how it ended.
  std::string reset(const Json& params) {
    Params start;
    for (const Param& param : kParams) {
      if (param.settable) start[param.name] = param.fallback;
    }
    for (const auto& [name, value] : params.at("state").items()) {
      if (start.count(name) == 0) throw Unsupported("no start can choose `" + name + "`");
      if (!value.is_number()) throw Unsupported("`" + name + "` is a number");
      start[name] = value.get<double>();
    }
    for (const Param& param : kParams) {
      if (!param.settable) continue;
      const double value = start[param.name];
      if (value >= param.lower && value <= param.upper) continue;
      throw InvalidStart(std::string("`") + param.name + "` is out of its bounds");
    }
    world_.record(params.value("pose_interval", 0.0));
    world_.reset(start, params.at("seed").get<std::uint64_t>());
    return "ok";
  }

  std::string act(const Json& params, Json& said) {
    const auto action = params.at("action").get<std::string>();
    if (action != "push") throw Unsupported("there is no action `" + action + "`");
    double speed_m_s = 0.4;
    std::optional<double> target_x;
    const Json given = params.value("args", Json::object());
    for (const auto& [name, value] : given.items()) {
      if (name != "target.x" && name != "max_speed_m_s") {
        throw Unsupported("`push` takes no argument `" + name + "`");
      }
      if (!value.is_number()) throw Unsupported("`" + name + "` is a number");
      (name == "target.x" ? target_x.emplace() : speed_m_s) = value.get<double>();
    }
    if (!target_x) throw Unsupported("`push` lacks the argument `target.x`");
    if (!world_.push(*target_x, speed_m_s, params.at("sim_time_limit").get<double>())) {
      return "truncated";
    }
    const double left = std::abs(world_.observe().at("box.x").get<double>() - *target_x);
    said["margins"] = {{"goal", kTolerance_m - left}};
    if (left <= kTolerance_m) return "ok";
    said["reason"] = "manipulation-goal-not-reached: " + std::to_string(left) + " m are left";
    return "failed";
  }

  template <typename Work>
  Json outcome(const Work& work) {
    const double began = world_.time();
    Json said = Json::object();
    try {
      said["status"] = work(said);
    } catch (const InvalidStart& why) {
      said = {{"status", "invalid_start"}, {"reason", why.what()}};
    } catch (const Unsupported& why) {
      said = {{"status", "unsupported"}, {"reason", why.what()}};
    } catch (const Lost& why) {
      said = {{"status", "lost"}, {"reason", why.what()}};
    }
    if (Json frames = world_.take_frames(); !frames.empty()) said["poses"] = std::move(frames);
    said["sim_time"] = std::max(0.0, world_.time() - began);
    return said;
  }

  Pusher world_;
};

/// `result` or `error`, of a request of its own or one of several.
Json answered(Adapter& adapter, const Json& request);

/// A run at once: a reset, observations and acts, up to the first that goes no further.
Json performed(Adapter& adapter, const Json& requests) {
  Json replies = Json::array();
  for (const Json& one : requests) {
    replies.push_back(answered(adapter, one));
    const Json result = replies.back().value("result", Json::object());
    const auto status = result.value("status", std::string("ok"));
    const bool goes_on = status == "ok" || status == "failed" || status == "truncated";
    if (replies.back().contains("error") || !goes_on) break;
  }
  return {{"replies", std::move(replies)}};
}

Json answered(Adapter& adapter, const Json& request) {
  const auto error = [](const char* code, const std::string& text) {
    return Json{{"error", {{"code", code}, {"message", text}}}};
  };
  try {
    const auto method = request.at("method").get<std::string>();
    const Json params = request.value("params", Json::object());
    if (method == "perform") return {{"result", performed(adapter, params.at("requests"))}};
    return {{"result", adapter.answer(method, params)}};
  } catch (const Unsupported& why) {
    return error("unsupported", why.what());
  } catch (const Json::exception& why) {
    return error("invalid_params", why.what());
  } catch (const std::exception& why) {
    return error("internal", why.what());
  }
}

Json reply_to(Adapter& adapter, const std::string& line, bool& is_last) {
  const Json request = Json::parse(line, nullptr, false);
  if (!request.is_object() || !request.contains("id")) {
    return {{"id", nullptr},
            {"error", {{"code", "parse_error"}, {"message", "the line is no request"}}}};
  }
  Json reply = answered(adapter, request);
  reply["id"] = request["id"];
  is_last = request.value("method", Json()) == "close";
  return reply;
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::cerr << "usage: mujoco_adapter WORLD.xml\n";
    return 2;
  }
  // Standard output belongs to the protocol: whatever else prints goes to standard error.
  std::FILE* replies = ::fdopen(::dup(STDOUT_FILENO), "w");
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  try {
    Adapter adapter(words[1]);
    bool is_last = false;
    for (std::string line; !is_last && std::getline(std::cin, line);) {
      std::fputs((reply_to(adapter, line, is_last).dump() + "\n").c_str(), replies);
      std::fflush(replies);
    }
    return 0;
  } catch (const std::exception& why) {
    std::cerr << "mujoco_adapter: " << why.what() << '\n';
    return 1;
  }
}
