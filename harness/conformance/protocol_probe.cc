#include "harness/conformance/protocol_probe.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/base/clock_time.h"
#include "harness/simulator/error_tail.h"

namespace parallax::harness {
namespace {

using ProbeClock = ChildProcess::Clock;

std::string_view method_of(const RequestBody& body) {
  static constexpr std::string_view kMethods[] = {"hello", "reset",    "act",           "observe",
                                                  "close", "describe", "no-such-method"};
  return kMethods[body.index()];
}

/// The beginning of a line that is not the protocol, fit to be shown.
std::string shown_start(std::string_view line) {
  constexpr std::size_t kShown = 60;
  std::string shown;
  for (const char c : line.substr(0, kShown)) shown += c >= ' ' && c <= '~' ? c : '?';
  return line.size() > kShown ? shown + "..." : shown;
}

/// JSON has no such words outside of texts; writers that are careless with numbers have.
bool says_not_finite(std::string_view line) {
  for (const auto* word : {":NaN", ": NaN", ":nan", ": nan", "Infinity", ":inf", ": inf"}) {
    if (line.find(word) != std::string_view::npos) return true;
  }
  return false;
}

}  // namespace

ProtocolProbe::ProtocolProbe(const ProcessOptions& limits) : limits_(limits) {
  child_ = std::make_unique<ChildProcess>(limits.command, limits.memory_mb, limits.stop);
  if (child_->start_error().empty()) return;
  trouble_ = child_->start_error();
  child_.reset();
}

void ProtocolProbe::lose(std::string why) {
  constexpr double kGraceS = 0.2;
  const auto ending = child_->end(base::from_now(kGraceS));
  trouble_ = std::move(why) + fmt::format(" ({})", ending);
  trouble_ += error_tail_words(child_->error_tail());
  child_.reset();
}

std::optional<ReplyBody> ProtocolProbe::ask(RequestBody body, double timeout_s,
                                            bool unknown_field) {
  if (!child_) return std::nullopt;
  const Request request{next_id_++, std::move(body)};
  const auto name = method_of(request.body);
  auto line = encode_request(request);
  if (unknown_field) line.insert(1, R"("x-unknown":{"of":[1,"a later version"]},)");
  const auto begun = ProbeClock::now();
  const auto deadline = base::from_now(timeout_s);
  if (!child_->write_line(line, deadline)) {
    lose(fmt::format("it did not take `{}`", name));
    return std::nullopt;
  }
  std::string answer;
  const auto wait = child_->read_line(answer, deadline, kMaxLineBytes);
  wall_s_ = std::chrono::duration<double>(ProbeClock::now() - begun).count();
  std::string why;
  switch (wait) {
    case ChildProcess::Wait::kLine:
      break;
    case ChildProcess::Wait::kTimeout:
      why = fmt::format("no reply to `{}` within {:g} s", name, timeout_s);
      break;
    case ChildProcess::Wait::kEnd:
      why = fmt::format("it ended during `{}`", name);
      break;
    case ChildProcess::Wait::kTooLong:
      why = fmt::format("its reply to `{}` is longer than {} bytes", name, kMaxLineBytes);
      break;
    case ChildProcess::Wait::kTooMuchMemory:
      why = fmt::format("more than {} MiB of memory during `{}`", limits_.memory_mb, name);
      break;
    case ChildProcess::Wait::kStopped:
      why = "interrupted";
      break;
  }
  if (!why.empty()) {
    lose(std::move(why));
    return std::nullopt;
  }
  auto reply = decode_reply(answer, request);
  if (auto* good = std::get_if<ReplyBody>(&reply)) return std::move(*good);
  const auto& malformed = std::get<Malformed>(reply);
  lose(fmt::format("malformed reply to `{}`: {}{}: `{}`", name, malformed.message,
                   says_not_finite(answer) ? " (NaN and Infinity are no JSON)" : "",
                   shown_start(answer)));
  return std::nullopt;
}

std::optional<std::string> ProtocolProbe::ended_by_itself(double timeout_s) {
  if (!child_) return std::nullopt;
  const auto begun = ProbeClock::now();
  const auto deadline = base::from_now(timeout_s);
  auto ending = child_->end(deadline);
  wall_s_ = std::chrono::duration<double>(ProbeClock::now() - begun).count();
  child_.reset();
  if (ProbeClock::now() >= deadline) return std::nullopt;
  return ending;
}

}  // namespace parallax::harness
