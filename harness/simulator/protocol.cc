#include "harness/simulator/protocol.h"

#include <cmath>
#include <optional>
#include <utility>

#include "compiler/base/json.h"
#include "harness/recording/scene_json.h"
#include "harness/simulator/motion_json.h"

namespace parallax::harness {
namespace {

using Json = nlohmann::json;

/// Reads typed fields and keeps the first thing that was wrong, so that callers read straight on.
class FieldReader {
 public:
  explicit FieldReader(std::string code) : code_(std::move(code)) {}

  bool failed() const { return failed_; }
  Malformed error() const { return error_; }

  void fail(const std::string& message) {
    if (failed_) return;
    failed_ = true;
    error_.code = code_;
    error_.message = message;
  }

  /// The member `name` of `object`, or null; a required one that is missing is an error.
  const Json* member(const Json& object, const char* name, bool required) {
    const auto found = object.find(name);
    if (found != object.end()) return &*found;
    if (required) fail("`" + std::string(name) + "` is missing");
    return nullptr;
  }

  const Json* object(const Json& parent, const char* name, bool required) {
    const Json* json = member(parent, name, required);
    if (json == nullptr || json->is_object()) return json;
    fail("`" + std::string(name) + "` is not an object");
    return nullptr;
  }

  std::string string(const Json& parent, const char* name, bool required = true) {
    const Json* json = member(parent, name, required);
    if (json == nullptr) return {};
    if (auto value = base::json_as<std::string>(*json)) return *std::move(value);
    fail("`" + std::string(name) + "` is not a string");
    return {};
  }

  double number(const Json& parent, const char* name, bool required = true) {
    const Json* json = member(parent, name, required);
    if (json == nullptr) return 0.0;
    if (auto value = base::json_as<double>(*json)) return *std::move(value);
    fail("`" + std::string(name) + "` is not a number");
    return 0.0;
  }

  std::int64_t integer(const Json& parent, const char* name) {
    const Json* json = member(parent, name, true);
    if (json == nullptr) return 0;
    if (auto value = base::json_as<std::int64_t>(*json)) return *std::move(value);
    fail("`" + std::string(name) + "` is not an integer");
    return 0;
  }

  bool boolean(const Json& parent, const char* name, bool required = true) {
    const Json* json = member(parent, name, required);
    if (json == nullptr) return false;
    if (auto value = base::json_as<bool>(*json)) return *std::move(value);
    fail("`" + std::string(name) + "` is not a boolean");
    return false;
  }

  State state(const Json& object) {
    State state;
    for (const auto& [name, value] : object.items()) {
      if (auto plain = value_of(value)) {
        state.emplace(name, *std::move(plain));
      } else {
        fail("`" + name + "` is neither boolean, number nor string");
      }
    }
    return state;
  }

  static std::optional<Value> value_of(const Json& json) {
    if (json.is_boolean()) return Value(json.get<bool>());
    if (json.is_string()) return Value(json.get<std::string>());
    if (const auto integer = base::json_as<std::int64_t>(json)) return Value(*integer);
    if (json.is_number()) return Value(json.get<double>());  // of an integer beyond that, too
    return std::nullopt;
  }

