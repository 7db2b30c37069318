#include "harness/monitor/log_entry.h"

#include <fmt/format.h>

#include <cmath>

namespace parallax::harness {

void LogEntry::clear(std::size_t variables) {
  t = 0.0;
  events.reset();
  ok.reset();
  reason.clear();
  started.reset();
  has_state = false;
  values.assign(variables, std::nullopt);
}

std::string take_value(const ObservationReader& reader, std::string_view name, Value value,
                       LogEntry& entry, ForeignNames& foreign) {
  entry.has_state = true;
  const auto variable = reader.variable(name);
  if (!variable) {
    if (foreign.size() < kMaxForeignNames && !foreign.contains(name)) foreign.emplace(name);
    return {};
  }
  if (!reader.fits(*variable, value)) {
    static constexpr std::array<const char*, 3> kWanted = {"a number", "true or false", "a text"};
    return fmt::format("`{}` is {} where the mapping asks for it", name,
                       kWanted[static_cast<std::size_t>(reader.kind(*variable))]);
  }
  const auto* real = std::get_if<double>(&value);
  if (real != nullptr && !std::isfinite(*real)) {
    return fmt::format("`{}` is no finite number", name);
  }
  auto& place = entry.values[*variable];
  if (place) return fmt::format("`{}` is there twice", name);
  place = std::move(value);
  return {};
}

std::string take_outcome(std::string_view word, LogEntry& entry) {
  if (word != "ok" && word != "failed") {
    return fmt::format("an outcome is `ok` or `failed`, not `{}`", word);
  }
  entry.ok = word == "ok";
  return {};
}

std::string event_name(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c != ' ' && c != '\t') out += c;
  }
  // An event without arguments may be written without parentheses.
  if (!out.empty() && out.find('(') == std::string::npos) out += "()";
  return out;
}

std::string incomplete(const LogEntry& entry, bool has_t) {
  if (!has_t) return "`t`, the time in seconds, is missing";
  if ((entry.ok || !entry.reason.empty()) && !entry.events) {
    return "an outcome is that of an `event`, and there is none";
  }
  if (!entry.events && !entry.started && !entry.has_state) {
    return "it says nothing: `event`, `started` and `state` are missing";
  }
  return {};
}

}  // namespace parallax::harness
