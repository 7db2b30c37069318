#pragma once

#include <utility>
#include <vector>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// The interval between frames of a recording while something moves.
inline constexpr double kRecordInterval_s = 0.05;

/// The motion that a simulation reported, in addition to its record.
struct MotionLog {
  RecordedMotion motion;       // since the start
  std::vector<State> margins;  // by action
};

/// A simulator that keeps what another one tells of motion from the last reset on, and changes
/// nothing.
class MotionTap final : public Simulator {
 public:
  /// `inner` outlives the object. Off, it passes on what it is asked.
  MotionTap(Simulator& inner, bool on) : inner_(inner), on_(on) {}

  SimulatorInfo info() override { return inner_.info(); }
  Outcome reset(const State& initial, std::uint64_t seed) override {
    log_ = {};
    inner_.record_motion(on_ ? kRecordInterval_s : 0.0);
    auto outcome = inner_.reset(initial, seed);
    note(outcome);
    return outcome;
  }
  Outcome act(std::string_view action, const State& arguments, double sim_time_limit_s) override {
    auto outcome = inner_.act(action, arguments, sim_time_limit_s);
    note(outcome);
    if (on_) log_.margins.push_back(outcome.margins);
    return outcome;
  }
  State observe() override { return inner_.observe(); }
  void announce(const AnnouncedActs& acts) override { inner_.announce(acts); }

  /// Since the last reset.
  const MotionLog& log() const { return log_; }

 private:
  void note(Outcome& outcome) {
    if (!on_) return;
    auto& motion = outcome.motion;
    log_.motion.frames += motion.frames;
    if (log_.motion.fault.empty()) log_.motion.fault = std::move(motion.fault);
    motion = {};
  }

  Simulator& inner_;
  bool on_;
  MotionLog log_;
};

}  // namespace parallax::harness
