#include "harness/recording/recording_format.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/base/json.h"
#include "harness/recording/bytes.h"
#include "harness/recording/scene_json.h"

namespace parallax::harness {
namespace {

using HeadJson = nlohmann::json;
using OrderedHeadJson = nlohmann::ordered_json;

// A transfer that changes the ends of lines changes the magic as well.
constexpr std::string_view kMagic = "PLXREC\r\n";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeadAt = kMagic.size() + 8;  // behind version and size of the head
constexpr std::size_t kLargestHead = std::size_t{4} << 20U;
constexpr std::size_t kLargestFrames = kMaxMotionBytes + (std::size_t{1} << 20U);
constexpr std::size_t kLargestTable = std::size_t{512} << 20U;

OrderedHeadJson value_json(const RecordedValues::mapped_type& value) {
  return std::visit([](const auto& plain) { return OrderedHeadJson(plain); }, value);
}

OrderedHeadJson values_json(const RecordedValues& values) {
  OrderedHeadJson out = OrderedHeadJson::object();
  for (const auto& [name, value] : values) out[name] = value_json(value);
  return out;
}

/// The entries that are not in `before`, or differ there; null for those that are only there.
OrderedHeadJson changes_json(const RecordedValues& before, const RecordedValues& after) {
  OrderedHeadJson::object_t out;
  for (const auto& [name, value] : after) {
    const auto found = before.find(name);
    if (found == before.end() || found->second != value) out.push_back({name, value_json(value)});
  }
  for (const auto& [name, value] : before) {
    if (!after.contains(name)) out.push_back({name, nullptr});
  }
  return out;
}

OrderedHeadJson head_json(const Recording& recording) {
  OrderedHeadJson out{{"trace", recording.trace},   {"sample", recording.sample},
                      {"seed", recording.seed},     {"simulator", recording.simulator},
                      {"status", recording.status}, {"interval_s", recording.interval_s}};
  if (!recording.missing.empty()) out["missing"] = recording.missing;
  auto& events = out["events"] = OrderedHeadJson::array();
  for (const auto& event : recording.events) {
    OrderedHeadJson json{{"name", event.name},
                         {"begin_s", event.begin_s},
                         {"end_s", event.end_s},
                         {"status", event.status}};
    if (!event.reason.empty()) json["reason"] = event.reason;
    if (!event.margins.empty()) json["margins"] = values_json(event.margins);
    events.push_back(std::move(json));
  }
  auto& observations = out["observations"] = OrderedHeadJson::array();
  const RecordedValues nothing;
  const auto* before = &nothing;
  for (const auto& values : recording.observations) {
    observations.push_back(changes_json(*before, values));
    before = &values;
  }
  return out;
}

/// Reads the head and keeps the first thing that is wrong.
class HeadReader {
 public:
  /// All but the scene.
  std::optional<Recording> read(const HeadJson& json) {
    Recording out;
    if (!json.is_object()) return failed("the head is no object");
    out.trace = whole(json, "trace");
    out.sample = whole(json, "sample");
    out.seed = base::json_as<std::uint64_t>(member(json, "seed")).value_or(0);
    out.simulator = text(json, "simulator");
    out.status = text(json, "status");
    out.interval_s = number(json, "interval_s");
    if (json.contains("missing")) out.missing = text(json, "missing");
    read_events(member(json, "events"), out);
    read_observations(member(json, "observations"), out);
    if (!why_.empty()) return std::nullopt;
    return out;
  }
  const std::string& why() const { return why_; }

 private:
  std::optional<Recording> failed(std::string why) {
    fail(std::move(why));
    return std::nullopt;
  }
  void fail(std::string why) {
    if (why_.empty()) why_ = std::move(why);
  }
  const HeadJson& member(const HeadJson& json, const char* name) {
    static const HeadJson kNone;
    const auto* found = base::json_member(json, name);
    if (found == nullptr) fail("`" + std::string(name) + "` is missing in the head");
    return found == nullptr ? kNone : *found;
  }
  template <typename T>
  T take(const HeadJson& json, const char* name) {
    const auto value = base::json_as<T>(member(json, name));
    if (!value) fail("`" + std::string(name) + "` in the head is of another type");
    return value.value_or(T());
  }
  std::string text(const HeadJson& json, const char* name) { return take<std::string>(json, name); }
  std::int64_t whole(const HeadJson& json, const char* name) {
    const auto value = take<std::int64_t>(json, name);
    if (value < 0) fail("`" + std::string(name) + "` in the head is negative");
    return value;
  }
  double number(const HeadJson& json, const char* name) {
    const auto value = take<double>(json, name);
    if (!(value >= 0.0 && value <= 1e9))
      fail("`" + std::string(name) + "` is not within 0 to 1e9 s");
    return value;
  }

  static std::optional<RecordedValues::mapped_type> value_of(const HeadJson& json) {
    if (const auto flag = base::json_as<bool>(json)) return *flag;
    if (const auto whole = base::json_as<std::int64_t>(json)) return *whole;
    if (const auto number = base::json_as<double>(json)) {
      if (std::isfinite(*number)) return *number;
    }
    if (auto text = base::json_as<std::string>(json)) return *std::move(text);
    return std::nullopt;
  }

  void change(const HeadJson& json, RecordedValues& values) {
    if (!json.is_object()) return fail("values in the head are no object");
    for (const auto& [name, item] : json.items()) {
      if (item.is_null()) {
        values.erase(name);
      } else if (auto value = value_of(item)) {
        values.insert_or_assign(name, *std::move(value));
      } else {
        fail("`" + name + "` in the head is neither boolean, number nor text");
      }
    }
  }

