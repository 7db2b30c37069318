#pragma once

// The shared library libparallax: models and their traces, and the whole loop of `parallax run`,
// with simulators of your own. This header needs nothing but the standard library, and nothing else
// of parallax is visible.
//
//     namespace px = parallax::api;
//     const px::Model model = px::Model::load({.files = {"door.e"}});
//     model.traces(10, [](const px::Trace& trace) { std::puts(trace.text.c_str()); return true; });
//     const px::Run run = px::run("scenario.yaml", {.folder = "out/first"});
//     std::puts(run.summary.c_str());
//
// Failures are exceptions, px::Failure, with the messages that the program would print.
// Functions may be called from several threads at the same time; one Model may be used by several,
// too. Units are SI, angles radians.
//
// Functions of yours that are called: what reset, act and observe of a Simulator throw loses that
// simulation, with the exception's text, and counts against the claim. What any other one throws
// (MakeSimulator, Simulator::info, progress, the taker of traces) ends the call and reaches its
// caller as it was thrown; what was simulated is in the journal, and `resume` goes on. `progress`
// and MakeSimulator may be empty; a MakeSimulator that makes none, and an empty taker, are Failure.

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The version that this header belongs to; version() says what is linked.
#define PARALLAX_VERSION "0.2.0"

#if defined(__GNUC__)
#define PARALLAX_API __attribute__((visibility("default")))
#else
#define PARALLAX_API
#endif

namespace parallax::api {

/// Version of the library that is linked: "0.2.0". Two versions with the same first two numbers
/// take the same clients.
PARALLAX_API std::string version();

/// A message about a text or a file, as `parallax check` prints it.
struct Message {
  bool is_error = true;  // else a warning
  std::string code;      // "E2104": docs/reference/diagnostics.md
  std::string text;
  std::string path;          // empty: no file
  int line = 0, column = 0;  // from 1; 0: no place
  std::string fix;           // text to replace the place with; empty: none is known
};

/// Something was refused, or ended without an answer.
class PARALLAX_API Failure : public std::runtime_error {
 public:
  Failure(const std::string& what, std::vector<Message> messages);
  ~Failure() override;
  const std::vector<Message>& messages() const { return messages_; }

 private:
  std::vector<Message> messages_;
};

/// Texts of a model, with a plan if one is given.
struct ModelOptions {
  std::vector<std::string> files;  // event calculus (.e), or one compiled model (.cnf)
  std::vector<std::string> include_folders = {};
  int horizon = -1;                     // below 0: as the model says
  bool as_decreasoner = false;          // the meaning of the 2005 reasoner where it differs
  std::vector<std::string> until = {};  // state constraints: a trace ends where one holds
  std::vector<std::string> plan = {};   // Lisp files in order
  std::string bindings = {};            // the plan's binding table (.bind)
  std::string plan_entry = {};          // the function to run; empty: as the plan says
};

/// One timepoint of a trace: names as the model prints them, sorted.
struct Point {
  std::vector<std::string> holds;    // fluents
  std::vector<std::string> happens;  // events, between this timepoint and the next
};

struct Trace {
  std::int64_t number = 0;    // from 1
  std::vector<Point> points;  // timepoints 0 to the last
  std::string text;           // as `parallax traces` prints it
  std::string json;           // as `parallax traces --format jsonl` does
};

/// The state of knowledge when a list of traces has ended.
enum class Explored {
  kAll,        // there is no further trace
  kUpToBound,  // none up to the horizon; executions go on beyond it
  kStopped,    // the limit, the caller or `stop` ended the list
};

/// A compiled model.
class PARALLAX_API Model {
 public:
  /// Throws Failure where a text has errors.
  static Model load(const ModelOptions& options);
  /// The model of a scenario with its plan and constraints.
  static Model of_scenario(const std::string& path);
  ~Model();
  Model(Model&& other) noexcept;
  Model& operator=(Model&& other) noexcept;

  int horizon() const;
  std::int64_t variables() const;
  std::int64_t clauses() const;
  /// Warnings about the texts.
  const std::vector<Message>& warnings() const;

  /// Hands the traces to `take` in canonical order, `limit` at most (0: all), until it returns
  /// false. What `take` throws reaches the caller. `stop`, raised by another thread, ends the
  /// search. Throws Failure where `take` is empty.
  Explored traces(std::int64_t limit, const std::function<bool(const Trace&)>& take,
                  const std::atomic<bool>* stop = nullptr) const;
  /// The number of traces in decimal, which may have hundreds of digits; of a model with a plan or
  /// constraints they are listed for it. Throws Failure where `stop` was raised before it was
  /// known.
  std::string count(const std::atomic<bool>* stop = nullptr) const;

