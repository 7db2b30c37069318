#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/mistakes/event_sequences.h"
#include "tools/bench/mistakes/mistake.h"

namespace parallax::tools {

/// A world of `tools/bench/mistakes/worlds`. Those that were written last are held out: nobody
/// looks at their mistakes while the repair is changed.
struct MistakeWorld {
  std::string name;
  bool held_out = false;
};

const std::vector<MistakeWorld>& mistake_worlds();

/// How a mistake came to light.
enum class Shown {
  kFirstPlan,
  kSecondPlan,  // only there; the second plan's run is repaired then, and the first one validates
  kRefused,     // no run was possible: the model excludes what the world is like at the start
  kPermissive,  // both runs are clean, although the model predicts other things than the world
  kInvisible,   // both plans go alike in model and world
  kNoModel,     // the text has errors
};

const char* to_string(Shown shown);

/// One mistake, or two at once, and the proposals for it.
struct MistakeOutcome {
  std::string world;
  int number = 0;            // within the world; doubles are counted from 1000 on
  std::string kind;          // "two mistakes" for doubles
  std::string about;         // the wrong lines
  bool of_demanded = false;  // a wrong line is about an event that an axiom demands
  Shown shown = Shown::kNoModel;
  int proposals = 0;
  int right_rank = 0;         // of the first proposal that is right on the plan of the run; 0: none
  bool right_second = false;  // proposal `right_rank` is right on the other plan, too
  bool right_random = false;  // and on random sequences of events
  bool first_is_marked = false;  // says itself that it may be wrong, or is one of several equals
  double list_s = 0.0;           // processor time of the list of proposals
  std::string first;             // what the first proposal says

  bool counts() const {
    return shown == Shown::kFirstPlan || shown == Shown::kSecondPlan || shown == Shown::kRefused;
  }
};

std::string to_json(const MistakeOutcome& outcome);
std::optional<MistakeOutcome> read_outcome(const std::string& line);

struct TrialOptions {
  std::string worlds;          // folder of the worlds
  std::string program;         // `parallax`
  std::string folder;          // for everything that is written
  double list_limit_s = 60.0;  // processor time of one list; beyond it there are no proposals
};

/// A world made ready: its plans were executed, and random sequences of its events drawn.
class MistakeTrial {
 public:
  /// nullopt with a message if the world has errors, or its own model is wrong about it.
  static std::optional<MistakeTrial> make(const MistakeWorld& world, const TrialOptions& options,
                                          std::string& error);

  const ModelText& model() const { return model_; }
  MistakeOutcome measure(const std::vector<Mistake>& mistakes, int number) const;

 private:
  MistakeTrial(MistakeWorld world, TrialOptions options)
      : world_(std::move(world)), options_(std::move(options)) {}

  bool prepare(std::string& error);
  struct Ended {
    int code = -1;
    double cpu_s = 0.0;
    std::string out;
  };
  Ended run(const std::vector<std::string>& arguments, double limit_s = 120.0) const;
  std::string path(const std::string& name) const;
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  std::optional<std::vector<EventSequence>> executed(const std::string& folder) const;
  std::vector<bool> are_executable(const std::vector<EventSequence>& sequences) const;
  bool predicts(const std::string& sequences) const;
  int run_plan(const std::string& plan) const;
  bool apply(const std::string& patch, const std::string& folder) const;
  void propose(const std::vector<Mistake>& mistakes, const std::string& run,
               MistakeOutcome& outcome) const;

  MistakeWorld world_;
  TrialOptions options_;
  ModelText model_;
  std::map<std::string, int> horizons_;  // of first, second, random
};

}  // namespace parallax::tools
