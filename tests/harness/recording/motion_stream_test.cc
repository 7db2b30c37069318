#include "harness/recording/motion_stream.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/harness/recording/sample_recording.h"

namespace parallax::harness {
namespace {

double distance_m(const Pose& a, const Pose& b) {
  return std::hypot(a.p[0] - b.p[0], a.p[1] - b.p[1], a.p[2] - b.p[2]);
}

/// The angle of the turn from one to the other [rad].
double angle_rad(const Pose& a, const Pose& b) {
  double along = 0.0;
  for (std::size_t i = 0; i < 4; ++i) along += a.q[i] * b.q[i];
  return 2.0 * std::acos(std::min(1.0, std::abs(along)));
}

TEST_CASE("motion: places are kept to a millimetre and turns to a twentieth of a degree") {
  constexpr double kAngle = 0.05 * 3.14159265358979 / 180.0;
  Steps steps(1);
  MotionWriter writer({3, 1});
  std::vector<std::vector<Pose>> written;
  for (int i = 0; i < 500; ++i) {
    std::vector<Pose> poses;
    for (int body = 0; body < 3; ++body) {
      // One leaps, one creeps, one stands.
      auto pose = i == 0 || body == 0 ? random_pose(steps) : written.back()[poses.size()];
      if (body == 1) pose.p[0] += 1e-4;
      poses.push_back(pose);
    }
    REQUIRE(writer.add(0.1 * i, poses, {}));
    written.push_back(std::move(poses));
  }
  const auto bytes = writer.take();
  MotionCursor cursor(bytes, {3, 1});
  for (int i = 0; i < 500; ++i) {
    REQUIRE(cursor.next());
    CHECK(cursor.time_s() == doctest::Approx(0.1 * i));
    for (std::size_t body = 0; body < 3; ++body) {
      const auto& exact = written[static_cast<std::size_t>(i)][body];
      CHECK(distance_m(cursor.poses()[body], exact) <= 1e-3);
      CHECK(angle_rad(cursor.poses()[body], exact) <= kAngle);
    }
    const bool stands = std::count(cursor.moved().begin(), cursor.moved().end(), 2U) == 0;
    CHECK(stands == (i > 0));
  }
  CHECK_FALSE(cursor.next());
  CHECK(cursor.fault().empty());
}

TEST_CASE("motion: a frame in which nothing moves costs nothing, and trembling is no motion") {
  MotionWriter writer({1, 1});
  Steps steps(2);
  const auto pose = random_pose(steps);
  writer.add(0.0, std::vector{pose}, std::vector<std::uint8_t>{0});
  const auto first = writer.take();
  CHECK(first.size() < 24);
  for (int i = 1; i < 100; ++i) {
    auto trembling = pose;
    for (double& x : trembling.p) x += 1e-4 * (2.0 * steps.uniform() - 1.0);
    trembling.q = {-pose.q[0], -pose.q[1], -pose.q[2], -pose.q[3]};  // the same turn
    writer.add(0.1 * i, std::vector{trembling}, std::vector<std::uint8_t>{0});
  }
  CHECK(writer.take().empty());
  writer.add(10.0, std::vector{pose}, std::vector<std::uint8_t>{kGripHeld});
  const auto last = first + writer.take();
  MotionCursor cursor(last, {1, 1});
  CHECK(cursor.next());
  CHECK(cursor.gripped().empty());
  CHECK(cursor.next());
  CHECK(cursor.time_s() == doctest::Approx(10.0));
  CHECK(cursor.moved().empty());
  CHECK(cursor.grips().at(0) == kGripHeld);
  CHECK_FALSE(cursor.next());
}

TEST_CASE("motion: a place that is none is left out, and the stream stays whole") {
  MotionWriter writer({1, 0});
  Pose pose;
  CHECK(writer.add(0.0, std::vector{pose}, {}));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 1e7}) {
    auto wrong = pose;
    wrong.p[1] = bad;
    CHECK_FALSE(writer.add(0.1, std::vector{wrong}, {}));
    auto turned = pose;
    turned.q[2] = bad;
    CHECK_FALSE(writer.add(0.1, std::vector{turned}, {}));
  }
  pose.p[0] = 1.0;
  CHECK(writer.add(0.2, std::vector{pose}, {}));
  const auto bytes = writer.take();
  MotionCursor cursor(bytes, {1, 0});
  CHECK(cursor.next());
  CHECK(cursor.next());
  CHECK(cursor.poses()[0].p[0] == doctest::Approx(1.0));
  CHECK_FALSE(cursor.next());
}