  void read_events(const HeadJson& json, Recording& out) {
    if (!json.is_array()) return fail("`events` in the head is no list");
    for (const auto& item : json) {
      RecordedEvent event;
      event.name = text(item, "name");
      event.begin_s = number(item, "begin_s");
      event.end_s = number(item, "end_s");
      event.status = text(item, "status");
      if (item.contains("reason")) event.reason = text(item, "reason");
      if (item.contains("margins")) change(item["margins"], event.margins);
      if (!why_.empty()) return;
      out.events.push_back(std::move(event));
    }
  }

  /// Each is as long as all before it together, so that many of them would fill the memory.
  void read_observations(const HeadJson& json, Recording& out) {
    constexpr std::size_t kMostValues = 2'000'000;
    if (!json.is_array()) return fail("`observations` in the head is no list");
    std::size_t count = 0;
    for (const auto& item : json) {
      auto values = out.observations.empty() ? RecordedValues() : out.observations.back();
      change(item, values);
      count += values.size() + 1;
      if (count > kMostValues) fail("there are more than 2000000 observed values");
      if (!why_.empty()) return;
      out.observations.push_back(std::move(values));
    }
  }

  std::string why_;
};

/// Goes through the frames and keeps what is wrong with them. A short file could be a table without
/// end: everything hangs on one body that moves in all frames, or names are long.
std::optional<BadRecording> fault_of_frames(const Recording& recording) {
  constexpr std::size_t kRow = 64;  // bytes beside the names
  const auto& scene = recording.scene;
  const auto moving = scene.moving();
  // By what moves, of all that goes along.
  std::vector<std::size_t> row_bytes(scene.bodies.size(), 0);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    row_bytes[scene.bodies[i].on.value_or(i)] += kRow + scene.bodies[i].name.size();
  }
  std::size_t bytes = 0;
  MotionCursor cursor(recording.frames, {moving.size(), scene.grippers.size()});
  while (cursor.next()) {
    for (const auto index : cursor.moved()) bytes += row_bytes[moving[index]];
    for (const auto slot : cursor.gripped()) {
      bytes += kRow + scene.grippers[slot % scene.grippers.size()].size() +
               scene.bodies[moving[slot / scene.grippers.size()]].name.size();
    }
    if (bytes > kLargestTable) {
      return BadRecording{cursor.byte(), "its motion would fill more than 512 MiB as a table"};
    }
  }
  if (cursor.fault().empty()) return std::nullopt;
  return BadRecording{cursor.byte(), cursor.fault()};
}

}  // namespace

std::string encode(const Recording& recording) {
  // Two objects of which each has a member, made one.
  auto head = base::json_text(head_json(recording));
  head.back() = ',';
  head += std::string_view(scene_text(recording.scene)).substr(1);
  std::string out(kMagic);
  put_u32(out, kVersion);
  put_u32(out, static_cast<std::uint32_t>(head.size()));
  out += head;
  put_u32(out, static_cast<std::uint32_t>(recording.frames.size()));
  out += recording.frames;
  put_u32(out, crc32(out));
  return out;
}

std::variant<Recording, BadRecording> decode_recording(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) {
    return BadRecording{0, "the file does not begin as a recording does"};
  }
  if (bytes.size() < kHeadAt)
    return BadRecording{bytes.size(), "the file ends within its first line"};
  if (u32_at(bytes, kMagic.size()) != kVersion) {
    return BadRecording{kMagic.size(), "it is of version " +
                                           std::to_string(u32_at(bytes, kMagic.size())) +
                                           ", this program reads version 1"};
  }
  const std::size_t head_size = u32_at(bytes, kMagic.size() + 4);
  if (head_size > kLargestHead) return BadRecording{kMagic.size() + 4, "its head is too large"};
  if (bytes.size() - kHeadAt < head_size + 4) {
    return BadRecording{bytes.size(), "the file ends within its head"};
  }
  const auto frames_at = kHeadAt + head_size + 4;
  const std::size_t frames_size = u32_at(bytes, frames_at - 4);
  if (frames_size > kLargestFrames) return BadRecording{frames_at - 4, "its frames are too large"};
  if (bytes.size() - frames_at < frames_size || bytes.size() - frames_at - frames_size < 4) {
    return BadRecording{bytes.size(), "the file ends within its frames"};
  }
  const auto end = frames_at + frames_size;
  if (bytes.size() != end + 4) return BadRecording{end + 4, "something follows its end"};
  if (u32_at(bytes, end) != crc32(bytes.substr(0, end))) {
    return BadRecording{end, "its checksum is that of another file"};
  }
  const auto head = bytes.substr(kHeadAt, head_size);
  const auto json = base::parse_json(head);
  if (json.is_discarded()) return BadRecording{kHeadAt, "its head is not JSON"};
  HeadReader reader;
  auto recording = reader.read(json);
  if (!recording) return BadRecording{kHeadAt, reader.why()};
  std::string why;
  auto scene = scene_from_text(head, why);
  if (!scene) return BadRecording{kHeadAt, why};
  recording->scene = *std::move(scene);
  recording->frames = bytes.substr(frames_at, frames_size);
  if (auto bad = fault_of_frames(*recording)) return BadRecording{frames_at + bad->byte, bad->why};
  return *std::move(recording);
}

}  // namespace parallax::harness
