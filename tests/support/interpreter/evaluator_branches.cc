// `par` and `pursue` whose branches take turns. A branch is a thread of its own; only one thread
// runs at a time, and control is handed over where a branch waits at a perform. Who goes on is a
// pick, so that all orders are executed.
#include <sched.h>
#include <semaphore.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "tests/support/interpreter/evaluator.h"
#include "tests/support/interpreter/jumps.h"

namespace parallax::test {

/// Without clean-ups: they come behind everything that is left of the plan.
enum class End {
  kValue,
  kValueWithoutCleanups,
  kFailure,
  kFailureAfterCleanups,
  kFailureWithoutCleanups
};

/// A way to go on: the path of nested branches to a perform, or to an end of the form.
struct Evaluator::Way {
  std::vector<std::size_t> path;
  std::optional<End> end;
};

/// Waits without asking again and again: std::binary_semaphore of g++ 12 yields the processor 16
/// times first, which costs as much as the plans, and many times more where other programs run.
class Turn {
 public:
  Turn() { ::sem_init(&semaphore_, 0, 0); }
  ~Turn() { ::sem_destroy(&semaphore_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  void release() { ::sem_post(&semaphore_); }
  void acquire() {
    while (::sem_wait(&semaphore_) != 0) {
    }
  }

 private:
  ::sem_t semaphore_{};
};

struct Evaluator::Branch {
  enum class Status { kRunning, kWaits, kInside, kStands, kDone, kFailed, kOver };
  enum class Order { kGo, kEvaporate, kAbort };

  bool over() const { return status >= Status::kDone; }

  Status status = Status::kRunning;
  PlanItem value;
  std::string failure;
  std::exception_ptr error;  // of the whole execution

  Branches* of = nullptr;
  Branches* inner = nullptr;    // kInside: these take turns in it
  Branch* ending = nullptr;     // it runs the clean-ups of this one
  std::vector<Branches*> kept;  // ended ones whose clean-ups are still to run
  int protections = 0;          // unwind-protects it is in
  int cleanups = 0;             // clean-up forms it is in
  bool fresh = true;            // it has not waited yet
  bool asked = false;           // it has waited at a question, on its way to a perform

  Order order = Order::kGo;
  Way way;
  Place place;
  Turn go, back;
  std::thread thread;
};

/// Branches hand control to each other, so they are on one core: waking a thread on another one
/// takes many times longer. Ends with its scope.
class OneCore {
 public:
  OneCore() {
    const int here = ::sched_getcpu();
    if (here < 0 || here >= CPU_SETSIZE) return;
    if (::sched_getaffinity(0, sizeof before_, &before_) != 0) return;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(here, &one);
    narrowed_ = ::sched_setaffinity(0, sizeof one, &one) == 0;
  }
  ~OneCore() {
    if (narrowed_) ::sched_setaffinity(0, sizeof before_, &before_);
  }
  OneCore(const OneCore&) = delete;
  OneCore& operator=(const OneCore&) = delete;

 private:
  cpu_set_t before_{};
  bool narrowed_ = false;
};

struct Evaluator::Branches {
  bool pursue = false;
  Branch* owner = nullptr;
  std::vector<std::unique_ptr<Branch>> all;
  std::optional<std::string> failure;
  std::optional<PlanItem> value;

  bool decided() const { return failure || value; }

  static bool busy(const Branch& branch) {
    return branch.cleanups > 0 || (branch.inner != nullptr && branch.inner->any(busy));
  }
  static bool cleans_up(const Branch& branch) {
    if (branch.over()) return false;
    const auto kept = [](const Branches* inner) { return inner->any(cleans_up); };
    return branch.protections > 0 || (branch.inner != nullptr && kept(branch.inner)) ||
           std::any_of(branch.kept.begin(), branch.kept.end(), kept);
  }
  bool any(bool (*is)(const Branch&)) const {
    return std::any_of(all.begin(), all.end(), [&](const auto& branch) { return is(*branch); });
  }

  std::vector<End> ends() const {
    std::vector<End> out;
    if (any(busy)) return out;
    const bool cleaning = any(cleans_up);
    if (value) out.push_back(End::kValue);
    if (value && cleaning) out.push_back(End::kValueWithoutCleanups);
    if (failure) out.push_back(End::kFailure);
    if (failure && cleaning) out.push_back(End::kFailureAfterCleanups);
    if (failure && cleaning) out.push_back(End::kFailureWithoutCleanups);
    return out;
  }

  static void ways(const Branch& branch, const std::vector<std::size_t>& path,
                   std::vector<Way>& out) {
    if (branch.ending != nullptr) return ways(*branch.ending, path, out);
    if (branch.status == Branch::Status::kWaits) out.push_back({path, std::nullopt});
    if (branch.status == Branch::Status::kInside) branch.inner->ways(path, out);
  }
  void ways(const std::vector<std::size_t>& path, std::vector<Way>& out) const {
    for (const auto end : ends()) out.push_back({path, end});
    for (std::size_t i = 0; i < all.size(); ++i) {
      auto further = path;
      further.push_back(i);
      ways(*all[i], further, out);
    }
  }

  /// Ends all branches where they stand.
  void abort() {
    for (const auto& branch : all) {
      if (!branch->over()) {
        branch->order = Branch::Order::kAbort;
        branch->go.release();
      }
      if (branch->thread.joinable()) branch->thread.join();
    }
    all.clear();
  }
  ~Branches() { abort(); }
};

Evaluator::Place Evaluator::place() const {
  return {handlers_, blocks_, specials_, task_specials_};
}

void Evaluator::restore(const Place& place) {
  handlers_ = place.handlers;
  blocks_ = place.blocks;
  specials_ = place.specials;
  task_specials_ = place.task_specials;
}

/// Called in the branch's thread: hands control back until somebody lets it go on.
void Evaluator::yield(Branch& branch) {
  branch.place = place();
  branch.fresh = false;
  branch.back.release();
  branch.go.acquire();
  if (branch.order == Branch::Order::kAbort) throw Stop{};
  restore(branch.place);
  branch.status = Branch::Status::kRunning;
  if (branch.order == Branch::Order::kEvaporate) {
    branch.order = Branch::Order::kGo;
    throw Evaporated{};
  }
}

/// Hands control to the branch until it waits or is over.
void Evaluator::resume(Branch& branch) {
  const auto own = place();
  auto* const before = std::exchange(running_, &branch);
  branch.go.release();
  branch.back.acquire();
  running_ = before;
  restore(own);
  if (branch.error) std::rethrow_exception(branch.error);
}

/// The branch that runs is at a perform or asks the model. Once its form is decided nothing new is
/// begun, except a branch's first perform, one behind a question, and clean-ups.
void Evaluator::wait_for_turn(bool asks) {
  if (running_ == nullptr) return;
  bool may = true;
  bool cleaning = false;
  for (const auto* at = running_; at != nullptr; at = at->of->owner) {
    cleaning = cleaning || at->cleanups > 0;
    if (at->of->decided()) may = cleaning || at->fresh;
  }
  may = may || running_->asked;
  running_->asked = may && asks;
  running_->status = may ? Branch::Status::kWaits : Branch::Status::kStands;
  yield(*running_);
}

void Evaluator::start(Branches& all, const Datum& form, const ScopePtr& scope) {
  const auto around = place();
  for (std::size_t i = 1; i < form.items.size(); ++i) {
    auto& branch = *all.all.emplace_back(std::make_unique<Branch>());
    branch.of = &all;
    branch.thread = std::thread([this, &branch, &around, &form, scope, i] {
      branch.go.acquire();
      if (branch.order != Branch::Order::kAbort) {
        restore(around);
        const int id = ++next_id_;
        blocks_.clear();
        task_specials_ = specials_.size();
        Handler border;
        border.task = true;
        border.id = id;
        handlers_ = {border};
        try {
          branch.value = rebinding([&] { return eval(form.items[i], scope); });
          branch.status = Branch::Status::kDone;
        } catch (const TaskFailed& failed) {
          branch.failure = failed.what;
          branch.status = Branch::Status::kFailed;
        } catch (const Evaporated&) {
          branch.status = Branch::Status::kOver;
        } catch (...) {
          branch.error = std::current_exception();
          branch.status = Branch::Status::kOver;
        }
      }
      branch.back.release();
    });
    resume(branch);
    note(all, branch);
  }
}

/// The first failure and, of a `pursue`, the first value decide; a value after a failure does not.
void Evaluator::note(Branches& all, Branch& branch) const {
  using Status = Branch::Status;
  const bool failed = branch.status == Status::kFailed;
  if (failed && !all.failure) all.failure = branch.failure;
  const bool first = !all.failure && !all.value;
  if (branch.status == Status::kDone && all.pursue && first) all.value = branch.value;
}

/// The clean-ups of all branches, those of the first branch first.
void Evaluator::end_all(Branches& all) {
  if (running_ != nullptr) ++running_->cleanups;
  for (const auto& branch : all.all) {
    if (branch->over()) continue;
    branch->order = Branch::Order::kEvaporate;
    resume(*branch);
    while (!branch->over()) {
      if (running_ != nullptr) {
        running_->ending = branch.get();
        running_->status = Branch::Status::kWaits;
        yield(*running_);
        running_->ending = nullptr;
        branch->way = running_->way;
      } else if (branch->status == Branch::Status::kInside) {
        std::vector<Way> ways;
        branch->inner->ways({}, ways);
        branch->way = ways[pick(ways.size())];
      }
      resume(*branch);
    }
  }
  if (running_ != nullptr) --running_->cleanups;
}

PlanItem Evaluator::turns_of(Branches& all) {
  for (;;) {
    const auto done = [](const auto& branch) { return branch->status == Branch::Status::kDone; };
    if (!all.decided() && std::all_of(all.all.begin(), all.all.end(), done)) {
      return all.all.front()->value;
    }
    std::vector<Way> ways;
    all.ways({}, ways);
    const auto waits = [](const Way& way) { return !way.end; };
    const auto own = all.ends();
    Way way;
    if (own.size() == 1 && std::none_of(ways.begin(), ways.end(), waits)) {
      way.end = own.front();
    } else if (running_ != nullptr) {
      running_->inner = &all;
      running_->status = Branch::Status::kInside;
      yield(*running_);
      running_->inner = nullptr;
      way = running_->way;
    } else {
      way = ways[pick(ways.size())];
    }
    if (!way.path.empty()) {
      auto& next = *all.all[way.path.front()];
      next.way = {{way.path.begin() + 1, way.path.end()}, way.end};
      resume(next);
      note(all, next);
      continue;
    }
    const bool drops =
        way.end == End::kValueWithoutCleanups || way.end == End::kFailureWithoutCleanups;
    if (drops) {
      const auto inside = place();  // what the branches leave is not ours
      all.abort();
      restore(inside);
    }
    if (way.end == End::kFailure || way.end == End::kFailureWithoutCleanups) {
      if (running_ != nullptr) running_->kept.push_back(&all);
      signal(*all.failure);  // the clean-ups of the branches follow what its handler decides
    }
    end_all(all);
    if (way.end == End::kValue || way.end == End::kValueWithoutCleanups) return *all.value;
    signal(*all.failure);
  }
}

PlanItem Evaluator::taking_turns(const Datum& form, const ScopePtr& scope, bool pursue) {
  std::optional<OneCore> one_core;
  if (running_ == nullptr) one_core.emplace();  // inner branches are there already
  Branches all;
  all.pursue = pursue;
  all.owner = running_;
  const auto forget = [&] {
    if (running_ == nullptr) return;
    running_->inner = nullptr;
    std::erase(running_->kept, &all);
  };
  try {
    start(all, form, scope);
    auto out = turns_of(all);
    forget();
    return out;
  } catch (const Stop&) {
    throw;
  } catch (const std::exception&) {
    throw;
  } catch (...) {
    forget();
    end_all(all);
    throw;
  }
}

PlanItem Evaluator::cleaned_up(const Datum& form, const ScopePtr& scope) {
  auto* const branch = running_;
  const auto handlers = handlers_;
  const auto blocks = blocks_;
  PlanItem out;
  std::exception_ptr jump;
  bool lost = false;  // true: an early exit from these clean-ups is lost
  const auto count = [&](int protections, int cleanups) {
    if (branch == nullptr) return;
    branch->protections += protections;
    branch->cleanups += cleanups;
  };
  count(1, 0);
  try {
    out = eval(form.items[1], scope);
  } catch (const Stop&) {
    throw;
  } catch (const std::exception&) {
    throw;
  } catch (const Evaporated&) {
    lost = true;
    jump = std::current_exception();
  } catch (...) {
    jump = std::current_exception();
  }
  handlers_ = handlers;
  blocks_ = blocks;
  count(-1, 1);
  if (lost) {
    Handler border;
    border.task = true;
    border.id = ++next_id_;
    handlers_ = {border};
  }
  try {
    body(form.items, 2, scope);
  } catch (const Stop&) {
    throw;
  } catch (const std::exception&) {
    throw;
  } catch (...) {
    // A branch that another one ended has only its clean-ups left: a failure is lost, and a jump
    // leads nowhere.
    if (!lost) {
      count(0, -1);
      throw;
    }
  }
  count(0, -1);
  if (jump) std::rethrow_exception(jump);
  return out;
}

}  // namespace parallax::test
