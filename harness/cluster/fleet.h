#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/cluster/program_identity.h"
#include "harness/cluster/worker_link.h"
#include "harness/cluster/worker_place.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

struct FleetOptions {
  ProgramIdentity self;  // what a worker has to be
  WorkerLink::Limits limits;
  std::size_t first_slot = 0;  // is taken first, then those behind it, then those before it
  /// Workers of another build, or on processors that calculate otherwise, take part. Their
  /// simulations say so, and none is made twice: two workers need not give the same result.
  bool mixed = false;
  std::atomic<bool>* stop = nullptr;  // raised when no place is left; outlives the fleet
};

/// The places where workers are started, shared by the simulators that have one each: who is where,
/// which places are not used any longer, and what is to be told of it at the end.
class Fleet : public std::enable_shared_from_this<Fleet> {
 public:
  Fleet(std::vector<WorkerPlace> places, FleetOptions options);

  std::int64_t slots() const;
  /// A simulator that is served by `worker`, a command that is put behind a place's prefix. It
  /// takes a slot when it is asked for the first time, and another one where that is given up.
  std::unique_ptr<RemoteSimulator> simulator(std::vector<std::string> worker);

  /// Says which program workers have to be, unless it was said before.
  void set_self(ProgramIdentity self);

  /// Reports what became of places (kWorkerRefused, kPlaceGivenUp, kWorkersDiffer, kNoWorkerLeft),
  /// and hands on what may be of interest besides. False: there is no result, as the workers did
  /// not have the same simulator.
  bool report(base::DiagnosticSink& sink,
              const std::function<void(const std::string&)>& remark) const;

  // The remaining members are for the simulators.

  using Slot = std::size_t;
  const FleetOptions& options() const { return options_; }
  std::optional<Slot> take();
  void give_back(Slot slot);
  const WorkerPlace& place(Slot slot) const { return places_[place_of_[slot]].place; }
  /// May this program work there? If not, the slot is not given to anybody again, as below.
  bool admit(Slot slot, const ProgramIdentity& found);
  void give_up(Slot slot, const std::string& why);
  void note_banner(Slot slot, const Banner& banner);
  /// A worker was lost that had been there.
  void note_loss(Slot slot, const std::string& why);
  /// All workers of one command have to bring the same simulator. Else the work is stopped, and
  /// this is false.
  bool agree(Slot slot, const std::string& worker, const SimulatorInfo& info);

 private:
  struct Place {
    WorkerPlace place;
    Banner banner;  // of the first worker that had one
    std::int64_t losses = 0;
    std::string last_loss;
    std::int64_t given_up = 0;  // slots
    std::string why;            // of the last one of these
    std::optional<ProgramIdentity> refused, mixed_in;
  };
  struct Agreed {
    std::string info, name;
    Slot slot = 0;
  };

  void drop(Slot slot);  // under the lock
  void report_refused(const ProgramIdentity& found, const std::string& place,
                      base::DiagnosticSink& sink) const;

  FleetOptions options_;
  mutable std::mutex mutex_;  // guards what follows, but for `place` of the places
  std::vector<Place> places_;
  std::vector<std::size_t> place_of_;  // by slot
  std::vector<bool> in_use_, dropped_;
  std::size_t usable_ = 0;
  std::map<std::string, Agreed> agreed_;  // by worker's command
  std::string disagreement_;
};

}  // namespace parallax::harness
