#include "harness/engine/ode_process.h"

#include <ode/ode.h>
#include <ode/version.h>

#include <cstdarg>
#include <mutex>

namespace parallax::harness {
namespace {

// The engine's message hook carries no context, so the thread that steps names the counter.
thread_local std::int64_t* t_message_count = nullptr;

void count_message(int /*number*/, const char* /*text*/, va_list /*arguments*/) {
  if (t_message_count != nullptr) ++*t_message_count;
}

struct ThreadData {
  ThreadData() { dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll)); }
  ~ThreadData() { dCleanupODEAllDataForThread(); }
  ThreadData(const ThreadData&) = delete;
  ThreadData& operator=(const ThreadData&) = delete;
};

}  // namespace

void enter_ode() {
  // A second initialisation would trip an assertion inside the engine; it is never closed, because
  // worlds of other threads may outlive any place where that could be done.
  static std::once_flag once;
  std::call_once(once, [] {
    dInitODE2(0);
    dSetMessageHandler(&count_message);
  });
  thread_local const ThreadData data;
}

std::string ode_version() { return dODE_VERSION; }

void seed_ode(std::uint64_t seed) { dRandSetSeed(static_cast<unsigned long>(seed)); }

MessageCounter::MessageCounter(std::int64_t& count) : previous_(t_message_count) {
  t_message_count = &count;
}

MessageCounter::~MessageCounter() { t_message_count = previous_; }

}  // namespace parallax::harness