 private:
  struct Body;
  explicit Model(std::unique_ptr<Body> body);
  std::unique_ptr<Body> body_;
};

/// A value that a simulator reports or takes.
using Value = std::variant<bool, std::int64_t, double, std::string>;
/// Named values: "robot.x", "box.held".
using Values = std::map<std::string, Value, std::less<>>;

enum class Status {
  kOk,
  kFailed,        // the action failed in the world: something that is observed
  kTruncated,     // it was still running at its time limit
  kInvalidStart,  // of reset: the start cannot be
  kUnsupported,   // there is no such variable or action
  kLost,          // the simulator itself failed: counts against every claim
};

struct Outcome {
  Status status = Status::kOk;
  std::string reason = {};
  double sim_time_s = 0.0;  // simulated time that the request took
  Values margins = {};      // how near it was to ending otherwise; may be empty
  std::string object = {};  // what was found, where the action looks for something
};

/// A variable of the continuous state.
struct Variable {
  std::string name, unit;  // "m", "rad", "1"
  bool settable = false;   // reset takes it
};

struct SimulatorInfo {
  std::string name, version;
  std::vector<Variable> variables;
  std::vector<std::string> actions;
  double timestep_s = 0.0;
  bool repeats_bitwise = false;  // the same start and seed give the same bits
};

/// A world of your own. Each worker has one, in a thread of its own. Calls: info at any time;
/// reset, then any number of act and observe. What reset, act and observe throw loses that
/// simulation, with its text.
class PARALLAX_API Simulator {
 public:
  Simulator();
  virtual ~Simulator();
  virtual SimulatorInfo info() = 0;
  virtual Outcome reset(const Values& start, std::uint64_t seed) = 0;
  virtual Outcome act(std::string_view action, const Values& arguments, double time_limit_s) = 0;
  virtual Values observe() = 0;
};
using MakeSimulator = std::function<std::unique_ptr<Simulator>()>;

struct Progress {
  std::int64_t trace = 0;             // number of the trace that is simulated
  std::int64_t done = 0, needed = 0;  // simulations of it
};

struct RunOptions {
  std::string folder;  // of the run, as `--out`; made if missing
  std::uint64_t seed = 1;
  int jobs = 1;  // simulations at the same time
  bool keep_going = false, resume = false;
  std::int64_t max_runs = 0;  // simulations of one trace; 0: as the scenario says
  /// A simulator of your own; empty: the one that the scenario names.
  MakeSimulator simulator = {};
  /// The program that simulates built-in worlds, in processes of its own.
  std::string program = "parallax";
  /// May a command that the scenario names be started?
  bool allow_commands = false;
  const std::atomic<bool>* stop = nullptr;  // raised by another thread
  std::function<void(const Progress&)> progress = {};
};

enum class Verdict { kNoDiscrepancy, kDiscrepancy, kInconclusive };

struct Discrepancy {
  std::int64_t trace = 0, sample = 0;
  int timepoint = 0;                 // the first at which prediction and simulation differ
  std::string cause;                 // "Go(bTable): navigation-pose-unreachable"
  std::vector<std::string> fluents;  // that differ there
  Values start;                      // how that simulation began
};

struct Run {
  Verdict verdict = Verdict::kInconclusive;
  std::string scenario_hash;        // over every text that was read, as the journal has it
  std::string claim;                // of all traces together; empty: each is claimed by itself
  std::string exploration;          // what is known of traces that were not simulated
  std::vector<std::string> bounds;  // what was left out, a sentence each
  std::int64_t traces = 0, simulations = 0, lost = 0;
  std::vector<Discrepancy> discrepancies;
  std::string summary;      // as `parallax run` prints it
  std::string report_json;  // as report.json of the run's folder has it
  std::vector<Message> warnings;
};

/// Runs a scenario: traces, starts, simulations, verdict. The folder has journal and report
/// afterwards, and `parallax replay` and `report` read it, unless the simulator is your own. Throws
/// Failure where the program's exit code would be 2, 3 or 5.
PARALLAX_API Run run(const std::string& scenario, const RunOptions& options);

}  // namespace parallax::api
