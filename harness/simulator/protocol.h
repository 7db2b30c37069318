#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// The simulator protocol, version 1: one JSON object per line, requests from the harness, one
/// reply each. Numbers are written as the shortest decimals that read back to the same bits.
inline constexpr std::int64_t kProtocolVersion = 1;
inline constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20U;  // without the newline

struct HelloRequest {
  std::vector<std::int64_t> protocols = {kProtocolVersion};
};
struct ResetRequest {
  State state;
  std::uint64_t seed = 0;
  double record_interval_s = 0.0;  // Simulator::record_motion
};
struct ActRequest {
  std::string action;
  State arguments;
  double sim_time_limit_s = 0.0;
};
struct ObserveRequest {};
struct CloseRequest {};
struct DescribeRequest {};
/// A sequence of requests in one: a reset, then observations and acts. It ends at an answer that is
/// no observation and not ok, failed or truncated.
struct PerformRequest {
  std::vector<std::variant<ResetRequest, ActRequest, ObserveRequest>> requests;
};
/// A well-formed request of a method that this version does not know.
struct UnknownRequest {
  std::string method;
};

using RequestBody = std::variant<HelloRequest, ResetRequest, ActRequest, ObserveRequest,
                                 CloseRequest, DescribeRequest, UnknownRequest, PerformRequest>;

/// `id` is the client's, counted up; a reply carries the id of its request.
struct Request {
  std::int64_t id = 0;
  RequestBody body;
};

/// The other side said no: `code` is parse_error, invalid_request, invalid_params, unsupported,
/// incorrect_state, line_too_long, not_finite or internal; or a number, as JSON-RPC has them.
struct ErrorReply {
  std::string code;
  std::string message;
};
/// The other side understood us and says no: the scenario's fault, not a loss.
bool is_refusal(const ErrorReply& error);
struct HelloReply {
  std::int64_t protocol = kProtocolVersion;
  SimulatorInfo info;
};
/// Poses of bodies at one time, from a simulator that does not pack frames itself.
struct PlainFrame {
  double time_s = 0.0;  // simulated, since reset
  std::vector<std::pair<std::string, Pose>> poses;
  /// The bodies that hang in grippers, all of them; none: as before.
  std::optional<std::vector<std::pair<std::string, std::string>>> held;
};
/// The reply to reset and act. `outcome.motion.fault` names a fault of the motion, if there is one;
/// the reply is good all the same.
struct OutcomeReply {
  Outcome outcome;
  std::vector<PlainFrame> frames = {};
};
struct ObserveReply {
  State state;
};
struct CloseReply {};
/// The contents of the world: parameters, actions and their arguments, and nothing else of `info`.
struct DescribeReply {
  SimulatorInfo info;
};

using SingleReply = std::variant<ErrorReply, OutcomeReply, ObserveReply>;
struct PerformReply {
  std::vector<SingleReply> replies;  // to the first requests, at least one, in their order
};

using ReplyBody = std::variant<ErrorReply, HelloReply, OutcomeReply, ObserveReply, CloseReply,
                               DescribeReply, PerformReply>;

/// A line that is not the protocol: the harness counts the simulator as lost.
struct Malformed {
  std::string code;     // as ErrorReply::code
  std::string message;  // "byte 17: ..." or "`result.status` is missing"
  std::int64_t id = 0;  // of the request, where it could be read
  bool has_id = false;
};

/// One line each, without the newline. Values must be finite: see `first_not_finite`.
std::string encode_request(const Request& request);
std::string encode_reply(std::int64_t id, const ReplyBody& reply);
/// The answer to a line from which no id could be read.
std::string encode_error_without_id(const ErrorReply& error);

/// The worker's side. Unknown fields are ignored, missing or ill-typed ones are not.
std::variant<Request, Malformed> decode_request(std::string_view line);

/// The client's side: the reply to `asked`. Malformed when the line is no JSON object, carries
/// another id, lacks a field, has a field of the wrong type, an unknown status, or a value that is
/// neither boolean, finite number nor string. An error reply is well-formed.
std::variant<ReplyBody, Malformed> decode_reply(std::string_view line, const Request& asked);

/// Name of the first value that is NaN or infinite, which JSON cannot say; empty if none is.
std::string first_not_finite(const State& state);

/// A state as one JSON object, and back; for journals and record files.
std::string encode_state(const State& state);
std::variant<State, Malformed> decode_state(std::string_view text);

}  // namespace parallax::harness
