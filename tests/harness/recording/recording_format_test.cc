#include "harness/recording/recording_format.h"

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "harness/recording/bytes.h"
#include "harness/recording/marks.h"
#include "harness/recording/scene_json.h"
#include "tests/harness/recording/sample_recording.h"

namespace parallax::harness {
namespace {

std::string fault_of(const std::string& bytes) {
  const auto decoded = decode_recording(bytes);
  const auto* bad = std::get_if<BadRecording>(&decoded);
  return bad == nullptr ? "" : std::to_string(bad->byte) + ": " + bad->why;
}

/// A file with this head and these frames, and a checksum that is right.
std::string file_of(const std::string& head, const std::string& frames) {
  std::string out = "PLXREC\r\n";
  put_u32(out, 1);
  put_u32(out, static_cast<std::uint32_t>(head.size()));
  out += head;
  put_u32(out, static_cast<std::uint32_t>(frames.size()));
  out += frames;
  put_u32(out, crc32(out));
  return out;
}

std::string head_of(const std::string& bytes) { return bytes.substr(16, u32_at(bytes, 12)); }

TEST_CASE("checksum and base64: the published examples") {
  CHECK(crc32("123456789") == 0xcbf43926U);
  CHECK(crc32("6789", crc32("12345")) == 0xcbf43926U);
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  for (const auto* text : {"Zg=", "Z===", "Zg==Zg==", "Zm9v\n", "Zm9*"}) {
    CHECK_FALSE(from_base64(text));
  }
  std::string all;
  for (int i = 0; i < 256; ++i) all.push_back(static_cast<char>(i));
  for (std::size_t size = 0; size <= all.size(); ++size) {
    CHECK(from_base64(base64(all.substr(0, size))) == all.substr(0, size));
  }
}

TEST_CASE("recording: what was written is what is read") {
  const auto recording = sample_recording();
  const auto bytes = encode(recording);
  const auto decoded = decode_recording(bytes);
  REQUIRE(std::holds_alternative<Recording>(decoded));
  CHECK(std::get<Recording>(decoded) == recording);
  CHECK(encode(std::get<Recording>(decoded)) == bytes);
}

TEST_CASE("recording: what hangs on a body goes with it") {
  Recording recording;
  recording.scene = sample_recording().scene;
  recording.scene.bodies.resize(3);
  recording.scene.arms.clear();
  recording.scene.grippers.clear();
  MotionWriter writer({1, 0});
  const double half = std::sqrt(0.5);
  writer.add(0.0, std::vector{Pose{{2, 0, 0}, {half, 0, 0, half}}}, {});  // a quarter turn left
  recording.frames = writer.take();
  Playback at(recording);
  REQUIRE(at.next());
  const auto pad = at.pose_of(2);
  CHECK(pad.p[0] == doctest::Approx(2.0).epsilon(1e-3));
  CHECK(pad.p[1] == doctest::Approx(0.5).epsilon(1e-3));
  CHECK(at.pose_of(0) == recording.scene.bodies[0].pose);
}

TEST_CASE("recording: a file that was cut short says where it ends") {
  const auto bytes = encode(sample_recording());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto fault = fault_of(bytes.substr(0, size));
    CHECK_FALSE(fault.empty());
    if (size >= 8) CHECK(fault.starts_with(std::to_string(size) + ": the file ends within its "));
  }
  CHECK(fault_of(bytes + "x") == std::to_string(bytes.size()) + ": something follows its end");
}

TEST_CASE("recording: one changed bit is noticed") {
  const auto bytes = encode(sample_recording());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    CHECK_FALSE(fault_of(changed).empty());
  }
}