 private:
  std::string code_;
  bool failed_ = false;
  Malformed error_;
};

std::optional<std::int64_t> id_of(const Json& json) {
  const auto found = json.find("id");
  return found == json.end() ? std::nullopt : base::json_as<std::int64_t>(*found);
}

Malformed malformed(std::string code, std::string message, std::optional<std::int64_t> id = {}) {
  return Malformed{std::move(code), std::move(message), id.value_or(0), id.has_value()};
}

HelloRequest read_hello(FieldReader& reader, const Json& params) {
  HelloRequest hello;
  const Json* versions = reader.member(params, "protocol", true);
  if (versions == nullptr) return hello;
  hello.protocols.clear();
  if (!versions->is_array()) {
    reader.fail("`protocol` is not a list of versions");
    return hello;
  }
  for (const Json& version : *versions) {
    if (const auto number = base::json_as<std::int64_t>(version)) {
      hello.protocols.push_back(*number);
    } else {
      reader.fail("`protocol` is not a list of versions");
    }
  }
  return hello;
}

ResetRequest read_reset(FieldReader& reader, const Json& params) {
  ResetRequest reset;
  if (const Json* state = reader.object(params, "state", true)) reset.state = reader.state(*state);
  const Json* seed = reader.member(params, "seed", true);
  if (seed == nullptr) return reset;
  if (seed->is_number_unsigned()) {
    reset.seed = seed->get<std::uint64_t>();
  } else {
    reader.fail("`seed` is not an integer from 0 to 2^64 - 1");
  }
  reset.record_interval_s = reader.number(params, "pose_interval", false);
  return reset;
}

ActRequest read_act(FieldReader& reader, const Json& params) {
  ActRequest act;
  act.action = reader.string(params, "action");
  if (const Json* args = reader.object(params, "args", false)) act.arguments = reader.state(*args);
  act.sim_time_limit_s = reader.number(params, "sim_time_limit");
  if (act.sim_time_limit_s < 0.0) reader.fail("`sim_time_limit` is negative");
  return act;
}

RequestBody read_request_body(FieldReader& reader, const Json& json) {
  const std::string method = reader.string(json, "method");
  if (method == "observe") return ObserveRequest{};
  if (method == "close") return CloseRequest{};
  if (method == "describe") return DescribeRequest{};
  if (method != "hello" && method != "reset" && method != "act") return UnknownRequest{method};
  const Json* params = reader.object(json, "params", true);
  if (params == nullptr) return UnknownRequest{method};
  if (method == "hello") return read_hello(reader, *params);
  if (method == "reset") return read_reset(reader, *params);
  return read_act(reader, *params);
}

std::vector<ActionArgument> read_arguments(FieldReader& reader, const Json& list) {
  std::vector<ActionArgument> arguments;
  if (!list.is_array()) reader.fail("`args` of an action is not a list");
  for (const Json& item : list) {
    if (!item.is_object()) {
      reader.fail("an element of `args` is not an object");
      break;
    }
    ActionArgument argument{reader.string(item, "name"), reader.string(item, "unit", false),
                            reader.boolean(item, "required", false)};
    if (const Json* example = reader.member(item, "example", false)) {
      argument.example = FieldReader::value_of(*example);
    }
    arguments.push_back(std::move(argument));
  }
  return arguments;
}

/// `params` and `actions`, of `hello` and of `describe`.
void read_world(FieldReader& reader, const Json& result, SimulatorInfo& info) {
  const Json* params = reader.member(result, "params", true);
  const Json* actions = reader.member(result, "actions", true);
  if (params == nullptr || actions == nullptr) return;
  if (!params->is_array() || !actions->is_array()) {
    return reader.fail("`params` and `actions` are not lists");
  }
  for (const Json& item : *params) {
    if (!item.is_object()) return reader.fail("an element of `params` is not an object");
    Parameter parameter{reader.string(item, "name"), reader.string(item, "unit", false),
                        reader.boolean(item, "settable", false)};
    if (item.contains("lower")) parameter.lower = reader.number(item, "lower");
    if (item.contains("upper")) parameter.upper = reader.number(item, "upper");
    info.parameters.push_back(std::move(parameter));
  }
  for (const Json& item : *actions) {  // a name, or an object that has one
    info.actions.push_back(item.is_string()   ? item.get<std::string>()
                           : item.is_object() ? reader.string(item, "name")
                                              : std::string());
    if (info.actions.back().empty()) return reader.fail("an element of `actions` has no name");
    if (item.is_object() && reader.boolean(item, "instant", false)) {
      info.instant_actions.push_back(info.actions.back());
    }
    if (const Json* args = item.is_object() ? reader.member(item, "args", false) : nullptr) {
      info.arguments[info.actions.back()] = read_arguments(reader, *args);
    }
  }
}

/// A name, or a number as JSON-RPC has it.
std::string read_code(FieldReader& reader, const Json& error) {
  const Json* code = reader.member(error, "code", false);
  const auto number = code == nullptr ? std::nullopt : base::json_as<std::int64_t>(*code);
  return number ? std::to_string(*number) : reader.string(error, "code");
}

HelloReply read_info(FieldReader& reader, const Json& result) {
  HelloReply hello;
  hello.protocol = reader.integer(result, "protocol");
  if (hello.protocol != kProtocolVersion) reader.fail("`protocol` is no version that was offered");
  hello.info.name = reader.string(result, "name");
  hello.info.version = reader.string(result, "version", false);
  hello.info.determinism = reader.string(result, "determinism", false);
  if (hello.info.determinism.empty()) hello.info.determinism = "none";
  hello.info.seeds = reader.boolean(result, "seeds", false);
  hello.info.timestep_s = reader.number(result, "time_step", false);
  // A faulty scene is ignored: motion is recorded for people alone.
  std::string unread;
  if (const Json* scene = reader.member(result, "pose", false)) {
    hello.info.scene = scene_from_text(base::json_text(*scene), unread);
  }
  if (const Json* able = reader.member(result, "capabilities", false)) {
    if (!able->is_array()) reader.fail("`capabilities` is not a list");
    for (const Json& item : *able) {
      if (!item.is_string()) reader.fail("an element of `capabilities` is not a word");
      if (item.is_string()) hello.info.capabilities.push_back(item.get<std::string>());
    }
  }
  hello.info.min_real_time_factor = reader.number(result, "min_real_time_factor", false);
  const double factor = hello.info.min_real_time_factor;
  if (factor != 0.0 && !(factor >= 1e-4 && factor <= 1e6)) {
    reader.fail("`min_real_time_factor` is not within 0.0001 to 1000000");
  }
  read_world(reader, result, hello.info);
  return hello;
}

OutcomeReply read_outcome(FieldReader& reader, const Json& result) {
  OutcomeReply reply;
  const std::string word = reader.string(result, "status");
  reply.outcome.status = sim_status_from(word);
  if (!reader.failed() && to_string(reply.outcome.status) != word) {
    reader.fail("no status `" + word + "`");
  }
  reply.outcome.reason = reader.string(result, "reason", false);
  reply.outcome.object = reader.string(result, "object", false);
  reply.outcome.sim_time_s = reader.number(result, "sim_time", false);
  // Sums of it are printed, so a time beyond all simulations is nonsense too.
  const bool sane = reply.outcome.sim_time_s >= 0.0 && reply.outcome.sim_time_s <= 1e9;
  if (!sane) reader.fail("`sim_time` is not within 0 to 1e9 s");
  if (const Json* margins = reader.object(result, "margins", false)) {
    reply.outcome.margins = reader.state(*margins);
    for (const auto& [name, value] : reply.outcome.margins) {
      if (!std::holds_alternative<double>(value) && !std::holds_alternative<std::int64_t>(value)) {
        reader.fail("margin `" + name + "` is not a number");
      }
    }
  }
  read_motion(result, reply);
  return reply;
}

ObserveReply read_observed(FieldReader& reader, const Json& result) {
  ObserveReply reply;
  if (const Json* state = reader.object(result, "state", true)) reply.state = reader.state(*state);
  return reply;
}

/// Does it go on after that?
bool is_last(const SingleReply& reply) {
  if (std::holds_alternative<ErrorReply>(reply)) return true;
  const auto* outcome = std::get_if<OutcomeReply>(&reply);
  if (outcome == nullptr) return false;
  const auto status = outcome->outcome.status;
  return status != SimStatus::kOk && status != SimStatus::kFailed &&
         status != SimStatus::kTruncated;
}

SingleReply read_single(FieldReader& reader, const Json& item, bool is_observation) {
  if (const Json* error = reader.object(item, "error", false)) {
    return ErrorReply{read_code(reader, *error), reader.string(*error, "message", false)};
  }
  const Json* result = reader.object(item, "result", true);
  if (result == nullptr) return ErrorReply{};
  if (is_observation) return read_observed(reader, *result);
  return read_outcome(reader, *result);
}

PerformReply read_performed(FieldReader& reader, const Json& result, const PerformRequest& asked) {
  PerformReply reply;
  const Json* replies = reader.member(result, "replies", true);
  if (replies == nullptr) return reply;
  if (!replies->is_array() || replies->empty() || replies->size() > asked.requests.size()) {
    reader.fail("`replies` is no list of an answer to each request");
    return reply;
  }
  for (std::size_t i = 0; i < replies->size(); ++i) {
    if (!(*replies)[i].is_object()) reader.fail("an element of `replies` is not an object");
    if (reader.failed()) return reply;
    const bool is_observation = std::holds_alternative<ObserveRequest>(asked.requests[i]);
    reply.replies.push_back(read_single(reader, (*replies)[i], is_observation));
    if (is_last(reply.replies.back()) && i + 1 < replies->size()) {
      reader.fail("`replies` goes on after an answer that is the last one");
    }
  }
  if (reply.replies.size() < asked.requests.size() && !is_last(reply.replies.back())) {
    reader.fail("`replies` breaks off");
  }
  return reply;
}

ReplyBody read_result(FieldReader& reader, const Json& result, const Request& asked) {
  if (std::holds_alternative<HelloRequest>(asked.body)) return read_info(reader, result);
  if (std::holds_alternative<CloseRequest>(asked.body)) return CloseReply{};
  if (std::holds_alternative<ObserveRequest>(asked.body)) return read_observed(reader, result);
  if (const auto* perform = std::get_if<PerformRequest>(&asked.body)) {
    return read_performed(reader, result, *perform);
  }
  if (std::holds_alternative<DescribeRequest>(asked.body)) {
    DescribeReply reply;
    read_world(reader, result, reply.info);
    return reply;
  }
  return read_outcome(reader, result);
}

}  // namespace

std::string first_not_finite(const State& state) {
  for (const auto& [name, value] : state) {
    const double* number = std::get_if<double>(&value);
    if (number != nullptr && !std::isfinite(*number)) return name;
  }
  return {};
}

std::variant<Request, Malformed> decode_request(std::string_view line) {
  if (line.size() > kMaxLineBytes) return malformed("line_too_long", "line longer than 1 MiB");
  const Json json = base::parse_json(line);
  if (json.is_discarded()) return malformed("parse_error", "the line is not JSON");
  if (!json.is_object()) return malformed("invalid_request", "the line is not an object");
  const std::optional<std::int64_t> id = id_of(json);
  if (!id) return malformed("invalid_request", "`id` is missing or not an integer");

  FieldReader reader("invalid_params");
  Request request{*id, read_request_body(reader, json)};
  if (!reader.failed()) return request;
  return malformed(reader.error().code, reader.error().message, id);
}

std::variant<ReplyBody, Malformed> decode_reply(std::string_view line, const Request& asked) {
  if (line.size() > kMaxLineBytes) return malformed("line_too_long", "line longer than 1 MiB");
  const Json json = base::parse_json(line);
  if (json.is_discarded()) return malformed("parse_error", "the line is not JSON");
  if (!json.is_object()) return malformed("invalid_reply", "the line is not an object");

  FieldReader reader("invalid_reply");
  const std::optional<std::int64_t> id = id_of(json);
  const Json* error = reader.object(json, "error", false);
  if (id != asked.id) {
    const std::string what =
        error != nullptr ? " (" + reader.string(*error, "message", false) + ")" : std::string();
    return malformed("invalid_reply",
                     "the reply to request " + std::to_string(asked.id) + " carries " +
                         (id ? "id " + std::to_string(*id) : std::string("no id")) + what,
                     id);
  }
  if (error != nullptr) {
    ErrorReply reply{read_code(reader, *error), reader.string(*error, "message", false)};
    if (!reader.failed()) return ReplyBody(std::move(reply));
  }
  const Json* result = reader.object(json, "result", true);
  if (result != nullptr) {
    ReplyBody reply = read_result(reader, *result, asked);
    if (!reader.failed()) return reply;
  }
  return malformed(reader.error().code, reader.error().message, id);
}

std::variant<State, Malformed> decode_state(std::string_view text) {
  const Json json = base::parse_json(text);
  if (json.is_discarded()) return malformed("parse_error", "the text is not JSON");
  if (!json.is_object()) return malformed("parse_error", "the text is not an object");
  FieldReader reader("parse_error");
  State state = reader.state(json);
  if (reader.failed()) return reader.error();
  return state;
}

}  // namespace parallax::harness
