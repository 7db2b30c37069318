#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"

namespace parallax::harness {

/// The head line of a recording of a simulator's requests and replies. Lines of JSON follow, one
/// for each request. Several processes may write one file: they append whole lines.
inline constexpr std::string_view kAdapterRecordingHead = R"({"parallax_adapter_recording":1})";

/// Passes requests from `in_fd` to the command and its replies to `out_fd`, and appends both to
/// `record_fd`. The end of the input ends the command. The exit code of the command, or 1 when a
/// descriptor failed or a line was too long.
int record_adapter(const std::vector<std::string>& command, int in_fd, int out_fd, int record_fd);

/// A recording as a simulator: answers a request as it was answered after the same reset and the
/// same actions. What was answered more than once is given in that order, the last one for ever.
class RecordedAdapter {
 public:
  /// Reports kWrongKindOfFile with the line.
  static base::Result<RecordedAdapter> read(const std::string& path, base::DiagnosticSink& sink);

  /// The reply, without a newline; none: here the simulator ended.
  std::optional<std::string> answer(std::string_view request);
  std::size_t size() const { return count_; }

 private:
  struct Reply {
    std::string text;  // with the id that it had
    bool is_json = true, has_ended = false;
  };
  /// The key of a reply: the digest of the requests since the reset, and the request itself.
  using Key = std::pair<std::uint64_t, std::string>;

  std::map<Key, std::deque<Reply>> replies_;
  std::uint64_t done_ = 0;
  std::size_t count_ = 0;
};

/// Answers requests of `in_fd` on `out_fd` until `close`, the end of the input, or of the
/// recording. 0, or 1 where the recorded simulator ended without an answer.
int serve_recording(RecordedAdapter& adapter, int in_fd, int out_fd);

}  // namespace parallax::harness
