#include "tools/cli/limits.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <new>

#include "compiler/base/clock_time.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"

namespace parallax::tools {
namespace {

constexpr std::chrono::milliseconds kGrace{1500};

const CommonOptions* g_options = nullptr;  // for the handler of failed allocations

std::mutex g_stopped_mutex;
std::string g_stopped_text;

/// Leaves the text out while standard output is being written to: the cut-off line shows that the
/// list was stopped.
void write_stopped_text() {
  const std::unique_lock lock(g_stopped_mutex, std::try_to_lock);
  if (lock.owns_lock()) print_if_free(g_stopped_text);
}

void on_out_of_memory() {
  std::set_new_handler(nullptr);
  end_for_limit(*g_options, fmt::format("--memory-limit {}", g_options->memory_limit_mb));
}

std::atomic<bool> g_stop{false};
std::atomic<int> g_signal{0};

void on_signal(int signal) {
  if (g_signal.exchange(signal) != 0) _exit(128 + signal);
  g_stop.store(true);
}

}  // namespace

void end_for_limit(const CommonOptions& options, const std::string& limit) {
  base::DiagnosticSink sink;
  const base::SourceFiles files;
  sink.error_about(codes::kLimitReached, "", limit);
  const auto diagnostics = sink.sorted();
  write_stopped_text();
  if (options.json) {
    print(error_document(diagnostics, files));
  }
  write_error(base::to_text(diagnostics.front(), files, {}));
  _exit(4);
}

StoppedText::StoppedText(std::string text) {
  const std::lock_guard lock(g_stopped_mutex);
  g_stopped_text = std::move(text);
}

StoppedText::~StoppedText() {
  const std::lock_guard lock(g_stopped_mutex);
  g_stopped_text.clear();
}

LimitGuard::LimitGuard(const CommonOptions& options) {
  if (options.memory_limit_mb > 0) {
    g_options = &options;
    std::set_new_handler(on_out_of_memory);
    const rlim_t bytes = base::bytes_of_mb(options.memory_limit_mb);
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_AS, &limit);
  }
  if (options.time_limit_s > 0) thread_ = std::thread([this, &options] { watch(options); });
}

LimitGuard::~LimitGuard() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  done_changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool LimitGuard::time_is_over() const {
  const std::lock_guard lock(mutex_);
  return over_;
}

void LimitGuard::watch(const CommonOptions& options) {
  std::unique_lock lock(mutex_);
  const auto limit = base::clock_duration(options.time_limit_s);
  if (done_changed_.wait_for(lock, limit, [this] { return done_; })) return;
  over_ = true;
  stop_flag().store(true);
  if (done_changed_.wait_for(lock, kGrace, [this] { return done_; })) return;
  end_for_limit(options, fmt::format("--time-limit {}", options.time_limit_s));
}

std::atomic<bool>& stop_flag() { return g_stop; }

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A simulator that has gone is noticed by its reply, not by a signal.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is a failed write
}

int signal_exit_code() {
  const int signal = g_signal.load();
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace parallax::tools
