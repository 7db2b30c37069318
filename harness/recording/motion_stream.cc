#include "harness/recording/motion_stream.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kOne = 4096;                  // of a quaternion's component
constexpr std::int64_t kFarthest = 2'000'000'000;    // kFarthest_m in steps
constexpr std::int64_t kLatest = 1'000'000'000'000;  // 30 years in steps of time
constexpr double kTremble = 0.75;                    // of a step
constexpr std::array<std::int64_t, 7> kAtOrigin = {0, 0, 0, kOne, 0, 0, 0};

void put_varint(std::string& out, std::uint64_t value) {
  for (; value >= 0x80U; value >>= 7U) out.push_back(static_cast<char>((value & 0x7fU) | 0x80U));
  out.push_back(static_cast<char>(value));
}

std::uint64_t zigzag(std::int64_t value) {
  return (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63);
}

std::int64_t unzigzag(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1U) ^ -static_cast<std::int64_t>(value & 1U);
}

bool is_sane(const Pose& pose) {
  double norm = 0.0;
  for (const double x : pose.q) norm += x * x;
  bool sane = norm > 0.9 && norm < 1.1;  // false for NaN, too
  for (const double x : pose.p) sane = sane && std::abs(x) < kFarthest_m;
  return sane;
}

/// The pose in steps, as far as it has left `before`.
std::array<std::int64_t, 7> in_steps(const Pose& pose, const std::array<std::int64_t, 7>& before) {
  // q and -q are the same turn: the one nearer to what was written changes less.
  double along = 0.0;
  for (std::size_t i = 0; i < 4; ++i) along += pose.q[i] * static_cast<double>(before[3 + i]);
  const double sign = along < 0.0 ? -1.0 : 1.0;
  auto out = before;
  for (std::size_t i = 0; i < 7; ++i) {
    const double exact =
        i < 3 ? pose.p[i] / kFramePosition_m : sign * pose.q[i - 3] / kFrameQuaternion;
    if (std::abs(exact - static_cast<double>(before[i])) < kTremble) continue;
    out[i] = std::llround(exact);
  }
  return out;
}

}  // namespace

MotionWriter::MotionWriter(MotionShape shape) : shape_(shape) { begin(); }

void MotionWriter::begin() {
  written_.assign(shape_.bodies, kAtOrigin);
  grips_.assign(shape_.bodies * shape_.grippers, 0);
  time_ = 0;
  fresh_ = true;
  total_ = 0;
  at_once_ = false;
  bytes_.clear();
}

bool MotionWriter::add(double time_s, std::span<const Pose> poses,
                       std::span<const std::uint8_t> grips) {
  PARALLAX_REQUIRE(poses.size() == shape_.bodies, "one pose for each moving body");
  PARALLAX_REQUIRE(grips.empty() || grips.size() == grips_.size(),
                   "one grip for each body and gripper");
  if (!std::all_of(poses.begin(), poses.end(), is_sane)) return false;
  at_once_ = at_once_ || bytes_.size() >= kMaxMotionAtOnce;
  if (at_once_ || total_ >= kMaxMotionBytes) return true;
  frame_.clear();
  std::uint64_t moved = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto now = in_steps(poses[i], written_[i]);
    unsigned mask = 0;
    for (std::size_t k = 0; k < 7; ++k) mask |= now[k] != written_[i][k] ? 1U << k : 0U;
    // In the first frame everything has a place, the origin as well.
    if (mask == 0 && !fresh_) continue;
    put_varint(frame_, i - next);
    next = i + 1;
    frame_.push_back(static_cast<char>(mask));
    for (std::size_t k = 0; k < 7; ++k) {
      if ((mask >> k & 1U) != 0) put_varint(frame_, zigzag(now[k] - written_[i][k]));
    }
    written_[i] = now;
    ++moved;
  }
  std::string gripped;
  std::uint64_t changed = 0;
  next = 0;
  for (std::size_t i = 0; i < grips.size(); ++i) {
    if (grips[i] == grips_[i]) continue;
    put_varint(gripped, i - next);
    next = i + 1;
    gripped.push_back(static_cast<char>(grips[i]));
    grips_[i] = grips[i];
    ++changed;
  }
  if (moved == 0 && changed == 0 && !fresh_) return true;
  const auto time = std::max<std::int64_t>(time_, std::llround(time_s / kFrameTime_s));
  const auto before = bytes_.size();
  put_varint(bytes_, static_cast<std::uint64_t>(time - time_));
  put_varint(bytes_, moved);
  bytes_ += frame_;
  put_varint(bytes_, changed);
  bytes_ += gripped;
  total_ += bytes_.size() - before;
  time_ = time;
  fresh_ = false;
  return true;
}