TEST_CASE("recording: sizes that promise more than there is cost nothing") {
  auto bytes = encode(sample_recording());
  bytes.replace(12, 4, "\xff\xff\xff\xff", 4);
  CHECK(fault_of(bytes) == "12: its head is too large");
  bytes.replace(12, 4, std::string("\x00\x00\x10\x00", 4));
  CHECK(fault_of(bytes).ends_with("the file ends within its head"));
  bytes = encode(sample_recording());
  bytes.replace(8, 4, std::string("\x09\x00\x00\x00", 4));
  CHECK(fault_of(bytes) == "8: it is of version 9, this program reads version 1");
  CHECK(fault_of("{\"journal\": 1}") == "0: the file does not begin as a recording does");
}

TEST_CASE("recording: heads that lie, with a checksum that is right") {
  const auto recording = sample_recording();
  const auto good = nlohmann::json::parse(head_of(encode(recording)));
  const auto fault = [&](const nlohmann::json& head) {
    return fault_of(file_of(head.dump(), recording.frames));
  };
  CHECK(fault(good) == "");
  const auto with = [&](const char* pointer, nlohmann::json value) {
    auto head = good;
    head[nlohmann::json::json_pointer(pointer)] = std::move(value);
    return fault(head);
  };
  CHECK(with("/trace", -1).ends_with("`trace` in the head is negative"));
  CHECK(with("/trace", "1").ends_with("`trace` in the head is of another type"));
  CHECK(with("/events/0/end_s", 1e300).ends_with("`end_s` is not within 0 to 1e9 s"));
  CHECK(with("/events", 3).ends_with("`events` in the head is no list"));
  CHECK(with("/observations/0/x", nlohmann::json::array())
            .ends_with("`x` in the head is neither boolean, number nor text"));
  CHECK(with("/bodies/1/name", "table").ends_with("two bodies are called `table`"));
  CHECK(with("/bodies/1/kind", "ghost").ends_with("`base` is of no kind that there is"));
  CHECK(with("/bodies/2/on", 2).ends_with("`pad` hangs on what does not move itself"));
  CHECK(with("/bodies/2/on", 99).ends_with("`on` of `pad` is not the number of a body"));
  CHECK(with("/bodies/0/pose", {1, 2}).ends_with("the pose of `table` is no list of 7 numbers"));
  CHECK(with("/bodies/0/pose", {1, 2, 3, 4, 5, 6, 7}).ends_with("`table` is no unit quaternion"));
  CHECK(with("/bodies/0/colour", "red").ends_with("the colour of `table` is not #rrggbb"));
  CHECK(with("/bodies/0/shapes/0/box", {1, 2, -3}).ends_with("shape of `table` is negative"));
  CHECK(with("/bodies/0/shapes/0", {{"mesh", "x.stl"}})
            .ends_with("is neither box, sphere, cylinder, capsule nor hull"));
  CHECK(with("/bodies/0/shapes/4/faces", {{0, 1, 4}}).ends_with("`table` has no such corner"));
  CHECK(with("/bodies/0/shapes/4/faces", {{0, 1}}).ends_with("of `table` is no triangle"));
  CHECK(with("/bodies/0/shapes/4/faces", {{0, 1, -1}}).ends_with("`table` has no such corner"));
  CHECK(with("/bodies/0/shapes/4/faces", 3).ends_with("corners and up to 512 `faces`"));
  CHECK(with("/bodies/0/shapes/4/hull", {{0, 0, 0}}).ends_with("corners and up to 512 `faces`"));
  CHECK(with("/bodies/0/shapes/4/hull/2", {0, 0}).ends_with("is no list of 3 numbers"));
  CHECK(with("/bodies/0/shapes/4/hull/2", {0, 0, 1e9}).ends_with("has what is no number"));
  CHECK(with("/arms/0/to", 99).ends_with("`to` of the arm `left` is not the number of a body"));
  // Fewer bodies than the frames speak of.
  auto fewer = good;
  fewer["bodies"].erase(4);
  CHECK(fault(fewer).ends_with("a frame moves more bodies than there are"));
  CHECK(fault_of(file_of(std::string(100000, '['), "")).ends_with("its head is not JSON"));
}

