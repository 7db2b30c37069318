#include "harness/simulator/worker.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <string>
#include <utility>

#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

/// Lines from a descriptor, without their newline.
class LineReader {
 public:
  enum class Event : std::uint8_t { kLine, kEnd, kTooLong, kError };

  explicit LineReader(int fd) : fd_(fd) {}

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
  int fd_;
  std::string buffer_;
  std::size_t searched_ = 0;
};

bool write_line(int fd, std::string line) {
  line.push_back('\n');
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t count = ::write(fd, line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    written += static_cast<std::size_t>(count);
  }
  return true;
}

struct Answer {
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

  Answer operator()(const HelloRequest& hello) const {
    if (std::find(hello.protocols.begin(), hello.protocols.end(), kProtocolVersion) ==
        hello.protocols.end()) {
      return {ErrorReply{"unsupported", "this simulator speaks protocol 1"}};
    }
    return {HelloReply{kProtocolVersion, simulator.info()}};
  }
  Answer operator()(const ResetRequest& reset) const {
    simulator.record_motion(reset.record_interval_s);
    Outcome outcome = simulator.reset(reset.state, reset.seed);
    reset_done = outcome.status == SimStatus::kOk;
    return {OutcomeReply{std::move(outcome)}};
  }
  Answer operator()(const ActRequest& act) const {
    if (!reset_done) return {ErrorReply{"incorrect_state", "act before a successful reset"}};
    return {OutcomeReply{simulator.act(act.action, act.arguments, act.sim_time_limit_s)}};
  }
  Answer operator()(const ObserveRequest&) const {
    if (!reset_done) return {ErrorReply{"incorrect_state", "observe before a successful reset"}};
    return {ObserveReply{simulator.observe()}};
  }
  Answer operator()(const CloseRequest&) const { return {CloseReply{}, true}; }
  Answer operator()(const DescribeRequest&) const { return {DescribeReply{simulator.info()}}; }
  Answer operator()(const UnknownRequest& unknown) const {
    return {ErrorReply{"unsupported", "no method `" + unknown.method + "`"}};
  }
};

}  // namespace

int serve(Simulator& simulator, int in_fd, int out_fd) {
  LineReader reader(in_fd);
  std::string line;
  bool reset_done = false;
  for (;;) {
    switch (reader.next(line)) {
      case LineReader::Event::kEnd:
        return 0;
      case LineReader::Event::kError:
        return 1;
      case LineReader::Event::kTooLong:
        write_line(out_fd, encode_error_without_id({"line_too_long", "line longer than 1 MiB"}));
        return 1;
      case LineReader::Event::kLine:
        break;
    }
    const auto decoded = decode_request(line);
    if (const auto* bad = std::get_if<Malformed>(&decoded)) {
      const ErrorReply error{bad->code, bad->message};
      if (!write_line(out_fd, bad->has_id ? encode_reply(bad->id, error)
                                          : encode_error_without_id(error))) {
        return 1;
      }
      continue;
    }
    const Request& request = std::get<Request>(decoded);
    Answer answer = std::visit(Dispatcher{simulator, reset_done}, request.body);
    if (!write_line(out_fd, encode_reply(request.id, checked(std::move(answer.reply))))) return 1;
    if (answer.last) return 0;
  }
}

}  // namespace parallax::harness
