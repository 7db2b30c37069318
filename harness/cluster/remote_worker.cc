#include "harness/cluster/remote_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "compiler/base/clock_time.h"
#include "compiler/base/subprocess.h"

namespace parallax::harness {
namespace {

// A place that fails at once, say for a name that is not known yet, gets a moment to recover.
constexpr double kFirstPauseS = 0.1, kPauseFactor = 5.0;
constexpr auto kPauseSlice = std::chrono::milliseconds(20);

bool repeats(const SimulatorInfo& info) { return info.seeds && info.determinism == "bitwise"; }

}  // namespace

RemoteWorker::RemoteWorker(std::shared_ptr<Fleet> fleet, std::vector<std::string> worker)
    : fleet_(std::move(fleet)), worker_(std::move(worker)) {}

RemoteWorker::~RemoteWorker() {
  if (link_) link_->lose({});
  if (slot_) fleet_->give_back(*slot_);
}

bool RemoteWorker::ready() {
  if (link_ && link_->is_alive()) return true;
  if (link_) lose("it ended while it was asked nothing");
  while (!interrupted_) {
    if (slot_ && losses_ >= (repeats(info_) ? kMostLossesWithRepeats : kMostLosses)) {
      fleet_->give_up(*slot_, fmt::format("{} workers in a row were lost: {}", losses_, why_));
      slot_.reset();
    }
    if (!slot_) {
      slot_ = fleet_->take();
      failed_starts_ = losses_ = 0;
      if (!slot_) return false;
    }
    if (start()) return true;
  }
  return false;
}

/// One attempt at this slot, which is left where that was one too many.
bool RemoteWorker::start() {
  auto command = fleet_->place(*slot_).prefix;
  command.insert(command.end(), worker_.begin(), worker_.end());
  link_ = std::make_unique<WorkerLink>(command, fleet_->options().limits, interrupted_);
  resets_ = 0;
  if (shake_hands()) {
    failed_starts_ = 0;
    return true;
  }
  link_.reset();
  if (interrupted_ || !slot_) return false;
  if (++failed_starts_ >= kMostStarts) {
    fleet_->give_up(*slot_, why_);
    slot_.reset();
    return false;
  }
  double seconds = kFirstPauseS;
  for (auto i = failed_starts_; i > 1; --i) seconds *= kPauseFactor;
  pause(seconds);
  return false;
}

bool RemoteWorker::shake_hands() {
  const auto fail = [&](std::string why) {
    why_ = link_->lose(std::move(why));
    return false;
  };
  auto greeting = link_->greet();
  fleet_->note_banner(*slot_, link_->banner());
  if (auto* why = std::get_if<std::string>(&greeting)) return fail(std::move(*why));
  const auto& found = std::get<ProgramIdentity>(greeting);
  if (!fleet_->admit(*slot_, found)) {
    fail({});
    slot_.reset();
    return false;
  }
  auto reply = link_->ask(HelloRequest{});
  if (auto* why = std::get_if<std::string>(&reply)) return fail(std::move(*why));
  auto& body = std::get<ReplyBody>(reply);
  auto* hello = std::get_if<HelloReply>(&body);
  if (hello == nullptr) return fail(std::get<ErrorReply>(body).message);
  if (!fleet_->agree(*slot_, base::command_text(worker_), hello->info)) {
    interrupt();
    return fail({});
  }
  info_ = std::move(hello->info);
  if (fleet_->options().mixed) {
    kind_ = found.kind();
    // One worker repeats its simulations bit for bit; another one need not give the same bits.
    if (info_.determinism == "bitwise") info_.determinism = "tolerance";
  }
  return true;
}

void RemoteWorker::pause(double seconds) const {
  const auto end = base::from_now(seconds);
  while (!interrupted_ && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(kPauseSlice);
  }
}

void RemoteWorker::lose(std::string reason) {
  why_ = fmt::format("the worker of `{}` is gone: {}", fleet_->place(*slot_).text,
                     link_->lose(std::move(reason)));
  link_.reset();
  ++losses_;
  if (!interrupted_) fleet_->note_loss(*slot_, why_);
}

Outcome RemoteWorker::outcome_of(std::variant<ReplyBody, std::string> reply) {
  if (auto* body = std::get_if<ReplyBody>(&reply)) {
    if (auto* done = std::get_if<OutcomeReply>(body)) {
      poses_.take(*done);
      return std::move(done->outcome);
    }
    const auto& error = std::get<ErrorReply>(*body);
    if (is_refusal(error)) return {SimStatus::kUnsupported, error.message, 0.0, {}};
    lose(fmt::format("{}: {}", error.code, error.message));
  } else {
    lose(std::move(std::get<std::string>(reply)));
  }
  if (throws_) throw WorkerGone(why_);
  return {SimStatus::kLost, why_, 0.0, {}};
}

Outcome RemoteWorker::reset(const State& initial, std::uint64_t seed) {
  if (!link_) return {SimStatus::kLost, why_, 0.0, {}};
  // Another simulation on the same worker: it came to the end of the one before.
  if (resets_++ > 0) losses_ = 0;
  const double interval_s = info_.scene ? record_interval_s_ : 0.0;
  poses_.begin(info_.scene ? &*info_.scene : nullptr, interval_s);
  return outcome_of(link_->ask(ResetRequest{initial, seed, interval_s}));
}

Outcome RemoteWorker::act(std::string_view action, const State& arguments,
                          double sim_time_limit_s) {
  if (!link_) return {SimStatus::kLost, why_, 0.0, {}};
  return outcome_of(link_->ask(ActRequest{std::string(action), arguments, sim_time_limit_s}));
}

State RemoteWorker::observe() {
  const auto lost = [&] { return State{{std::string(kLostVariable), why_}}; };
  if (!link_) return lost();
  auto reply = link_->ask(ObserveRequest{});
  if (auto* body = std::get_if<ReplyBody>(&reply)) {
    if (auto* observed = std::get_if<ObserveReply>(body)) return std::move(observed->state);
    const auto& error = std::get<ErrorReply>(*body);
    lose(fmt::format("{}: {}", error.code, error.message));
  } else {
    lose(std::move(std::get<std::string>(reply)));
  }
  if (throws_) throw WorkerGone(why_);
  return lost();
}

}  // namespace parallax::harness
