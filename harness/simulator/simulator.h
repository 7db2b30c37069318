#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/recording/recorded_scene.h"

namespace parallax::harness {

/// A value that a simulator reports or takes: SI units, radians, quaternions w-x-y-z.
using Value = std::variant<bool, std::int64_t, double, std::string>;

/// Named values, sorted by name: "robot.x", "box.held", "drawer2.q".
using State = std::map<std::string, Value, std::less<>>;

/// The one variable of an observation that could not be made.
inline constexpr std::string_view kLostVariable = "lost";

/// The status of a request. `kFailed` is the *action* failing in the simulated world (path blocked,
/// object not held): a legitimate observation that is compared with the prediction. `kLost` is the
/// *simulator* failing (crash, hang, NaN): never an observation.
enum class SimStatus : std::uint8_t {
  kOk,
  kFailed,
  kTruncated,     // the action was still running at its time limit
  kInvalidStart,  // the start state interpenetrates
  kUnsupported,
  kLost,
};
inline constexpr auto kSimStatusWords = base::word_table<SimStatus>(
    "ok", "failed", "truncated", "invalid_start", "unsupported", "lost");
constexpr std::string_view to_string(SimStatus status) { return kSimStatusWords.of(status); }
/// kUnsupported for a word that is not in the protocol.
constexpr SimStatus sim_status_from(std::string_view word) {
  return kSimStatusWords.find(word).value_or(SimStatus::kUnsupported);
}

/// The motion since the last request, packed (motion_stream.h), where motion is recorded.
struct RecordedMotion {
  std::string frames;
  std::string fault;  // why there is no more from here on; empty: there is
  friend bool operator==(const RecordedMotion&, const RecordedMotion&) = default;
};

struct Outcome {
  SimStatus status = SimStatus::kOk;
  std::string reason;       // "target unreachable: 0.71 m, reach 0.60 m"
  double sim_time_s = 0.0;  // simulated time that the request took
  State margins;            // graded companions of the verdict, for guided search
  std::string object = {};  // the thing that it found, where it looked for one
  RecordedMotion motion = {};
};

/// One variable of the continuous state: its name, unit, and whether reset takes it.
struct Parameter {
  std::string name;
  std::string unit;  // "m", "rad", "1"
  bool settable = false;
  std::optional<double> lower = {}, upper = {};  // of a start, where it says so
};

/// An argument of a controller, where the simulator tells it.
struct ActionArgument {
  std::string name;
  std::string unit;
  bool required = false;
  std::optional<Value> example = {};  // a value that it can be tried with
};
using ActionArguments = std::map<std::string, std::vector<ActionArgument>, std::less<>>;

/// The simulator's description of itself at the handshake.
struct SimulatorInfo {
  std::string name;
  std::string version;
  std::string determinism;  // "bitwise" | "tolerance" | "none"
  bool seeds = false;
  std::vector<Parameter> parameters;
  std::vector<std::string> actions;  // controllers that `act` accepts
  double timestep_s = 0.0;
  /// The scene of its motion recordings, if it makes any.
  std::optional<RecordedScene> scene = {};
  /// Arguments by action, where the simulator tells them; other actions take any arguments.
  ActionArguments arguments = {};
  std::vector<std::string> capabilities = {};     // "describe", "margins", "noise", "poses"
  double min_real_time_factor = 0.0;              // how fast it simulates at least; 0: not said
  std::vector<std::string> instant_actions = {};  // of `actions`: take no simulated time

  bool can(std::string_view capability) const;
  bool is_instant(std::string_view action) const;
};

/// An act that is going to be asked for.
struct AnnouncedAct {
  std::string action;
  State arguments;
  double sim_time_limit_s = 0.0;
};

using AnnouncedActs = std::function<std::vector<AnnouncedAct>()>;

/// Word that the reason of a loss begins with, where the simulator takes back what it showed
/// because it was of its solver: with another step, or another engine, it does not happen. The same
/// start and seed would show it again, so that such a loss is not repeated.
inline constexpr std::string_view kOfTheSolver = "of the solver";

class RemoteSimulator;

/// One simulated world. One instance per worker process, never shared.
/// Call order: info at any time; reset, then any number of act and observe. Where one of these
/// three throws, that simulation is lost with the exception's text, and the next one begins with a
/// reset.
class Simulator {
 public:
  virtual ~Simulator() = default;
  /// This one, if it is somewhere else.
  virtual RemoteSimulator* remote() { return nullptr; }
  virtual SimulatorInfo info() = 0;
  /// From the next reset on, outcomes report motion, with a frame every `interval_s` of simulated
  /// time in which something moved; 0: no longer. A simulator that cannot, or need not, does
  /// nothing.
  virtual void record_motion(double interval_s) { (void)interval_s; }
  /// Announces the requests after the next reset, and after no other, as long as nothing is lost,
  /// refused or given up: these acts, in this order, with an observation before the first one and
  /// after each. A remote simulator may do them all at once; a local one does not even call `acts`.
  virtual void announce(const AnnouncedActs& acts) { (void)acts; }
  /// Puts the world into `initial` (settable parameters; others take their default) and seeds the
  /// engine's random numbers. kOk, kInvalidStart (the reason names the pair and the depth) or
  /// kLost; kUnsupported for an unknown parameter.
  virtual Outcome reset(const State& initial, std::uint64_t seed) = 0;
  /// Runs the controller `action` to its end or for at most `sim_time_limit_s`.
  virtual Outcome act(std::string_view action, const State& arguments, double sim_time_limit_s) = 0;
  /// All observable parameters now, and "digest": a hash over the bits of the whole engine state
  /// since the last reset, so that two runs can be compared bit by bit. A simulator that is lost
  /// while observing returns kLostVariable with the reason, and nothing else.
  virtual State observe() = 0;
};

/// Thrown by reset, act and observe of a RemoteSimulator: its worker is gone, and what the
/// simulation would have shown is not known.
class WorkerGone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A simulator that a worker somewhere else has, and that may be lost together with its host, which
/// says nothing about the simulation.
class RemoteSimulator : public Simulator {
 public:
  RemoteSimulator* remote() override { return this; }
  /// Sees to it that a worker is there, which may take its time. False: there is none any more, and
  /// there will be none.
  virtual bool ready() = 0;
  /// Chooses the result of a simulation whose worker is gone: WorkerGone is thrown, or, by default,
  /// the simulator is lost.
  virtual void throw_when_gone(bool throws) = 0;
  /// May be called by any thread: nothing that this simulator is at is wanted any more.
  virtual void interrupt() = 0;
  /// The kind of the worker at work, where workers may be of several kinds whose results differ in
  /// last digits; else empty.
  virtual std::string kind() const { return {}; }
};

}  // namespace parallax::harness
