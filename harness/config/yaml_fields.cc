#include "harness/config/yaml_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/scenarios.h"
#include "compiler/base/suggest.h"
#include "harness/region/angle_range.h"

namespace parallax::harness {
namespace {

std::string strip_plus(const std::string& text) {
  return text.starts_with('+') ? text.substr(1) : text;
}

bool looks_numeric(const std::string& text) {
  // from_chars alone would take "inf", "nan" and hexadecimal words.
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) {
    return base::is_digit(c) || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
  });
  return plain && std::any_of(text.begin(), text.end(), base::is_digit);
}

template <typename T>
std::optional<T> parsed(const std::string& text) {
  const auto digits = strip_plus(text);
  if (!looks_numeric(digits)) return std::nullopt;
  T value{};
  const char* end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc() || rest != end) return std::nullopt;
  return value;
}

bool is_infinite_or_nan(const std::string& text) {
  std::string word;
  for (const char c : text) word += base::to_lower(c);
  if (word.starts_with('+') || word.starts_with('-')) word.erase(0, 1);
  if (word.starts_with('.')) word.erase(0, 1);
  return word == "inf" || word == "nan" || word == "infinity";
}

std::optional<std::int64_t> read_integer(const YamlNode& node, std::string_view name,
                                         std::int64_t lower, std::int64_t upper,
                                         base::DiagnosticSink& sink) {
  const auto value =
      node.is_scalar() && !node.quoted ? parsed<std::int64_t>(node.text) : std::nullopt;
  if (!value) {
    sink.error(codes::kWrongYamlKind, node.range, name, describe(node), "an integer");
    return std::nullopt;
  }
  if (*value < lower || *value > upper) {
    sink.error(codes::kYamlOutOfBounds, node.range, name, *value,
               upper == std::numeric_limits<std::int64_t>::max()
                   ? fmt::format("at least {}", lower)
                   : fmt::format("from {} to {}", lower, upper));
    return std::nullopt;
  }
  return value;
}

}  // namespace

bool NumberBounds::admits(double value) const {
  const bool above = lower_open ? value > lower : value >= lower;
  const bool below = upper_open ? value < upper : value <= upper;
  return above && below;
}

std::string NumberBounds::text() const {
  std::string out;
  if (std::isfinite(lower)) out = fmt::format("{} {}", lower_open ? "above" : "at least", lower);
  if (std::isfinite(upper)) {
    if (!out.empty()) out += " and ";
    out += fmt::format("{} {}", upper_open ? "below" : "at most", upper);
  }
  return out;
}

void add_suggestion(base::DiagnosticBuilder& builder, std::string_view name,
                    std::span<const std::string> known, std::string_view list_title) {
  builder.note(known.empty() ? fmt::format("{}: there are none", list_title)
                             : fmt::format("{}: {}", list_title, fmt::join(known, ", ")));
  if (const auto near = base::nearest_name(name, known)) {
    builder.fix(fmt::format("replace `{}` with `{}`", name, *near));
  }
}

std::optional<double> read_number(const YamlNode& node, std::string_view name,
                                  const NumberBounds& bounds, base::DiagnosticSink& sink) {
  const bool plain = node.is_scalar() && !node.quoted;
  const auto value = plain ? parsed<double>(node.text) : std::nullopt;
  if (!value) {
    // Also what from_chars cannot hold, such as 1e999.
    if (plain && (is_infinite_or_nan(node.text) || looks_numeric(node.text))) {
      sink.error(codes::kYamlNotFinite, node.range, node.text);
    } else {
      sink.error(codes::kWrongYamlKind, node.range, name, describe(node), "a number");
    }
    return std::nullopt;
  }
  if (!bounds.admits(*value)) {
    sink.error(codes::kYamlOutOfBounds, node.range, name, node.text, bounds.text());
    return std::nullopt;
  }
  return value;
}

bool check_radians(const Interval& angles_rad, const YamlNode& node, std::string_view name,
                   base::DiagnosticSink& sink) {
  const auto fault = angle_fault(angles_rad);
  if (fault) sink.error(codes::kBadWorld, node.range, name, *fault);
  return !fault;
}

