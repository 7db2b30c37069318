#include <utility>

#include "compiler/base/json.h"
#include "harness/recording/bytes.h"
#include "harness/recording/scene_json.h"
#include "harness/simulator/protocol.h"
#include "harness/simulator/state_json.h"

// Requests and replies as lines of JSON.

namespace parallax::harness {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// One line. A name that is not UTF-8 becomes one that is, rather than an exception.
std::string line_of(const OrderedJson& json) { return base::json_text(json); }

OrderedJson error_to_json(const ErrorReply& error) {
  return OrderedJson{{"code", error.code}, {"message", error.message}};
}

OrderedJson arguments_to_json(const std::vector<ActionArgument>& arguments) {
  OrderedJson list = OrderedJson::array();
  for (const auto& argument : arguments) {
    OrderedJson json{
        {"name", argument.name}, {"unit", argument.unit}, {"required", argument.required}};
    if (argument.example) {
      json["example"] =
          std::visit([](const auto& plain) { return OrderedJson(plain); }, *argument.example);
    }
    list.push_back(std::move(json));
  }
  return list;
}

OrderedJson parameters_to_json(const SimulatorInfo& info) {
  OrderedJson parameters = OrderedJson::array();
  for (const Parameter& p : info.parameters) {
    OrderedJson json{{"name", p.name}, {"unit", p.unit}, {"settable", p.settable}};
    if (p.lower) json["lower"] = *p.lower;
    if (p.upper) json["upper"] = *p.upper;
    parameters.push_back(std::move(json));
  }
  return parameters;
}

OrderedJson actions_to_json(const SimulatorInfo& info) {
  OrderedJson actions = OrderedJson::array();
  for (const std::string& name : info.actions) {
    OrderedJson json{{"name", name}};
    const auto arguments = info.arguments.find(name);
    if (info.is_instant(name)) json["instant"] = true;
    if (arguments != info.arguments.end()) json["args"] = arguments_to_json(arguments->second);
    actions.push_back(std::move(json));
  }
  return actions;
}

OrderedJson info_to_json(std::int64_t protocol, const SimulatorInfo& info) {
  OrderedJson out{{"protocol", protocol},
                  {"name", info.name},
                  {"version", info.version},
                  {"determinism", info.determinism},
                  {"seeds", info.seeds},
                  {"time_step", info.timestep_s},
                  {"params", parameters_to_json(info)},
                  {"actions", actions_to_json(info)}};
  if (!info.capabilities.empty()) out["capabilities"] = OrderedJson(info.capabilities);
  if (info.min_real_time_factor > 0.0) out["min_real_time_factor"] = info.min_real_time_factor;
  if (info.scene) {
    // A world so large that it does not go in a line is simulated without recordings.
    const auto scene = scene_text(*info.scene);
    if (scene.size() < kMaxLineBytes / 2) out["pose"] = base::parse_ordered_json(scene);
  }
  return out;
}

OrderedJson outcome_to_json(const Outcome& outcome) {
  OrderedJson json{{"status", to_string(outcome.status)}};
  if (!outcome.reason.empty()) json["reason"] = outcome.reason;
  json["sim_time"] = outcome.sim_time_s;
  if (!outcome.margins.empty()) json["margins"] = state_json<OrderedJson>(outcome.margins);
  if (!outcome.object.empty()) json["object"] = outcome.object;
  if (!outcome.motion.frames.empty()) json["motion"] = base64(outcome.motion.frames);
  if (!outcome.motion.fault.empty()) json["motion_fault"] = outcome.motion.fault;
  return json;
}

struct RequestEncoder {
  OrderedJson& json;
  void operator()(const HelloRequest& hello) const {
    json["method"] = "hello";
    json["params"] = OrderedJson{{"protocol", OrderedJson(hello.protocols)}};
  }
  void operator()(const ResetRequest& reset) const {
    json["method"] = "reset";
    json["params"] =
        OrderedJson{{"state", state_json<OrderedJson>(reset.state)}, {"seed", reset.seed}};
    if (reset.record_interval_s > 0.0) json["params"]["pose_interval"] = reset.record_interval_s;
  }
  void operator()(const ActRequest& act) const {
    json["method"] = "act";
    json["params"] = OrderedJson{{"action", act.action},
                                 {"args", state_json<OrderedJson>(act.arguments)},
                                 {"sim_time_limit", act.sim_time_limit_s}};
  }
  void operator()(const ObserveRequest&) const { json["method"] = "observe"; }
  void operator()(const CloseRequest&) const { json["method"] = "close"; }
  void operator()(const DescribeRequest&) const { json["method"] = "describe"; }
  void operator()(const UnknownRequest& unknown) const { json["method"] = unknown.method; }
  void operator()(const PerformRequest& perform) const {
    OrderedJson list = OrderedJson::array();
    for (const auto& request : perform.requests) {
      std::visit(RequestEncoder{list.emplace_back(OrderedJson::object())}, request);
    }
    json["method"] = "perform";
    json["params"] = OrderedJson{{"requests", std::move(list)}};
  }
};

struct ReplyEncoder {
  OrderedJson& json;
  void operator()(const ErrorReply& error) const { json["error"] = error_to_json(error); }
  void operator()(const HelloReply& hello) const {
    json["result"] = info_to_json(hello.protocol, hello.info);
  }
  void operator()(const OutcomeReply& reply) const {
    json["result"] = outcome_to_json(reply.outcome);
  }
  void operator()(const ObserveReply& reply) const {
    json["result"] = OrderedJson{{"state", state_json<OrderedJson>(reply.state)}};
  }
  void operator()(const CloseReply&) const { json["result"] = OrderedJson{{"status", "ok"}}; }
  void operator()(const DescribeReply& reply) const {
    json["result"] = OrderedJson{{"params", parameters_to_json(reply.info)},
                                 {"actions", actions_to_json(reply.info)}};
  }
  void operator()(const PerformReply& reply) const {
    OrderedJson list = OrderedJson::array();
    for (const auto& single : reply.replies) {
      std::visit(ReplyEncoder{list.emplace_back(OrderedJson::object())}, single);
    }
    json["result"] = OrderedJson{{"replies", std::move(list)}};
  }
};

using Json = nlohmann::json;

}  // namespace

std::string encode_request(const Request& request) {
  OrderedJson json{{"id", request.id}};
  std::visit(RequestEncoder{json}, request.body);
  return line_of(json);
}

std::string encode_reply(std::int64_t id, const ReplyBody& reply) {
  OrderedJson json{{"id", id}};
  std::visit(ReplyEncoder{json}, reply);
  return line_of(json);
}

std::string encode_error_without_id(const ErrorReply& error) {
  return line_of(OrderedJson{{"id", nullptr}, {"error", error_to_json(error)}});
}

std::string encode_state(const State& state) { return line_of(state_json<OrderedJson>(state)); }

}  // namespace parallax::harness