TEST_CASE("motion: the writer stops at its limit") {
  MotionWriter writer({200, 0});
  Steps steps(3);
  std::size_t bytes = 0;
  std::vector<Pose> poses(200);
  for (int i = 0; i < 6000; ++i) {
    for (auto& pose : poses) pose = random_pose(steps);
    REQUIRE(writer.add(0.1 * i, poses, {}));
    bytes += writer.take().size();
    if (!writer.fault().empty()) break;
  }
  CHECK(writer.fault() == "more than 8 MiB of frames");
  CHECK(bytes < kMaxMotionBytes + 200 * 30);
}

TEST_CASE("motion: what is taken at once goes in a line of the protocol") {
  MotionWriter writer({200, 0});
  Steps steps(4);
  std::vector<Pose> poses(200);
  for (int i = 0; i < 600; ++i) {
    for (auto& pose : poses) pose = random_pose(steps);
    REQUIRE(writer.add(0.1 * i, poses, {}));
  }
  CHECK(writer.fault() == "more than 512 KiB of frames in one action");
  const auto taken = writer.take();
  CHECK(taken.size() < kMaxMotionAtOnce + 200 * 30);
  // Frames after an omitted one are omitted too: they would start from unknown poses.
  writer.add(100.0, poses, {});
  CHECK(writer.take().empty());
  MotionCursor cursor(taken, {200, 0});
  while (cursor.next()) continue;
  CHECK(cursor.fault().empty());
}

TEST_CASE("motion: whatever the bytes are, reading ends, within what there is") {
  const auto whole = sample_recording().frames;
  const auto read = [](const std::string& bytes) {
    MotionCursor cursor(bytes, {3, 2});
    std::size_t frames = 0;
    while (cursor.next()) {
      ++frames;
      REQUIRE(frames <= bytes.size());
      for (const auto& pose : cursor.poses()) {
        for (const double x : pose.p) REQUIRE(std::abs(x) <= kFarthest_m);
        for (const double x : pose.q) REQUIRE(std::abs(x) <= 1.0 + 1e-9);
      }
    }
    CHECK_FALSE(cursor.next());
    CHECK((cursor.byte() == bytes.size() || !cursor.fault().empty()));
    return cursor.fault();
  };
  CHECK(read(whole).empty());
  std::size_t cut_off = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    if (!read(whole.substr(0, size)).empty()) ++cut_off;
  }
  CHECK(cut_off == whole.size() - 20);  // between frames nothing is missing
  Steps steps(4);
  for (int i = 0; i < 20000; ++i) {
    auto bytes = whole;
    const auto changes = 1 + steps.next() % 4;
    for (std::uint64_t k = 0; k < changes; ++k) {
      bytes[steps.next() % bytes.size()] = static_cast<char>(steps.next());
    }
    if (steps.next() % 4 == 0) bytes.resize(steps.next() % bytes.size());
    read(bytes);
  }
  for (int i = 0; i < 2000; ++i) {
    std::string noise(steps.next() % 200, '\0');
    for (char& c : noise) c = static_cast<char>(steps.next());
    read(noise);
  }
  CHECK(read(std::string(100, '\xff')) == "a number of a frame is too large");
}

}  // namespace
}  // namespace parallax::harness