std::optional<std::string> read_text(const YamlNode& node, std::string_view name,
                                     base::DiagnosticSink& sink) {
  ReadLog::text(node);
  if (node.is_scalar() && !node.text.empty()) return node.text;
  sink.error(codes::kWrongYamlKind, node.range, name, describe(node), "a text");
  return std::nullopt;
}

std::optional<Interval> read_interval(const YamlNode& node, std::string_view name,
                                      base::DiagnosticSink& sink) {
  if (node.is_scalar()) {
    const auto value = read_number(node, name, kAnyNumber, sink);
    if (!value) return std::nullopt;
    return Interval{*value, *value, true};
  }
  if (!node.is_list() || node.items.size() != 2) {
    sink.error(codes::kWrongYamlKind, node.range, name, describe(node),
               "a list of a lower and an upper bound");
    return std::nullopt;
  }
  const auto lower = read_number(node.items[0], name, kAnyNumber, sink);
  const auto upper = read_number(node.items[1], name, kAnyNumber, sink);
  if (!lower || !upper) return std::nullopt;
  return Interval{*lower, *upper, false};
}

std::optional<Value> read_value(const YamlNode& node, std::string_view name,
                                base::DiagnosticSink& sink) {
  if (!node.is_scalar()) {
    sink.error(codes::kWrongYamlKind, node.range, name, describe(node), "a single value");
    return std::nullopt;
  }
  if (node.quoted) return Value(node.text);
  if (node.text == "true") return Value(true);
  if (node.text == "false") return Value(false);
  if (const auto whole = parsed<std::int64_t>(node.text)) return Value(*whole);
  if (const auto number = parsed<double>(node.text)) return Value(*number);
  if (node.text.starts_with('.') && is_infinite_or_nan(node.text)) {
    sink.error(codes::kYamlNotFinite, node.range, node.text);
    return std::nullopt;
  }
  return Value(node.text);
}

YamlNode with_key(const YamlNode& node, std::string_view key) {
  if (!node.is_scalar()) return node;
  ReadLog::stands_for(node, key);
  YamlNode map = node;  // with its id, so that what is said of the map is said of the scalar
  map.kind = YamlNode::Kind::kMap;
  map.text.clear();
  map.quoted = false;
  map.entries.push_back({std::string(key), node.range, node});
  return map;
}

YamlFields::YamlFields(const YamlNode& node, std::string what, base::DiagnosticSink& sink)
    : node_(node), what_(std::move(what)), sink_(sink) {
  if (!node.is_map()) {
    sink.error(codes::kWrongYamlKind, node.range, what_, describe(node), "a map");
  }
}

YamlFields& YamlFields::only(std::span<const std::string_view> known) {
  ReadLog::known(node_, known);
  const std::vector<std::string> names(known.begin(), known.end());
  for (const auto& entry : node_.entries) {
    if (std::find(names.begin(), names.end(), entry.key) != names.end()) continue;
    auto error = sink_.error(codes::kUnknownKey, entry.key_range, entry.key, what_);
    if (std::find(elsewhere_.begin(), elsewhere_.end(), entry.key) != elsewhere_.end()) {
      error.note(fmt::format("`{}` is a key of `{}`", entry.key, section_));
      error.help(fmt::format("Move it below `{}`.", section_));
    } else {
      add_suggestion(error, entry.key, names, "known keys");
    }
  }
  return *this;
}

std::string YamlFields::name_of(std::string_view key) const { return fmt::format("`{}`", key); }

