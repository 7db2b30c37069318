#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compiler/base/suggest.h"
#include "harness/monitor/log_entry.h"

namespace parallax::harness {
namespace {

const std::vector<std::string> kKeys = {"t", "event", "outcome", "reason", "started", "state"};

/// Takes a line as it is parsed, without building a document.
class LineHandler final : public nlohmann::json_sax<nlohmann::json> {
 public:
  LineHandler(const ObservationReader& reader, LogEntry& entry, ForeignNames& foreign)
      : reader_(reader), entry_(entry), foreign_(foreign) {}

  const std::string& problem() const { return problem_; }
  std::size_t position() const { return position_; }
  bool has_t() const { return has_t_; }

  bool null() override {
    if (place_ == Place::kState) return true;  // not reported
    return wrong("a value");
  }
  bool boolean(bool value) override {
    return place_ == Place::kState ? take(value) : wrong("true or false");
  }
  bool number_integer(number_integer_t value) override {
    return place_ == Place::kState ? take(std::int64_t{value}) : time(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    if (place_ != Place::kState) return time(static_cast<double>(value));
    return value <= INT64_MAX ? take(static_cast<std::int64_t>(value))
                              : take(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override {
    return place_ == Place::kState ? take(value) : time(value);
  }
  bool string(string_t& value) override {
    if (place_ == Place::kState) return take(std::move(value));
    if (place_ == Place::kEvents) {
      entry_.events->push_back(event_name(value));
      return true;
    }
    if (place_ != Place::kEntry) return wrong("a text");
    if (key_ == "event") {
      entry_.events = std::vector<std::string>{event_name(value)};
    } else if (key_ == "started") {
      entry_.started = event_name(value);
    } else if (key_ == "outcome") {
      return fine(take_outcome(value, entry_));
    } else if (key_ == "reason") {
      entry_.reason = std::move(value);
    } else {
      return wrong("a text");
    }
    return true;
  }
  bool binary(binary_t&) override { return wrong("binary"); }
  bool start_object(std::size_t) override {
    if (place_ == Place::kOutside) {
      place_ = Place::kEntry;
      return true;
    }
    if (place_ != Place::kEntry || key_ != "state") return wrong("an object");
    place_ = Place::kState;
    entry_.has_state = true;
    return true;
  }
  bool key(string_t& name) override {
    key_.swap(name);
    if (place_ == Place::kState) return true;
    for (std::size_t i = 0; i < kKeys.size(); ++i) {
      if (key_ != kKeys[i]) continue;
      if (seen_[i]) return fine(fmt::format("`{}` is there twice", key_));
      return seen_[i] = true;
    }
    const auto near = base::nearest_name(key_, kKeys);
    return fine(fmt::format("`{}` is no key of a line of a log{}", key_,
                            near ? fmt::format("; is `{}` meant?", *near) : std::string()));
  }
  bool end_object() override {
    place_ = place_ == Place::kState ? Place::kEntry : Place::kOutside;
    return true;
  }
  bool start_array(std::size_t) override {
    if (place_ != Place::kEntry || key_ != "event") return wrong("a list");
    place_ = Place::kEvents;
    entry_.events.emplace();
    return true;
  }
  bool end_array() override {
    place_ = Place::kEntry;
    return true;
  }
  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    position_ = position;
    const std::string_view text = error.what();
    problem_ = text.find("out_of_range") != std::string_view::npos
                   ? "a number is too large"
                   : "it is no JSON object as far as it goes";
    return false;
  }

 private:
  enum class Place : std::uint8_t { kOutside, kEntry, kEvents, kState };

  template <typename T>
  bool take(T value) {
    return fine(take_value(reader_, key_, Value(std::move(value)), entry_, foreign_));
  }
  bool time(double value) {
    if (place_ != Place::kEntry || key_ != "t") return wrong("a number");
    entry_.t = value;
    return has_t_ = true;
  }
  bool fine(std::string problem) {
    problem_ = std::move(problem);
    return problem_.empty();
  }
  bool wrong(std::string_view what) {
    if (place_ == Place::kOutside) return fine("it is no JSON object");
    return fine(fmt::format("{} is not what `{}` can be", what, key_));
  }

  const ObservationReader& reader_;
  LogEntry& entry_;
  ForeignNames& foreign_;
  Place place_ = Place::kOutside;
  std::string key_;
  std::array<bool, 6> seen_{};
  bool has_t_ = false;
  std::string problem_;
  std::size_t position_ = 0;
};

}  // namespace

std::optional<LogError> read_json_line(std::string_view line, const ObservationReader& reader,
                                       LogEntry& entry, ForeignNames& foreign) {
  entry.clear(reader.variables().size());
  LineHandler handler(reader, entry, foreign);
  if (!nlohmann::json::sax_parse(line.begin(), line.end(), &handler)) {
    return LogError{std::max<std::size_t>(1, handler.position()), handler.problem()};
  }
  auto problem = incomplete(entry, handler.has_t());
  if (!problem.empty()) return LogError{1, std::move(problem)};
  return std::nullopt;
}

}  // namespace parallax::harness
