#include <cmath>

#include "compiler/base/json.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson value_to_json(const Value& value) {
  return std::visit([](const auto& plain) { return OrderedJson(plain); }, value);
}

OrderedJson state_to_json(const State& state) {
  OrderedJson object = OrderedJson::object();
  for (const auto& [name, value] : state) object[name] = value_to_json(value);
  return object;
}

/// One line. A name that is not UTF-8 becomes one that is, rather than an exception.
std::string line_of(const OrderedJson& json) { return base::json_text(json); }

OrderedJson error_to_json(const ErrorReply& error) {
  return OrderedJson{{"code", error.code}, {"message", error.message}};
}

OrderedJson info_to_json(std::int64_t protocol, const SimulatorInfo& info) {
  OrderedJson parameters = OrderedJson::array();
  for (const Parameter& p : info.parameters) {
    parameters.push_back(OrderedJson{{"name", p.name}, {"unit", p.unit}, {"settable", p.settable}});
  }
  OrderedJson actions = OrderedJson::array();
  for (const std::string& name : info.actions) actions.push_back(OrderedJson{{"name", name}});
  return OrderedJson{{"protocol", protocol},
                     {"name", info.name},
                     {"version", info.version},
                     {"determinism", info.determinism},
                     {"seeds", info.seeds},
                     {"time_step", info.timestep_s},
                     {"params", std::move(parameters)},
                     {"actions", std::move(actions)}};
}

OrderedJson outcome_to_json(const Outcome& outcome) {
  OrderedJson json{{"status", to_string(outcome.status)}};
  if (!outcome.reason.empty()) json["reason"] = outcome.reason;
  json["sim_time"] = outcome.sim_time_s;
  if (!outcome.margins.empty()) json["margins"] = state_to_json(outcome.margins);
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
    json["params"] = OrderedJson{{"state", state_to_json(reset.state)}, {"seed", reset.seed}};
  }
  void operator()(const ActRequest& act) const {
    json["method"] = "act";
    json["params"] = OrderedJson{{"action", act.action},
                                 {"args", state_to_json(act.arguments)},
                                 {"sim_time_limit", act.sim_time_limit_s}};
  }
  void operator()(const ObserveRequest&) const { json["method"] = "observe"; }
  void operator()(const CloseRequest&) const { json["method"] = "close"; }
  void operator()(const UnknownRequest& unknown) const { json["method"] = unknown.method; }
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
    json["result"] = OrderedJson{{"state", state_to_json(reply.state)}};
  }
  void operator()(const CloseReply&) const { json["result"] = OrderedJson{{"status", "ok"}}; }
};

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

std::string first_not_finite(const State& state) {
  for (const auto& [name, value] : state) {
    const double* number = std::get_if<double>(&value);
    if (number != nullptr && !std::isfinite(*number)) return name;
  }
  return {};
}

std::string encode_state(const State& state) { return line_of(state_to_json(state)); }

}  // namespace parallax::harness
