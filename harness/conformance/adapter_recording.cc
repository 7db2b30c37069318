#include "harness/conformance/adapter_recording.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "compiler/base/codes/files.h"
#include "compiler/base/descriptor.h"
#include "compiler/base/file_io.h"
#include "compiler/base/hash.h"
#include "compiler/base/json.h"
#include "compiler/base/subprocess.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

/// Room for two lines of the protocol, quoted as texts.
constexpr std::size_t kLongestRecord = 16 * kMaxLineBytes;

/// Lines of a descriptor, at most one over what the protocol allows.
class DescriptorLines {
 public:
  explicit DescriptorLines(int fd) : fd_(fd) {}

  /// False at the end, after an error, or where a line is too long.
  bool next(std::string& line) {
    for (;;) {
      const auto newline = buffer_.find('\n', searched_);
      if (newline != std::string::npos) {
        line.assign(buffer_, 0, newline);
        buffer_.erase(0, newline + 1);
        searched_ = 0;
        return true;
      }
      searched_ = buffer_.size();
      if (buffer_.size() > kMaxLineBytes + 1) return false;
      std::array<char, 1 << 16> chunk{};
      const auto count = ::read(fd_, chunk.data(), chunk.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      buffer_.append(chunk.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  int fd_;
  std::string buffer_;
  std::size_t searched_ = 0;
};

/// As it is where it is JSON, else as a text of the member NAME_text.
std::string member_of(const char* name, const std::string& line) {
  if (!base::parse_json(line).is_discarded()) return fmt::format(R"("{}":{})", name, line);
  return fmt::format(R"("{}_text":{})", name, base::json_quoted(line));
}

/// A request without its number, and its method.
struct AskedRequest {
  std::string method, text;
  nlohmann::json id;
};

AskedRequest asked_of(nlohmann::json request) {
  AskedRequest asked;
  if (!request.is_object()) return asked;
  if (const auto* method = base::json_member(request, "method")) {
    asked.method = base::json_as<std::string>(*method).value_or("");
  }
  const auto id = request.find("id");
  if (id != request.end()) {
    asked.id = *id;
    request.erase(id);
  }
  asked.text = base::json_text(request);
  return asked;
}

bool is_of_a_run(const std::string& method) { return method == "act" || method == "observe"; }

/// The digest of the requests of a run so far, after one more request.
std::uint64_t done_after(std::uint64_t done, const AskedRequest& asked) {
  if (asked.method == "reset" || asked.method == "perform") return base::fnv1a64(asked.text);
  return is_of_a_run(asked.method) ? base::fnv1a64(asked.text, done) : done;
}

/// Writes to standard error, as a simulator does. A failed write loses the text.
void tell(std::string_view text) { (void)base::write_all(STDERR_FILENO, base::shown_lines(text)); }

}  // namespace

int record_adapter(const std::vector<std::string>& command, int in_fd, int out_fd, int record_fd) {
  base::Pipe to, from;
  if (!to.valid() || !from.valid()) return 1;
  base::SpawnOptions options;
  options.input = to.read.get();
  options.output = from.write.get();
  options.ends_with_us = true;
  const auto child = base::spawn(command, options);
  if (child.pid < 0) {
    tell(fmt::format("cannot start `{}`: {}\n", base::command_text(command),
                     std::strerror(child.error)));
    return 127;
  }
  to.read.close();
  from.write.close();
  DescriptorLines requests(in_fd), replies(from.read.get());
  bool failed = false;
  for (std::string request, reply; !failed && requests.next(request);) {
    failed = !base::write_all(to.write.get(), request + '\n');
    const bool answered = !failed && replies.next(reply);
    const auto record =
        fmt::format("{{\"session\":{},{},{}}}\n", ::getpid(), member_of("request", request),
                    answered ? member_of("reply", reply) : std::string(R"("ended":true)"));
    failed =
        !base::write_all(record_fd, record) || !answered || !base::write_all(out_fd, reply + '\n');
  }
  to.write.close();
  from.read.close();
  const int code = base::wait_for(child.pid);
  return code == 0 && failed ? 1 : code;
}

base::Result<RecordedAdapter> RecordedAdapter::read(const std::string& path,
                                                    base::DiagnosticSink& sink) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30U;
  const auto text = base::read_file(path, sink, kMostBytes);
  if (!text) return sink.already_reported();
  RecordedAdapter adapter;
  std::map<std::int64_t, std::uint64_t> done;  // by session
  std::int64_t number = 0;
  const auto wrong = [&](const char* why) {
    return sink.error_about(codes::kWrongKindOfFile, fmt::format("{}:{}", path, number), why,
                            "a recording of `parallax record`");
  };
  for (std::size_t begin = 0; begin < text->size();) {
    const auto end = text->find('\n', begin);
    if (end == std::string::npos) break;  // cut off while it was written
    const auto line = std::string_view(*text).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (number == 1) {
      if (line != kAdapterRecordingHead) return wrong("a file with another first line");
      continue;
    }
    if (line.size() > kLongestRecord) return wrong("a line that is too long");
    const auto json = base::parse_json(line);
    const auto* request = base::json_member(json, "request");
    const auto* session = base::json_member(json, "session");
    const auto whose = session == nullptr ? std::nullopt : base::json_as<std::int64_t>(*session);
    if (!whose) return wrong("a line without a `session`");
    if (request == nullptr) continue;  // what was asked was no JSON: nobody asks it again
    const auto asked = asked_of(*request);
    Reply reply;
    if (const auto* good = base::json_member(json, "reply")) {
      reply.text = base::json_text(*good);
    } else if (const auto* odd = base::json_member(json, "reply_text")) {
      reply.text = base::json_as<std::string>(*odd).value_or("");
      reply.is_json = false;
    } else {
      reply.has_ended = true;
    }
    auto& so_far = done[*whose];
    const auto before = is_of_a_run(asked.method) ? so_far : 0;
    adapter.replies_[{before, asked.text}].push_back(std::move(reply));
    so_far = done_after(so_far, asked);
    ++adapter.count_;
  }
  if (number == 0) return wrong("an empty file");
  return adapter;
}

std::optional<std::string> RecordedAdapter::answer(std::string_view request) {
  const auto asked = asked_of(base::parse_json(request));
  const auto before = is_of_a_run(asked.method) ? done_ : 0;
  done_ = done_after(done_, asked);
  const auto found = replies_.find({before, asked.text});
  if (found == replies_.end()) {
    const nlohmann::json error{
        {"id", asked.id},
        {"error",
         {{"code", "not_recorded"},
          {"message", fmt::format("the recording has no such `{}`", asked.method)}}}};
    return base::json_text(error);
  }
  const auto reply = found->second.front();
  if (found->second.size() > 1) found->second.pop_front();
  if (reply.has_ended) return std::nullopt;
  if (!reply.is_json) return reply.text;
  auto json = base::parse_json(reply.text);
  if (json.is_object()) json["id"] = asked.id;
  return base::json_text(json);
}

int serve_recording(RecordedAdapter& adapter, int in_fd, int out_fd) {
  DescriptorLines requests(in_fd);
  for (std::string request; requests.next(request);) {
    const auto reply = adapter.answer(request);
    if (!reply) {
      tell("here the recorded simulator ended\n");
      return 1;
    }
    if (!base::write_all(out_fd, *reply + '\n')) return 1;
    if (asked_of(base::parse_json(request)).method == "close") return 0;
  }
  return 0;
}

}  // namespace parallax::harness