const YamlNode* YamlFields::find(std::string_view key) const {
  const auto* entry = node_.find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

const YamlNode* YamlFields::require(std::string_view key) const {
  ReadLog::required(node_, key);
  const auto* value = find(key);
  if (value == nullptr && node_.is_map()) {
    sink_.error(codes::kMissingKey, node_.range, what_, key);
  }
  return value;
}

void YamlFields::number(std::string_view key, const NumberBounds& bounds, double& out) const {
  ReadLog::fallback(node_, key, out);
  std::optional<double> value;
  number(key, bounds, value);
  if (value) out = *value;
}

void YamlFields::number(std::string_view key, const NumberBounds& bounds,
                        std::optional<double>& out) const {
  const auto* value = find(key);
  if (value == nullptr) return;
  if (const auto read = read_number(*value, name_of(key), bounds, sink_)) out = read;
}

void YamlFields::angle(std::string_view key, double& out) const {
  ReadLog::fallback(node_, key, out);
  std::optional<double> value;
  number(key, kAnyNumber, value);
  if (!value || !check_radians({*value, *value, true}, *find(key), name_of(key), sink_)) return;
  out = *value;
}

void YamlFields::integer(std::string_view key, std::int64_t lower, std::int64_t upper,
                         std::int64_t& out) const {
  ReadLog::fallback(node_, key, std::to_string(out));
  std::optional<std::int64_t> value;
  integer(key, lower, upper, value);
  if (value) out = *value;
}

void YamlFields::integer(std::string_view key, std::int64_t lower, std::int64_t upper,
                         std::optional<std::int64_t>& out) const {
  const auto* value = find(key);
  if (value == nullptr) return;
  if (const auto read = read_integer(*value, name_of(key), lower, upper, sink_)) out = read;
}

void YamlFields::boolean(std::string_view key, bool& out) const {
  ReadLog::fallback(node_, key, std::string(out ? "true" : "false"));
  std::optional<bool> value;
  boolean(key, value);
  if (value) out = *value;
}

void YamlFields::boolean(std::string_view key, std::optional<bool>& out) const {
  const auto* value = find(key);
  if (value == nullptr) return;
  if (value->is_scalar() && !value->quoted && (value->text == "true" || value->text == "false")) {
    out = value->text == "true";
    return;
  }
  sink_.error(codes::kWrongYamlKind, value->range, name_of(key), describe(*value),
              "`true` or `false`");
}

void YamlFields::text(std::string_view key, std::string& out) const {
  if (!out.empty()) ReadLog::fallback(node_, key, out);
  const auto* value = find(key);
  if (value == nullptr) return;
  if (auto read = read_text(*value, name_of(key), sink_)) out = std::move(*read);
}

void YamlFields::text(std::string_view key, std::optional<std::string>& out) const {
  const auto* value = find(key);
  if (value == nullptr) return;
  if (auto read = read_text(*value, name_of(key), sink_)) out = std::move(read);
}

void YamlFields::texts(std::string_view key, std::vector<std::string>& out) const {
  ReadLog::fallback(node_, key, out);
  const auto* value = find(key);
  if (value == nullptr) return;
  if (!value->is_list()) {
    sink_.error(codes::kWrongYamlKind, value->range, name_of(key), describe(*value), "a list");
    return;
  }
  out.clear();
  for (const auto& item : value->items) {
    if (auto read = read_text(item, fmt::format("an item of {}", name_of(key)), sink_)) {
      out.push_back(std::move(*read));
    }
  }
}

std::optional<std::size_t> YamlFields::choice(std::string_view key, std::string_view kind,
                                              std::span<const std::string_view> choices) const {
  const auto* value = find(key);
  if (value == nullptr) return std::nullopt;
  const auto word = read_text(*value, name_of(key), sink_);
  if (!word) return std::nullopt;
  const auto found = std::find(choices.begin(), choices.end(), *word);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  const std::vector<std::string> names(choices.begin(), choices.end());
  auto error = sink_.error(codes::kYamlUnknownChoice, value->range, *word, kind);
  add_suggestion(error, *word, names, "known");
  return std::nullopt;
}

std::optional<std::size_t> YamlFields::choice(std::string_view key, std::string_view kind,
                                              std::span<const std::string_view> choices,
                                              std::size_t fallback) const {
  ReadLog::fallback(node_, key, std::string(choices[fallback]));
  return choice(key, kind, choices);
}

std::optional<std::vector<double>> YamlFields::numbers(std::string_view key,
                                                       std::size_t count) const {
  const auto* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_list() || value->items.size() != count) {
    sink_.error(codes::kWrongYamlKind, value->range, name_of(key), describe(*value),
                fmt::format("a list of {} numbers", count));
    return std::nullopt;
  }
  std::vector<double> out;
  for (const auto& item : value->items) {
    if (const auto number = read_number(item, name_of(key), kAnyNumber, sink_)) {
      out.push_back(*number);
    }
  }
  if (out.size() != count) return std::nullopt;
  return out;
}

}  // namespace parallax::harness