/// A first frame with all of `bodies`, then `frames` in which the first one moves and has another
/// grip.
std::string restless(std::size_t bodies, std::size_t frames) {
  MotionWriter writer({bodies, 1});
  std::vector<Pose> poses(bodies);
  std::vector<std::uint8_t> grips(bodies, 0);
  writer.add(0.0, poses, grips);
  std::string out = writer.take();
  poses[0].p[0] = 0.01;
  grips[0] = kGripHeld;
  writer.add(0.001, poses, grips);
  poses[0].p[0] = 0.0;
  grips[0] = 0;
  writer.add(0.002, poses, grips);
  const auto there_and_back = writer.take();
  for (std::size_t i = 0; i < frames; i += 2) out += there_and_back;
  return out;
}

TEST_CASE("recording: a short file that would be a table without end is refused") {
  auto head = nlohmann::json::parse(head_of(encode(Recording())));
  head["grippers"] = nlohmann::json::array({"hand"});
  const nlohmann::json base = {{"name", "base"}, {"moves", true}};
  constexpr const char* kTooMuch = "its motion would fill more than 512 MiB as a table";
  head["bodies"] = nlohmann::json::array({base});
  CHECK(fault_of(file_of(head.dump(), restless(1, 1000))) == "");
  for (int i = 1; i < 10'000; ++i) {
    head["bodies"].push_back({{"name", std::to_string(i)}, {"moves", true}, {"on", 0}});
  }
  CHECK(fault_of(file_of(head.dump(), restless(1, 100))) == "");
  CHECK(fault_of(file_of(head.dump(), restless(1, 1000))).ends_with(kTooMuch));
  head["bodies"] = nlohmann::json::array({base});
  head["bodies"][0]["name"] = std::string(1'000'000, 'x');
  CHECK(fault_of(file_of(head.dump(), restless(1, 100))) == "");
  CHECK(fault_of(file_of(head.dump(), restless(1, 1000))).ends_with(kTooMuch));
  head["bodies"] = nlohmann::json::array({base});
  CHECK(fault_of(file_of(head.dump(), std::string(10U << 20U, '\0'))).ends_with("too large"));
}

TEST_CASE("recording: grips that change cost nothing for those that do not") {
  constexpr std::size_t kBodies = 9000, kGrippers = 64, kFrames = 20'000;
  Recording recording;
  for (std::size_t i = 0; i < kBodies; ++i) {
    RecordedBody body;
    body.name = std::to_string(i);
    body.moves = true;
    recording.scene.bodies.push_back(body);
  }
  for (std::size_t i = 0; i < kGrippers; ++i) {
    recording.scene.grippers.push_back("hand" + std::to_string(i));
  }
  recording.frames = restless(kBodies, kFrames);
  const auto marks = marks_of(recording);
  REQUIRE(marks.size() == kFrames);
  CHECK(marks[0].text == "hand0 holds 0");
  CHECK(marks[1].text == "hand0 lets go of 0");
}

TEST_CASE("recording: random damage behind a right checksum is survived") {
  const auto recording = sample_recording();
  const auto head = head_of(encode(recording));
  Steps steps(5);
  for (int i = 0; i < 2000; ++i) {
    auto damaged = head;
    auto frames = recording.frames;
    for (int k = 0; k < 3; ++k) {
      damaged[steps.next() % damaged.size()] = static_cast<char>(' ' + steps.next() % 95);
      frames[steps.next() % frames.size()] = static_cast<char>(steps.next());
    }
    const bool in_head = steps.next() % 2 == 0;
    const auto decoded =
        decode_recording(file_of(in_head ? damaged : head, in_head ? recording.frames : frames));
    const auto* read = std::get_if<Recording>(&decoded);
    if (read == nullptr) continue;
    for (Playback at(*read); at.next();) {
      for (std::size_t body = 0; body < read->scene.bodies.size(); ++body) at.pose_of(body);
    }
  }
}

}  // namespace
}  // namespace parallax::harness
