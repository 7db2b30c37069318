#include "harness/simulator/protocol.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace parallax::harness {
namespace {

/// Encodes and decodes a reply to `asked`.
ReplyBody round_trip(const Request& asked, const ReplyBody& reply) {
  auto decoded = decode_reply(encode_reply(asked.id, reply), asked);
  REQUIRE(std::holds_alternative<ReplyBody>(decoded));
  return std::get<ReplyBody>(std::move(decoded));
}

std::string malformed_message(std::string_view line, const Request& asked) {
  const auto decoded = decode_reply(line, asked);
  REQUIRE(std::holds_alternative<Malformed>(decoded));
  return std::get<Malformed>(decoded).message;
}

std::string request_error(std::string_view line) {
  const auto decoded = decode_request(line);
  REQUIRE(std::holds_alternative<Malformed>(decoded));
  return std::get<Malformed>(decoded).code;
}

const State kMixed = {{"a", true},
                      {"b", std::int64_t{-7}},
                      {"c", 0.1},
                      {"d", 1.0},
                      {"e", std::string("naïve \"\\\n\U0001F600")},
                      {"f", 5e-324},
                      {"g", -0.0},
                      {"h", std::numeric_limits<double>::max()},
                      {"i", std::nextafter(1.0, 2.0)},
                      {"j", std::numeric_limits<std::int64_t>::min()}};

TEST_CASE("a state survives the round trip bit for bit, types included") {
  const auto back = decode_state(encode_state(kMixed));
  REQUIRE(std::holds_alternative<State>(back));
  CHECK(std::get<State>(back) == kMixed);
  CHECK(std::signbit(std::get<double>(std::get<State>(back).at("g"))));
}

TEST_CASE("a state of many variables is written and read in their order") {
  State wide;
  for (int i = 0; i < 30000; ++i) wide[fmt::format("v{:05}", 29999 - i)] = 0.5 * i;
  const auto line = encode_state(wide);
  CHECK(line.rfind(R"({"v00000":14999.5,"v00001":14999.0,)", 0) == 0);
  CHECK(std::get<State>(decode_state(line)) == wide);
}

TEST_CASE("requests survive the round trip on one line") {
  const std::array<Request, 6> requests = {
      Request{1, HelloRequest{}},
      Request{2, ResetRequest{kMixed, std::numeric_limits<std::uint64_t>::max()}},
      Request{3, ActRequest{"picking-up", {{"object", std::string("box")}}, 30.5}},
      Request{4, ObserveRequest{}},
      Request{5, CloseRequest{}},
      Request{6, UnknownRequest{"dance"}}};
  for (const Request& request : requests) {
    const std::string line = encode_request(request);
    CHECK(line.find('\n') == std::string::npos);
    const auto decoded = decode_request(line);
    REQUIRE(std::holds_alternative<Request>(decoded));
    const Request& back = std::get<Request>(decoded);
    CHECK(back.id == request.id);
    CHECK(back.body.index() == request.body.index());
    CHECK(encode_request(back) == line);
  }
  const auto reset = std::get<Request>(decode_request(encode_request(requests[1])));
  CHECK(std::get<ResetRequest>(reset.body).seed == std::numeric_limits<std::uint64_t>::max());
  CHECK(std::get<ResetRequest>(reset.body).state == kMixed);
}

TEST_CASE("requests are written as the protocol's examples are") {
  CHECK(encode_request({1, HelloRequest{}}) ==
        R"({"id":1,"method":"hello","params":{"protocol":[1]}})");
  CHECK(
      encode_request({2, ResetRequest{{{"box.x", 1.4}, {"robot.x", 0.8}}, 2071723}}) ==
      R"({"id":2,"method":"reset","params":{"state":{"box.x":1.4,"robot.x":0.8},"seed":2071723}})");
  CHECK(encode_request({4, ObserveRequest{}}) == R"({"id":4,"method":"observe"})");
}

TEST_CASE("replies survive the round trip") {
  SimulatorInfo info{"mybot",
                     "0.3",
                     "tolerance",
                     true,
                     {{"box.x", "m", true}, {"box.held", "1", false}},
                     {"going", "placing"},
                     0.002};
  const auto hello = std::get<HelloReply>(round_trip({1, HelloRequest{}}, HelloReply{1, info}));
  CHECK(hello.protocol == 1);
  CHECK(hello.info.name == "mybot");
  CHECK(hello.info.determinism == "tolerance");
  CHECK(hello.info.seeds);
  CHECK(hello.info.parameters.size() == 2);
  CHECK(hello.info.parameters[0].settable);
  CHECK(hello.info.actions == info.actions);
  CHECK(hello.info.timestep_s == 0.002);

  const Outcome failed{SimStatus::kFailed, "unreachable", 2.4, {{"reach", -0.03}}};
  const auto outcome =
      std::get<OutcomeReply>(round_trip({3, ActRequest{}}, OutcomeReply{failed})).outcome;
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(outcome.reason == "unreachable");
  CHECK(outcome.sim_time_s == 2.4);
  CHECK(outcome.margins == failed.margins);

  CHECK(std::get<ObserveReply>(round_trip({4, ObserveRequest{}}, ObserveReply{kMixed})).state ==
        kMixed);
  CHECK(std::holds_alternative<CloseReply>(round_trip({5, CloseRequest{}}, CloseReply{})));
  CHECK(std::get<ErrorReply>(round_trip({5, ActRequest{}}, ErrorReply{"internal", "no"})).code ==
        "internal");
}

TEST_CASE("a run as one request: what is asked, and answers that are none") {
  const Request asked{7,
                      PerformRequest{{ResetRequest{{{"box.x", 0.5}}, 3}, ObserveRequest{},
                                      ActRequest{"push", {{"by", 1.0}}, 30.0}, ObserveRequest{}}}};
  CHECK(encode_request(asked) ==
        R"({"id":7,"method":"perform","params":{"requests":[)"
        R"({"method":"reset","params":{"state":{"box.x":0.5},"seed":3}},{"method":"observe"},)"
        R"({"method":"act","params":{"action":"push","args":{"by":1.0},"sim_time_limit":30.0}},)"
        R"({"method":"observe"}]}})");
  const OutcomeReply fine{{SimStatus::kOk, "", 2.0, {}}},
      failed{{SimStatus::kFailed, "no", 1.0, {}}},
      invalid{{SimStatus::kInvalidStart, "`a` in `b`", 0.0, {}}};
  const ObserveReply seen{kMixed};
  const auto replies = [&](std::vector<SingleReply> list) {
    return std::get<PerformReply>(round_trip(asked, PerformReply{std::move(list)})).replies;
  };
  const auto all = replies({fine, seen, failed, seen});
  REQUIRE(all.size() == 4);
  CHECK(std::get<OutcomeReply>(all[2]).outcome.reason == "no");
  CHECK(std::get<ObserveReply>(all[3]).state == kMixed);
  CHECK(replies({invalid}).size() == 1);
  CHECK(std::get<ErrorReply>(replies({fine, ErrorReply{"internal", "x"}})[1]).message == "x");
  const auto why = [&](std::vector<SingleReply> list) {
    return malformed_message(encode_reply(7, PerformReply{std::move(list)}), asked);
  };
  CHECK(why({}) == "`replies` is no list of an answer to each request");
  CHECK(why({fine, seen, fine, seen, seen}) == "`replies` is no list of an answer to each request");
  CHECK(why({fine, seen, failed}) == "`replies` breaks off");
  CHECK(why({invalid, seen}) == "`replies` goes on after an answer that is the last one");
  CHECK(why({fine, fine}) == "`state` is missing");
  CHECK(why({seen}) == "`status` is missing");
  CHECK(malformed_message(R"({"id":7,"result":{}})", asked) == "`replies` is missing");
  CHECK(malformed_message(R"({"id":7,"result":{"replies":[3]}})", asked) ==
        "an element of `replies` is not an object");
  CHECK(malformed_message(R"({"id":7,"result":{"replies":[{}]}})", asked) == "`result` is missing");
}

TEST_CASE("fields that are not known are ignored") {
  const auto decoded =
      decode_reply(R"({"id":2,"result":{"status":"ok","colour":[1,{"x":null}]},"later":true})",
                   Request{2, ResetRequest{}});
  REQUIRE(std::holds_alternative<ReplyBody>(decoded));
  CHECK(std::get<OutcomeReply>(std::get<ReplyBody>(decoded)).outcome.status == SimStatus::kOk);
}

TEST_CASE("what a simulator says of its world survives the round trip") {
  SimulatorInfo info;
  info.name = "told";
  info.determinism = "bitwise";
  info.parameters = {{"box.x", "m", true, -1.5, 2.0}, {"box.held", "1", false}};
  info.actions = {"push", "wait"};
  info.arguments["push"] = {{"target.x", "m", true, Value(1.5)}, {"speed", "m/s", false}};
  info.capabilities = {"describe", "noise"};
  info.min_real_time_factor = 0.25;
  const auto check = [&](const SimulatorInfo& read) {
    REQUIRE(read.parameters.size() == 2);
    CHECK(read.parameters[0].lower == -1.5);
    CHECK(read.parameters[0].upper == 2.0);
    CHECK_FALSE(read.parameters[1].lower.has_value());
    CHECK(read.actions == info.actions);
    REQUIRE(read.arguments.size() == 1);
    const auto& push = read.arguments.at("push");
    CHECK(push.at(0).required);
    CHECK(push.at(0).unit == "m");
    CHECK(push.at(0).example == Value(1.5));
    CHECK_FALSE(push.at(1).example.has_value());
  };
  const Request hello{1, HelloRequest{}};
  const auto reply = decode_reply(encode_reply(1, HelloReply{kProtocolVersion, info}), hello);
  const auto& read = std::get<HelloReply>(std::get<ReplyBody>(reply)).info;
  check(read);
  CHECK(read.can("noise"));
  CHECK_FALSE(read.can("poses"));
  CHECK(read.min_real_time_factor == 0.25);
  const Request describe{2, DescribeRequest{}};
  CHECK(encode_request(describe) == R"({"id":2,"method":"describe"})");
  const auto described = decode_reply(encode_reply(2, DescribeReply{info}), describe);
  check(std::get<DescribeReply>(std::get<ReplyBody>(described)).info);
}

TEST_CASE("codes of errors are words or numbers") {
  const Request asked{3, ObserveRequest{}};
  const auto error = [&](const std::string& code) {
    const auto reply =
        decode_reply(R"({"id":3,"error":{"code":)" + code + R"(,"message":"no"}})", asked);
    REQUIRE(std::holds_alternative<ReplyBody>(reply));
    return std::get<ErrorReply>(std::get<ReplyBody>(reply));
  };
  CHECK(error("\"unsupported\"").code == "unsupported");
  CHECK(error("-32601").code == "-32601");
  CHECK(is_refusal(error("-32601")));
  CHECK(is_refusal(error("-32602")));
  CHECK_FALSE(is_refusal(error("-32603")));
  CHECK_FALSE(is_refusal(error("\"internal\"")));
  for (const auto* code : {"1.5", "null", "[]"}) {
    CAPTURE(code);
    const auto reply = decode_reply(
        std::string(R"({"id":3,"error":{"code":)") + code + R"(,"message":"no"}})", asked);
    CHECK(std::holds_alternative<Malformed>(reply));
  }
}

TEST_CASE("a world that is told in a wrong form is malformed") {
  const Request hello{1, HelloRequest{}};
  const auto says = [&](const std::string& members) {
    return decode_reply(R"({"id":1,"result":{"protocol":1,"name":"s",)" + members + "}}", hello);
  };
  CHECK(std::holds_alternative<ReplyBody>(says(R"("params":[],"actions":["go"])")));
  for (const auto* wrong : {R"("params":[],"actions":[{"name":"go","args":{}}])",
                            R"("params":[],"actions":[{"name":"go","args":["x"]}])",
                            R"("params":[],"actions":[{"name":"go","args":[{"unit":"m"}]}])",
                            R"("params":[{"name":"x","lower":"0"}],"actions":[])",
                            R"("params":[],"actions":[],"capabilities":"all")",
                            R"("params":[],"actions":[],"min_real_time_factor":1e-300)",
                            R"("params":[],"actions":[],"min_real_time_factor":-1)"}) {
    CAPTURE(wrong);
    CHECK(std::holds_alternative<Malformed>(says(wrong)));
  }
}

TEST_CASE("a reply that is not the protocol is malformed") {
  const Request act{3, ActRequest{}}, observe{4, ObserveRequest{}}, hello{1, HelloRequest{}};
  CHECK(malformed_message("Segmentation fault", act) == "the line is not JSON");
  CHECK(malformed_message("", act) == "the line is not JSON");
  CHECK(malformed_message("[1,2]", act) == "the line is not an object");
  CHECK(malformed_message(R"({"id":3,"result":{"status":"ok"})", act) == "the line is not JSON");
  CHECK(malformed_message(R"({"id":2,"result":{"status":"ok"}})", act) ==
        "the reply to request 3 carries id 2");
  CHECK(malformed_message(R"({"result":{"status":"ok"}})", act) ==
        "the reply to request 3 carries no id");
  CHECK(malformed_message(R"({"id":null,"error":{"code":"parse_error","message":"what?"}})", act) ==
        "the reply to request 3 carries no id (what?)");
  CHECK(malformed_message(R"({"id":3})", act) == "`result` is missing");
  CHECK(malformed_message(R"({"id":3,"result":7})", act) == "`result` is not an object");
  CHECK(malformed_message(R"({"id":3,"result":{}})", act) == "`status` is missing");
  CHECK(malformed_message(R"({"id":3,"result":{"status":"fine"}})", act) == "no status `fine`");
  CHECK(malformed_message(R"({"id":3,"result":{"status":"ok","sim_time":"2"}})", act) ==
        "`sim_time` is not a number");
  CHECK(malformed_message(R"({"id":4,"result":{"state":{"x":NaN}}})", observe) ==
        "the line is not JSON");
  CHECK(malformed_message(R"({"id":4,"result":{"state":{"x":1e999}}})", observe) ==
        "the line is not JSON");
  CHECK(malformed_message(R"({"id":4,"result":{"state":{"x":null}}})", observe) ==
        "`x` is neither boolean, number nor string");
  CHECK(malformed_message(R"({"id":4,"result":{"state":{"x":[1]}}})", observe) ==
        "`x` is neither boolean, number nor string");
  CHECK(malformed_message(R"({"id":4,"result":{}})", observe) == "`state` is missing");
  CHECK(malformed_message(R"({"id":1,"result":{"protocol":1,"name":"x"}})", hello) ==
        "`params` is missing");
  CHECK(malformed_message("{\"id\":4,\"result\":{\"state\":{\"x\":\"\xff\xfe\"}}}", observe) ==
        "the line is not JSON");
}

TEST_CASE("a deeply nested line is refused without harm") {
  CHECK(request_error(std::string(500000, '[')) == "parse_error");
  CHECK(request_error(std::string(400000, '[') + std::string(400000, ']')) == "invalid_request");
  CHECK(request_error(std::string(kMaxLineBytes + 1, ' ')) == "line_too_long");
}

TEST_CASE("a request that is not the protocol is malformed") {
  CHECK(request_error("hello") == "parse_error");
  CHECK(request_error("7") == "invalid_request");
  CHECK(request_error(R"({"method":"observe"})") == "invalid_request");
  CHECK(request_error(R"({"id":"1","method":"observe"})") == "invalid_request");
  CHECK(request_error(R"({"id":1})") == "invalid_params");
  CHECK(request_error(R"({"id":1,"method":7})") == "invalid_params");
  CHECK(request_error(R"({"id":1,"method":"reset"})") == "invalid_params");
  CHECK(request_error(R"({"id":1,"method":"reset","params":{"state":{}}})") == "invalid_params");
  CHECK(request_error(R"({"id":1,"method":"reset","params":{"state":{},"seed":-1}})") ==
        "invalid_params");
  CHECK(request_error(R"({"id":1,"method":"reset","params":{"state":{"x":{}},"seed":1}})") ==
        "invalid_params");
  CHECK(request_error(R"({"id":1,"method":"act","params":{"action":"going"}})") ==
        "invalid_params");
  CHECK(
      request_error(R"({"id":1,"method":"act","params":{"action":"going","sim_time_limit":-1}})") ==
      "invalid_params");
  CHECK(request_error(R"({"id":1,"method":"hello","params":{"protocol":1}})") == "invalid_params");
}

TEST_CASE("an integer that does not fit into 64 bits with a sign is no id and no version") {
  CHECK(request_error(R"({"id":18446744073709551615,"method":"observe"})") == "invalid_request");
  CHECK(request_error(R"({"id":9223372036854775808,"method":"close"})") == "invalid_request");
  CHECK(request_error(R"({"id":1e3,"method":"close"})") == "invalid_request");
  CHECK(
      request_error(R"({"id":1,"method":"hello","params":{"protocol":[18446744073709551615]}})") ==
      "invalid_params");
  const Request hello{1, HelloRequest{}};
  CHECK(malformed_message(
            R"({"id":1,"result":{"protocol":18446744073709551615,"params":[],"actions":[]}})",
            hello) == "`protocol` is not an integer");
  CHECK(malformed_message(R"({"id":18446744073709551615,"result":{}})", {-1, ObserveRequest{}}) ==
        "the reply to request -1 carries no id");
  const auto least = decode_request(R"({"id":-9223372036854775808,"method":"observe"})");
  REQUIRE(std::holds_alternative<Request>(least));
  CHECK(std::get<Request>(least).id == std::numeric_limits<std::int64_t>::min());
}

TEST_CASE("what a hostile simulator says of itself and of its outcomes is refused") {
  const Request hello{1, HelloRequest{}}, act{3, ActRequest{}};
  const auto info = [&](const std::string& more) {
    return malformed_message(R"({"id":1,"result":{"protocol":1,"name":"x",)" + more + "}}", hello);
  };
  CHECK(info(R"("params":{},"actions":[])") == "`params` and `actions` are not lists");
  CHECK(info(R"("params":[7],"actions":[])") == "an element of `params` is not an object");
  CHECK(info(R"("params":[{}],"actions":[])") == "`name` is missing");
  CHECK(info(R"("params":[{"name":"x","settable":1}],"actions":[])") ==
        "`settable` is not a boolean");
  CHECK(info(R"("params":[],"actions":[{}])") == "`name` is missing");
  CHECK(info(R"("params":[],"actions":[[]])") == "an element of `actions` has no name");
  CHECK(info(R"("params":[],"actions":[""])") == "an element of `actions` has no name");
  CHECK(info(R"("seeds":"yes","params":[],"actions":[])") == "`seeds` is not a boolean");
  const auto outcome = [&](const std::string& result) {
    return malformed_message(R"({"id":3,"result":)" + result + "}", act);
  };
  CHECK(outcome(R"({"status":"ok","sim_time":-1})") == "`sim_time` is not within 0 to 1e9 s");
  CHECK(outcome(R"({"status":"ok","sim_time":1e300})") == "`sim_time` is not within 0 to 1e9 s");
  CHECK(outcome(R"({"status":"OK"})") == "no status `OK`");
  CHECK(outcome(R"({"status":null})") == "`status` is not a string");
  CHECK(outcome(R"({"status":"ok","reason":[]})") == "`reason` is not a string");
  CHECK(outcome(R"({"status":"ok","margins":{"reach":{}}})") ==
        "`reach` is neither boolean, number nor string");
  for (const std::string margin : {R"("wide")", "true"}) {
    CHECK(outcome(R"({"status":"ok","margins":{"reach":)" + margin + "}}") ==
          "margin `reach` is not a number");
  }
  CHECK(malformed_message(R"({"id":3,"error":{}})", act) == "`code` is missing");
  CHECK(malformed_message(R"({"id":3,"error":"no"})", act) == "`error` is not an object");
  CHECK(malformed_message(R"({"id":3,"result":{"status":"ok","reason":"\ud800"}})", act) ==
        "the line is not JSON");
}

TEST_CASE("an integer beyond 64 bits is a number in a state") {
  const auto state = decode_state(R"({"a":9223372036854775807,"b":18446744073709551615})");
  REQUIRE(std::holds_alternative<State>(state));
  CHECK(std::get<State>(state).at("a") == Value(std::numeric_limits<std::int64_t>::max()));
  CHECK(std::get<State>(state).at("b") == Value(18446744073709551615.0));
}

TEST_CASE("no line of broken pieces of a reply crashes the decoder") {
  const std::string whole =
      R"({"id":3,"result":{"status":"failed","reason":"x","sim_time":2.4,"margins":{"reach":-0.03}}})";
  const Request asked{3, ActRequest{}};
  for (std::size_t length = 0; length < whole.size(); ++length) {
    CHECK(std::holds_alternative<Malformed>(decode_reply(whole.substr(0, length), asked)));
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char wrong : {'"', '}', '0', '\0', '\x80'}) {
      std::string damaged = whole;
      damaged[at] = wrong;
      decode_reply(damaged, asked);
      decode_request(damaged);
    }
  }
}

