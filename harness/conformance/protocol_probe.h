#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "harness/simulator/process_simulator.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {

/// One process of a simulator, asked one request at a time, every one of them within a limit.
/// Nothing is started again: a request that is not answered by the protocol ends it.
class ProtocolProbe {
 public:
  /// `limits` has the command, all limits and the stop flag.
  explicit ProtocolProbe(const ProcessOptions& limits);

  bool is_alive() const { return child_ != nullptr; }
  /// The reason why it is not alive, with the end of its standard error.
  const std::string& trouble() const { return trouble_; }
  double wall_s() const { return wall_s_; }  // of the last request

  /// None: it is lost, and `trouble` says why. `unknown_field`: the request has a member that no
  /// version of the protocol knows.
  std::optional<ReplyBody> ask(RequestBody body, double timeout_s, bool unknown_field = false);
  /// Ends its input and waits: how it ended by itself, or none if it had to be killed.
  std::optional<std::string> ended_by_itself(double timeout_s);

 private:
  void lose(std::string why);

  ProcessOptions limits_;
  std::unique_ptr<ChildProcess> child_;
  std::string trouble_;
  double wall_s_ = 0.0;
  std::int64_t next_id_ = 1;
};

}  // namespace parallax::harness
