#include "harness/cluster/worker_link.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/base/clock_time.h"
#include "compiler/base/utf8.h"
#include "harness/simulator/error_tail.h"
#include "harness/simulator/worker.h"

namespace parallax::harness {
namespace {

constexpr double kEndGraceS = 0.2;  // for its own end, which says more than a signal of ours

}  // namespace

WorkerLink::WorkerLink(const std::vector<std::string>& command, Limits limits,
                       const std::atomic<bool>& interrupted)
    : child_(command, 0, &interrupted), limits_(limits) {}

std::variant<ProgramIdentity, std::string> WorkerLink::greet() {
  if (!child_.start_error().empty()) return child_.start_error();
  const auto deadline = base::from_now(limits_.start_s);
  std::size_t bytes = 0;
  for (std::string line;;) {
    switch (child_.read_line(line, deadline, kMostBannerBytes)) {
      case ChildProcess::Wait::kLine:
        break;
      case ChildProcess::Wait::kTimeout:
        return fmt::format("no handshake within {} s", limits_.start_s);
      case ChildProcess::Wait::kEnd:
      case ChildProcess::Wait::kTooMuchMemory:  // nobody bounds it
        return std::string("it ended before the handshake");
      case ChildProcess::Wait::kTooLong:
        return fmt::format("a line of more than {} bytes before the handshake", kMostBannerBytes);
      case ChildProcess::Wait::kStopped:
        return std::string("interrupted");
    }
    if (auto identity = parse_greeting(line)) return *std::move(identity);
    while (line.ends_with('\r')) line.pop_back();
    bytes += line.size();
    if (line.empty()) continue;
    if (banner_.lines++ == 0) banner_.first = base::with_invalid_utf8_replaced(line);
    if (banner_.lines > kMostBannerLines || bytes > kMostBannerBytes) {
      return fmt::format("more than {} lines or {} bytes before the handshake; the first: {}",
                         kMostBannerLines, kMostBannerBytes, banner_.first);
    }
  }
}

std::variant<ReplyBody, std::string> WorkerLink::ask(RequestBody body) {
  const Request request{next_id_++, std::move(body)};
  if (!child_.write_line(encode_request(request), base::from_now(limits_.silence_s))) {
    return std::string("it took no request");
  }
  for (std::string line;;) {
    // Each sign of life starts the wait anew: how long a request may take the worker knows.
    switch (child_.read_line(line, base::from_now(limits_.silence_s), kMaxLineBytes)) {
      case ChildProcess::Wait::kLine:
        break;
      case ChildProcess::Wait::kTimeout:
        return fmt::format("no sign of life for {} s", limits_.silence_s);
      case ChildProcess::Wait::kEnd:
      case ChildProcess::Wait::kTooMuchMemory:
        return std::string("it ended during a request");
      case ChildProcess::Wait::kTooLong:
        return fmt::format("its reply is longer than {} bytes", kMaxLineBytes);
      case ChildProcess::Wait::kStopped:
        return std::string("interrupted");
    }
    if (is_beat(line)) continue;
    auto reply = decode_reply(line, request);
    if (const auto* malformed = std::get_if<Malformed>(&reply)) {
      return fmt::format("malformed reply: {}", malformed->message);
    }
    return std::get<ReplyBody>(std::move(reply));
  }
}

std::string WorkerLink::lose(std::string reason) {
  if (!child_.start_error().empty()) return reason;
  reason += fmt::format(" ({})", child_.end(base::from_now(kEndGraceS)));
  return reason + error_tail_words(child_.error_tail());
}

}  // namespace parallax::harness