std::string MotionWriter::fault() const {
  if (at_once_) return "more than 512 KiB of frames in one action";
  return total_ < kMaxMotionBytes ? "" : "more than 8 MiB of frames";
}

std::string MotionWriter::take() { return std::exchange(bytes_, {}); }

MotionCursor::MotionCursor(std::string_view bytes, MotionShape shape)
    : bytes_(bytes),
      shape_(shape),
      steps_(shape.bodies, kAtOrigin),
      poses_(shape.bodies),
      grips_(shape.bodies * shape.grippers, 0) {}

bool MotionCursor::fail(const char* why) {
  if (fault_.empty()) fault_ = why;
  return false;
}

bool MotionCursor::varint(std::uint64_t& out) {
  out = 0;
  for (unsigned shift = 0; shift < 63; shift += 7) {
    if (at_ == bytes_.size()) return fail("the frames end within a number");
    const auto byte = static_cast<unsigned char>(bytes_[at_++]);
    out |= static_cast<std::uint64_t>(byte & 0x7fU) << shift;
    if ((byte & 0x80U) == 0) return true;
  }
  return fail("a number of a frame is too large");
}

bool MotionCursor::next() {
  if (!fault_.empty() || at_ == bytes_.size()) return false;
  std::uint64_t passed = 0;
  if (!varint(passed)) return false;
  if (passed > static_cast<std::uint64_t>(kLatest - time_)) return fail("a frame is too late");
  time_ += static_cast<std::int64_t>(passed);
  return read_poses() && read_grips();
}

bool MotionCursor::read_poses() {
  moved_.clear();
  std::uint64_t count = 0;
  if (!varint(count)) return false;
  if (count > shape_.bodies) return fail("a frame moves more bodies than there are");
  std::uint64_t body = 0;
  for (std::uint64_t i = 0; i < count; ++i, ++body) {
    std::uint64_t gap = 0;
    if (!varint(gap)) return false;
    if (gap >= shape_.bodies - body) return fail("a frame moves a body that is not there");
    body += gap;
    if (!read_pose(static_cast<std::size_t>(body))) return false;
    // A further one needs a number that is left.
    if (i + 1 < count && body + 1 >= shape_.bodies) {
      return fail("a frame moves a body that is not there");
    }
  }
  return true;
}

bool MotionCursor::read_pose(std::size_t body) {
  if (at_ == bytes_.size()) return fail("the frames end within a pose");
  const auto mask = static_cast<unsigned char>(bytes_[at_++]);
  if (mask > 0x7fU) return fail("a pose has more than seven numbers");
  auto& steps = steps_[body];
  for (std::size_t k = 0; k < 7; ++k) {
    if ((mask >> k & 1U) == 0) continue;
    std::uint64_t coded = 0;
    if (!varint(coded)) return false;
    const auto change = unzigzag(coded);
    const auto bound = k < 3 ? kFarthest : kOne + kOne / 16;
    if (change > 2 * bound || change < -2 * bound) return fail("a body is nowhere");
    steps[k] += change;
    if (steps[k] > bound || steps[k] < -bound) return fail("a body is nowhere");
  }
  auto& pose = poses_[body];
  double norm = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto part = static_cast<double>(steps[3 + k]);
    norm += part * part;
  }
  norm = std::sqrt(norm);
  if (norm < 0.5 * static_cast<double>(kOne)) return fail("the turn of a body is none");
  for (std::size_t k = 0; k < 3; ++k) pose.p[k] = static_cast<double>(steps[k]) * kFramePosition_m;
  for (std::size_t k = 0; k < 4; ++k) pose.q[k] = static_cast<double>(steps[3 + k]) / norm;
  moved_.push_back(body);
  return true;
}

bool MotionCursor::read_grips() {
  gripped_.clear();
  std::uint64_t count = 0;
  if (!varint(count)) return false;
  if (count > grips_.size()) return fail("a frame changes more grips than there are");
  std::uint64_t slot = 0;
  for (std::uint64_t i = 0; i < count; ++i, ++slot) {
    std::uint64_t gap = 0;
    if (!varint(gap)) return false;
    if (slot >= grips_.size() || gap >= grips_.size() - slot) {
      return fail("a frame changes a grip that is not there");
    }
    slot += gap;
    if (at_ == bytes_.size()) return fail("the frames end within a grip");
    const auto grip = static_cast<unsigned char>(bytes_[at_++]);
    if (grip > 15U) return fail("a grip has a bit that means nothing");
    grips_[static_cast<std::size_t>(slot)] = grip;
    gripped_.push_back(static_cast<std::size_t>(slot));
  }
  return true;
}

}  // namespace parallax::harness
