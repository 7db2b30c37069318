#include "harness/simulator/worker.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "harness/simulator/protocol.h"

namespace parallax::harness {
namespace {

/// Counts the requests, and can be told to fail.
class ScriptedSimulator final : public Simulator {
 public:
  SimulatorInfo info() override {
    SimulatorInfo info;
    info.name = "scripted";
    return info;
  }
  Outcome reset(const State& initial, std::uint64_t seed) override {
    state = initial;
    state["seed"] = static_cast<std::int64_t>(seed);
    if (state.count("overlap") != 0) return {SimStatus::kInvalidStart, "a overlaps b", 0.0, {}};
    return {};
  }
  Outcome act(std::string_view action, const State& arguments, double limit_s) override {
    ++acts;
    for (const auto& [name, value] : arguments) state[name] = value;
    return {action == "fail" ? SimStatus::kFailed : SimStatus::kOk, "", limit_s, {}};
  }
  State observe() override { return state; }

  State state;
  int acts = 0;
};

/// Feeds `input` to a worker and returns its exit value and the lines it wrote.
struct Session {
  int exit = -1;
  std::vector<std::string> lines;

  Session(Simulator& simulator, const std::string& input) {
    std::array<int, 2> to{}, from{};
    REQUIRE(pipe(to.data()) == 0);
    REQUIRE(pipe(from.data()) == 0);
    std::thread writer([&] {
      std::size_t done = 0;
      while (done < input.size()) {
        const ssize_t count = write(to[1], input.data() + done, input.size() - done);
        if (count <= 0) break;
        done += static_cast<std::size_t>(count);
      }
      close(to[1]);
    });
    std::string output;
    std::thread reader([&] {
      std::array<char, 4096> chunk{};
      for (;;) {
        const ssize_t count = read(from[0], chunk.data(), chunk.size());
        if (count <= 0) break;
        output.append(chunk.data(), static_cast<std::size_t>(count));
      }
    });
    exit = serve(simulator, to[0], from[1]);
    // Drains the worker's unread output, so that the writer ends.
    std::array<char, 4096> rest{};
    while (read(to[0], rest.data(), rest.size()) > 0) {
    }
    close(from[1]);
    writer.join();
    reader.join();
    close(to[0]);
    close(from[0]);
    for (std::size_t begin = 0; begin < output.size();) {
      const std::size_t end = output.find('\n', begin);
      REQUIRE(end != std::string::npos);
      lines.push_back(output.substr(begin, end - begin));
      begin = end + 1;
    }
  }
};

template <typename T>
T reply_as(const std::string& line, const Request& asked) {
  auto decoded = decode_reply(line, asked);
  REQUIRE(std::holds_alternative<ReplyBody>(decoded));
  REQUIRE(std::holds_alternative<T>(std::get<ReplyBody>(decoded)));
  return std::get<T>(std::get<ReplyBody>(decoded));
}

TEST_CASE("a worker answers a whole conversation over pipes") {
  const std::vector<Request> requests = {{1, HelloRequest{}},
                                         {2, ResetRequest{{{"box.x", 1.4}, {"flag", true}}, 5}},
                                         {3, ActRequest{"go", {{"box.x", 0.1 + 0.2}}, 2.5}},
                                         {4, ActRequest{"fail", {}, 1.0}},
                                         {5, ObserveRequest{}},
                                         {6, UnknownRequest{"dance"}},
                                         {7, CloseRequest{}},
                                         {8, ObserveRequest{}}};
  std::string input;
  for (const Request& request : requests) input += encode_request(request) + "\n";
  ScriptedSimulator simulator;
  const Session session(simulator, input);

  CHECK(session.exit == 0);
  REQUIRE(session.lines.size() == 7);  // nothing after close
  CHECK(reply_as<HelloReply>(session.lines[0], requests[0]).info.name == "scripted");
  CHECK(reply_as<OutcomeReply>(session.lines[1], requests[1]).outcome.status == SimStatus::kOk);
  CHECK(reply_as<OutcomeReply>(session.lines[2], requests[2]).outcome.sim_time_s == 2.5);
  CHECK(reply_as<OutcomeReply>(session.lines[3], requests[3]).outcome.status == SimStatus::kFailed);
  const State expected = {{"box.x", 0.1 + 0.2}, {"flag", true}, {"seed", std::int64_t{5}}};
  CHECK(reply_as<ObserveReply>(session.lines[4], requests[4]).state == expected);
  CHECK(reply_as<ErrorReply>(session.lines[5], requests[5]).code == "unsupported");
  reply_as<CloseReply>(session.lines[6], requests[6]);
}

TEST_CASE("a worker survives malformed requests and says what was wrong") {
  ScriptedSimulator simulator;
  const Session session(simulator,
                        "what?\n"
                        "\n"
                        "{\"id\":1,\"method\":\"reset\"}\n"
                        "{\"id\":2,\"method\":\"act\",\"params\":{\"action\":\"go\","
                        "\"sim_time_limit\":1}}\n"
                        "{\"id\":3,\"method\":\"observe\"}\n"
                        "{\"id\":4,\"method\":\"hello\",\"params\":{\"protocol\":[2,3]}}\n"
                        "{\"id\":5,\"method\":\"clo");
  CHECK(session.exit == 0);
  REQUIRE(session.lines.size() == 6);
  CHECK(session.lines[0] ==
        R"({"id":null,"error":{"code":"parse_error","message":"the line is not JSON"}})");
  CHECK(session.lines[1] == session.lines[0]);
  CHECK(session.lines[2] ==
        R"({"id":1,"error":{"code":"invalid_params","message":"`params` is missing"}})");
  CHECK(reply_as<ErrorReply>(session.lines[3], {2, ActRequest{}}).code == "incorrect_state");
  CHECK(reply_as<ErrorReply>(session.lines[4], {3, ObserveRequest{}}).code == "incorrect_state");
  CHECK(reply_as<ErrorReply>(session.lines[5], {4, HelloRequest{}}).code == "unsupported");
  CHECK(simulator.acts == 0);
}

TEST_CASE("after an invalid start a worker does not act") {
  ScriptedSimulator simulator;
  const Session session(simulator, encode_request({1, ResetRequest{{{"overlap", true}}, 1}}) +
                                       "\n" + encode_request({2, ActRequest{"go", {}, 1.0}}) +
                                       "\n");
  REQUIRE(session.lines.size() == 2);
  const Outcome outcome = reply_as<OutcomeReply>(session.lines[0], {1, ResetRequest{}}).outcome;
  CHECK(outcome.status == SimStatus::kInvalidStart);
  CHECK(outcome.reason == "a overlaps b");
  CHECK(reply_as<ErrorReply>(session.lines[1], {2, ActRequest{}}).code == "incorrect_state");
  CHECK(simulator.acts == 0);
}

TEST_CASE("a value that is not finite becomes an error, not a broken line") {
  ScriptedSimulator simulator;
  simulator.reset({}, 1);
  struct Broken final : Simulator {
    SimulatorInfo info() override { return {}; }
    Outcome reset(const State&, std::uint64_t) override { return {}; }
    Outcome act(std::string_view, const State&, double) override { return {}; }
    State observe() override { return {{"x", std::nan("")}}; }
  } broken;
  const Session session(broken, encode_request({1, ResetRequest{}}) + "\n" +
                                    encode_request({2, ObserveRequest{}}) + "\n");
  REQUIRE(session.lines.size() == 2);
  CHECK(reply_as<ErrorReply>(session.lines[1], {2, ObserveRequest{}}).code == "not_finite");
}

TEST_CASE("a line of more than a mebibyte ends the worker") {
  ScriptedSimulator simulator;
  const std::string hello = encode_request({1, HelloRequest{}}) + "\n";
  const Session session(simulator, hello + std::string(3 * kMaxLineBytes, 'x') + "\n" + hello);
  CHECK(session.exit == 1);
  REQUIRE(session.lines.size() == 2);
  CHECK(session.lines[1].find("line_too_long") != std::string::npos);
  // The longest line that is allowed is read.
  std::string padded = encode_request({1, HelloRequest{}});
  padded.append(kMaxLineBytes - padded.size(), ' ');
  const Session longest(simulator, padded + "\n");
  CHECK(longest.exit == 0);
  REQUIRE(longest.lines.size() == 1);
  reply_as<HelloReply>(longest.lines[0], {1, HelloRequest{}});
}

}  // namespace
}  // namespace parallax::harness
