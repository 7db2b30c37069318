#include "harness/simulator/worker.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "compiler/base/clock_time.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

constexpr int kStopSliceMs = 100;  // how late a raised flag may be seen

bool is_raised(const std::atomic<bool>* flag) { return flag != nullptr && flag->load(); }

/// Lines from a descriptor, without their newline.
class LineReader {
 public:
  enum class Event : std::uint8_t { kLine, kEnd, kTooLong, kError, kStopped };

  LineReader(int fd, const std::atomic<bool>* stop) : fd_(fd), stop_(stop) {}

  Event next(std::string& line) {
    for (;;) {
      const std::size_t newline = buffer_.find('\n', searched_);
      if (newline != std::string::npos) {
        if (newline > kMaxLineBytes) return Event::kTooLong;
        line.assign(buffer_, 0, newline);
        buffer_.erase(0, newline + 1);
        searched_ = 0;
        return Event::kLine;
      }
      searched_ = buffer_.size();
      if (buffer_.size() > kMaxLineBytes) return Event::kTooLong;
      if (!wait()) return Event::kStopped;
      std::array<char, 65536> chunk{};
      const ssize_t count = ::read(fd_, chunk.data(), chunk.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return Event::kError;
      if (count == 0)
        return Event::kEnd;  // a last line without its newline was cut off: no request
      buffer_.append(chunk.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  /// Until there is something to read. False: the flag was raised.
  bool wait() const {
    if (stop_ == nullptr) return true;
    while (!stop_->load()) {
      pollfd at{fd_, POLLIN, 0};
      if (::poll(&at, 1, kStopSliceMs) != 0) return true;
    }
    return false;
  }

  int fd_;
  const std::atomic<bool>* stop_;
  std::string buffer_;
  std::size_t searched_ = 0;
};

/// Where lines go, each whole, whoever writes it.
class LineWriter {
 public:
  explicit LineWriter(int fd) : fd_(fd) {}

  bool write(std::string line) {
    line.push_back('\n');
    const std::lock_guard lock(mutex_);
    std::size_t written = 0;
    while (written < line.size()) {
      const ssize_t count = ::write(fd_, line.data() + written, line.size() - written);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      written += static_cast<std::size_t>(count);
    }
    return true;
  }

 private:
  int fd_;
  std::mutex mutex_;
};

/// Has the other end been closed? Only to be asked while nothing more is expected from there.
bool is_closed(int fd) {
  pollfd at{fd, POLLIN | POLLRDHUP, 0};
  if (::poll(&at, 1, 0) <= 0) return false;
  if ((at.revents & (POLLHUP | POLLRDHUP | POLLERR | POLLNVAL)) != 0) return true;
  int waiting = 0;
  return (at.revents & POLLIN) != 0 && ::ioctl(fd, FIONREAD, &waiting) == 0 && waiting == 0;
}

/// Says in a thread of its own that a request is under way, however long the simulator is at it.
class Pulse {
 public:
  Pulse(int in_fd, LineWriter& out, const ServeOptions& options)
      : in_fd_(in_fd), out_(out), options_(options) {
    if (options.beat_s > 0.0) thread_ = std::thread([this] { run(); });
  }
  ~Pulse() {
    set(kClosing);
    if (thread_.joinable()) thread_.join();
  }
  Pulse(const Pulse&) = delete;
  Pulse& operator=(const Pulse&) = delete;

  void begin(std::int64_t request) { set(request); }
  void end() { set(kIdle); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::int64_t kIdle = -1, kClosing = -2;
  static constexpr auto kLook = std::chrono::milliseconds(200);  // how late an end is seen

  void set(std::int64_t request) {
    {
      const std::lock_guard lock(mutex_);
      request_ = request;
    }
    changed_.notify_all();
  }

  void run() {
    const auto interval = base::clock_duration(options_.beat_s);
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return request_ != kIdle; });
      if (request_ == kClosing) return;
      const auto request = request_;
      auto next = Clock::now() + interval;
      while (request_ == request) {
        changed_.wait_until(lock, std::min(next, Clock::now() + kLook));
        if (request_ != request) break;
        // Unlocked: a reader that does not read must not keep the reply from being tried.
        lock.unlock();
        bool alive = !is_closed(in_fd_);
        if (alive && Clock::now() >= next) {
          alive = out_.write(beat_line(request));
          next = Clock::now() + interval;
        }
        if (!alive && options_.stop != nullptr) options_.stop->store(true);
        lock.lock();
      }
    }
  }

  int in_fd_;
  LineWriter& out_;
  const ServeOptions& options_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::int64_t request_ = kIdle;
  std::thread thread_;
};

struct ActionAnswer {
  ReplyBody reply;
  bool last = false;
};

/// JSON has no NaN: a simulator that reports one gets an error reply instead of a broken line.
ReplyBody checked(ReplyBody reply) {
  const State* state = nullptr;
  if (const auto* observed = std::get_if<ObserveReply>(&reply)) state = &observed->state;
  if (const auto* done = std::get_if<OutcomeReply>(&reply)) state = &done->outcome.margins;
  if (state == nullptr) return reply;
  const std::string name = first_not_finite(*state);
  if (name.empty()) return reply;
  return ErrorReply{"not_finite", "`" + name + "` is not a finite number"};
}

struct Dispatcher {
  Simulator& simulator;
  bool& reset_done;

  ActionAnswer operator()(const HelloRequest& hello) const {
    if (std::find(hello.protocols.begin(), hello.protocols.end(), kProtocolVersion) ==
        hello.protocols.end()) {
      return {ErrorReply{"unsupported", "this simulator speaks protocol 1"}};
    }
    auto info = simulator.info();
    if (info.name.empty()) return {ErrorReply{"internal", info.version}};  // it did not start
    return {HelloReply{kProtocolVersion, std::move(info)}};
  }
  ActionAnswer operator()(const ResetRequest& reset) const {
    simulator.record_motion(reset.record_interval_s);
    Outcome outcome = simulator.reset(reset.state, reset.seed);
    reset_done = outcome.status == SimStatus::kOk;
    return {OutcomeReply{std::move(outcome)}};
  }
  ActionAnswer operator()(const ActRequest& act) const {
    if (!reset_done) return {ErrorReply{"incorrect_state", "act before a successful reset"}};
    return {OutcomeReply{simulator.act(act.action, act.arguments, act.sim_time_limit_s)}};
  }
  ActionAnswer operator()(const ObserveRequest&) const {
    if (!reset_done) return {ErrorReply{"incorrect_state", "observe before a successful reset"}};
    return {ObserveReply{simulator.observe()}};
  }
  ActionAnswer operator()(const CloseRequest&) const { return {CloseReply{}, true}; }
  ActionAnswer operator()(const DescribeRequest&) const {
    return {DescribeReply{simulator.info()}};
  }
  /// `decode_request` takes it for unknown: a worker does not offer it.
  ActionAnswer operator()(const PerformRequest&) const {
    return {ErrorReply{"unsupported", "no method `perform`"}};
  }
  ActionAnswer operator()(const UnknownRequest& unknown) const {
    return {ErrorReply{"unsupported", "no method `" + unknown.method + "`"}};
  }
};

}  // namespace

constexpr std::string_view kBeatBegin = R"({"beat":)";

std::string beat_line(std::int64_t id) {
  return std::string(kBeatBegin) + std::to_string(id) + '}';
}

bool is_beat(std::string_view line) { return line.starts_with(kBeatBegin); }

int serve(Simulator& simulator, int in_fd, int out_fd, const ServeOptions& options) {
  LineReader reader(in_fd, options.stop);
  LineWriter out(out_fd);
  // An unfinished line from a shell must not stand before the greeting.
  if (!options.greeting.empty() && !out.write('\n' + options.greeting)) return 1;
  Pulse pulse(in_fd, out, options);
  std::string line;
  bool reset_done = false;
  for (;;) {
    switch (reader.next(line)) {
      case LineReader::Event::kEnd:
        return 0;
      case LineReader::Event::kError:
      case LineReader::Event::kStopped:
        return 1;
      case LineReader::Event::kTooLong:
        out.write(encode_error_without_id({"line_too_long", "line longer than 1 MiB"}));
        return 1;
      case LineReader::Event::kLine:
        break;
    }
    const auto decoded = decode_request(line);
    if (const auto* bad = std::get_if<Malformed>(&decoded)) {
      const ErrorReply error{bad->code, bad->message};
      if (!out.write(bad->has_id ? encode_reply(bad->id, error) : encode_error_without_id(error))) {
        return 1;
      }
      continue;
    }
    const Request& request = std::get<Request>(decoded);
    pulse.begin(request.id);
    ActionAnswer answer = std::visit(Dispatcher{simulator, reset_done}, request.body);
    pulse.end();
    if (is_raised(options.stop)) return 1;
    if (!out.write(encode_reply(request.id, checked(std::move(answer.reply))))) return 1;
    if (answer.last) return 0;
  }
}

}  // namespace parallax::harness