TEST_CASE("a state names its first value that JSON cannot say") {
  CHECK(first_not_finite(kMixed).empty());
  CHECK(first_not_finite({{"x", 1.0}, {"y", std::nan("")}}) == "y");
  CHECK(first_not_finite({{"x", std::numeric_limits<double>::infinity()}}) == "x");
}

TEST_CASE("status words go there and back") {
  for (const SimStatus status :
       {SimStatus::kOk, SimStatus::kFailed, SimStatus::kTruncated, SimStatus::kInvalidStart,
        SimStatus::kUnsupported, SimStatus::kLost}) {
    CHECK(sim_status_from(to_string(status)) == status);
  }
  CHECK(sim_status_from("fine") == SimStatus::kUnsupported);
}

TEST_CASE("motion goes through the protocol as it is") {
  const Request reset{3, ResetRequest{{{"robot.x", 0.5}}, 7, 0.05}};
  const auto asked = decode_request(encode_request(reset));
  REQUIRE(std::holds_alternative<Request>(asked));
  CHECK(std::get<ResetRequest>(std::get<Request>(asked).body).record_interval_s == 0.05);
  Outcome outcome;
  outcome.motion = {std::string("\0\xff\n\"x", 5), "more than 8 MiB of frames"};
  const auto answer = decode_reply(encode_reply(3, OutcomeReply{outcome}), reset);
  REQUIRE(std::holds_alternative<ReplyBody>(answer));
  CHECK(std::get<OutcomeReply>(std::get<ReplyBody>(answer)).outcome.motion == outcome.motion);
}

TEST_CASE("a scene goes through the protocol, unless it is too large for a line") {
  const Request hello{1, HelloRequest{}};
  const auto told = [&](const SimulatorInfo& info) {
    const auto line = encode_reply(1, HelloReply{kProtocolVersion, info});
    CHECK(line.size() < kMaxLineBytes);
    const auto answer = decode_reply(line, hello);
    REQUIRE(std::holds_alternative<ReplyBody>(answer));
    return std::get<HelloReply>(std::get<ReplyBody>(answer)).info.scene;
  };
  SimulatorInfo info;
  info.name = "x";
  CHECK_FALSE(told(info));
  info.scene.emplace();
  info.scene->grippers = {"hand"};
  info.scene->bodies = {
      {"cup", BodyKind::kItem, "", {{ShapeKind::kBox, {1, 2, 3}, {}}}, true, {}, {}}};
  CHECK(told(info) == info.scene);
  for (int i = 0; i < 9000; ++i) {
    RecordedBody body;
    body.name = "box " + std::to_string(i) + std::string(50, '_');
    info.scene->bodies.push_back(std::move(body));
  }
  CHECK_FALSE(told(info));
}

}  // namespace
}  // namespace parallax::harness
