// A scenario as a list of values. The tree that the reader has read is walked, and each value is
// written in one way: numbers by their value, texts as they are, lists of values as one. Defaults
// are those that the readers wrote down while they read (read_log.h), so there is no second table
// of keys that could be forgotten: a key that nobody knows yet is listed like every other.
#include "harness/config/scenario_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include "compiler/base/ascii.h"
#include "compiler/base/sha256.h"
#include "harness/config/sections.h"
#include "harness/config/settings_reader.h"

namespace parallax::harness {
namespace {

using Path = std::vector<std::string>;

struct SectionEffects {
  std::string_view section;
  std::array<std::optional<Effect>, 2> effects;
};

/// By outermost key. Regions and mappings say both where starts are drawn and what states mean.
constexpr std::array<SectionEffects, kScenarioKeys.size()> kSectionEffects = {{
    {Key::kInclude, {Effect::kWords}},
    {Key::kName, {Effect::kWords}},
    {Key::kModel, {Effect::kTraces}},
    {Key::kPlan, {Effect::kTraces}},
    {Key::kBind, {Effect::kTraces}},
    {Key::kConstraints, {Effect::kTraces}},
    {Key::kHorizon, {Effect::kTraces}},
    {Key::kEvents, {Effect::kJudgement}},
    {Key::kWorld, {Effect::kPhysics}},
    {Key::kRegions, {Effect::kStarts, Effect::kJudgement}},
    {Key::kMapping, {Effect::kStarts, Effect::kJudgement}},
    {Key::kActions, {Effect::kPhysics}},
    {Key::kSampling, {Effect::kStarts}},
    {Key::kCriterion, {Effect::kClaim}},
    {Key::kCompare, {Effect::kJudgement}},
    {Key::kExecution, {Effect::kPhysics}},
    {Key::kStarts, {Effect::kStarts}},
    {Key::kInitial, {Effect::kStarts}},
    {Key::kStartWeights, {Effect::kStarts}},
    {Key::kUntilCovered, {Effect::kClaim}},
    {Key::kMatch, {Effect::kJudgement}},
    {Key::kSimulator, {Effect::kPhysics}},
    {Key::kLimits, {Effect::kClaim}},
    {Key::kSearch, {Effect::kClaim}},
    {Key::kExpect, {Effect::kClaim}},
    {Key::kValidate, {Effect::kWords}},
}};

constexpr bool every_key_has_effects() {
  return std::all_of(kScenarioKeys.begin(), kScenarioKeys.end(), [](std::string_view key) {
    return std::any_of(kSectionEffects.begin(), kSectionEffects.end(),
                       [&](const SectionEffects& one) { return one.section == key; });
  });
}
static_assert(every_key_has_effects(), "a key of scenarios says nowhere what it can change");

/// Sections that are compared as texts of their own: as axioms, forms and so on.
constexpr std::array<std::string_view, 5> kOwnTexts = {Key::kInclude, Key::kModel, Key::kPlan,
                                                       Key::kBind, Key::kConstraints};

/// Lists whose order says nothing.
constexpr std::array<std::string_view, 6> kSets = {
    Key::kSettable, Key::kUnobserved, Key::kFluents, Key::kUprightExcept, Key::kOnly, Key::kFor};

bool among(std::span<const std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The number that an unquoted scalar means, as the readers take it (yaml_fields.cc); none for
/// other words.
std::optional<std::string> as_number(const std::string& text) {
  const auto digits = std::string_view(text).substr(text.starts_with('+') ? 1 : 0);
  if (digits.find_first_not_of("0123456789.+-eE") != std::string_view::npos) return std::nullopt;
  const char* end = digits.data() + digits.size();
  std::int64_t whole = 0;
  auto [rest, error] = std::from_chars(digits.data(), end, whole);
  if (error == std::errc() && rest == end && !digits.empty()) return std::to_string(whole);
  double value = 0.0;
  const auto read = std::from_chars(digits.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || digits.empty()) return std::nullopt;
  return number_text(value == 0.0 ? 0.0 : value);  // -0 is 0
}

std::string escaped(const std::string& text) {
  if (text.empty()) return "\"\"";
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\\n") : std::string(1, c);
  return out;
}

class SettingsReader {
 public:
  SettingsReader(const ReadLog& log, const base::SourceFiles& files) : log_(log), files_(files) {}

  ScenarioSettings take() {
    std::sort(out_.all.begin(), out_.all.end(),
              [](const Setting& a, const Setting& b) { return a.path < b.path; });
    return std::move(out_);
  }

  /// Lists what is below the path; is anything there that is not the default?
  bool walk(const YamlNode& node, const Path& path, const std::string* fallback) {
    switch (node.kind) {
      case YamlNode::Kind::kNull:
        return false;  // as if the key were not there
      case YamlNode::Kind::kScalar:
        return scalar(node, path, fallback);
      case YamlNode::Kind::kList:
        return list(node, path, fallback);
      case YamlNode::Kind::kMap:
        break;
    }
    return map(node, path);
  }

 private:
  static Path below(const Path& path, std::string_view key) {
    auto out = path;
    out.emplace_back(key);
    return out;
  }

  bool put(const YamlNode& node, const Path& path, std::string value, const std::string* fallback) {
    Setting setting{path, std::move(value), std::nullopt, true, {}, 0};
    if (fallback != nullptr) setting.fallback = *fallback;
    const auto& file = files_[node.range.file];
    setting.file = file.name();
    setting.line = file.position(node.range.begin).line;
    const bool says_something = !setting.is_default();
    out_.all.push_back(std::move(setting));
    return says_something;
  }

  std::string value_of(const YamlNode& node) const {
    switch (node.kind) {
      case YamlNode::Kind::kNull:
        return "none";
      case YamlNode::Kind::kList: {
        std::vector<std::string> items;
        for (const auto& item : node.items) items.push_back(value_of(item));
        return list_text(items);
      }
      case YamlNode::Kind::kScalar:
      case YamlNode::Kind::kMap:
        break;
    }
    if (log_.notes(node).is_text) return escaped(node.text);
    const auto number = as_number(node.text);
    const bool looks_like_more = number || node.text == "true" || node.text == "false";
    if (node.quoted) return looks_like_more ? '"' + node.text + '"' : escaped(node.text);
    return number.value_or(escaped(node.text));
  }

  bool scalar(const YamlNode& node, const Path& path, const std::string* fallback) {
    const auto& notes = log_.notes(node);
    if (notes.stands_for.empty()) return put(node, path, value_of(node), fallback);
    const auto known = notes.fallbacks.find(notes.stands_for);
    const bool says_something = put(node, below(path, notes.stands_for), value_of(node),
                                    known == notes.fallbacks.end() ? nullptr : &known->second);
    defaults(notes, path, [&](const std::string& key) { return key == notes.stands_for; });
    return says_something;
  }

  bool list(const YamlNode& node, const Path& path, const std::string* fallback) {
    const bool has_maps = std::any_of(node.items.begin(), node.items.end(),
                                      [](const YamlNode& item) { return item.is_map(); });
    if (!has_maps) {
      if (!among(kSets, path.back())) return put(node, path, value_of(node), fallback);
      std::vector<std::string> items;
      for (const auto& item : node.items) items.push_back(value_of(item));
      std::sort(items.begin(), items.end());
      items.erase(std::unique(items.begin(), items.end()), items.end());
      return put(node, path, list_text(items), fallback);
    }
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      (void)walk(node.items[i], below(path, fmt::format("[{}]", i)), nullptr);
    }
    return true;
  }

  bool map(const YamlNode& node, const Path& path) {
    const auto& notes = log_.notes(node);
    if (!notes.known.empty()) out_.known.push_back({path, notes.known});
    bool says_something = false;
    std::vector<std::string_view> given;
    for (const auto& entry : node.entries) {
      if (path.empty() && among(kOwnTexts, entry.key)) continue;
      if (entry.value.kind != YamlNode::Kind::kNull) given.push_back(entry.key);
      says_something = member(path, entry, notes) || says_something;
    }
    defaults(notes, path, [&](const std::string& key) { return among(given, key); });
    if (says_something || path.empty() || notes.is_optional) return says_something;
    return put(node, path, "{}", nullptr);  // that it is there
  }

  bool member(const Path& path, const YamlEntry& entry, const ReadLog::Notes& notes) {
    const auto at = below(path, entry.key);
    // The texts of a world that is a model are compared as axioms.
    if (path.size() == 1 && path[0] == Key::kSimulator && entry.key == Key::kModel) {
      return put(entry.value, at, "a model", nullptr);
    }
    // The reason why a fluent is not compared is prose; the fact that it is not compared is a
    // setting.
    if (path.size() == 2 && path[0] == Key::kMapping && entry.key == Key::kIgnored) {
      (void)put(entry.value, path, std::string(Key::kIgnored), nullptr);
    }
    const auto known = notes.fallbacks.find(entry.key);
    return walk(entry.value, at, known == notes.fallbacks.end() ? nullptr : &known->second);
  }

  template <typename IsGiven>
  void defaults(const ReadLog::Notes& notes, const Path& path, IsGiven is_given) {
    for (const auto& [key, value] : notes.fallbacks) {
      if (is_given(key)) continue;
      out_.all.push_back({below(path, key), value, value, false, {}, 0});
    }
  }

  const ReadLog& log_;
  const base::SourceFiles& files_;
  ScenarioSettings out_;
};

}  // namespace

std::string path_text(const std::vector<std::string>& path) {
  std::string out;
  for (const auto& part : path) {
    if (!out.empty() && !part.starts_with('[')) out += '.';
    out += part;
  }
  return out;
}

std::vector<Effect> effects_of(const std::vector<std::string>& path) {
  std::vector<Effect> out;
  if (path.empty()) return out;
  if (path.size() == 3 && path[0] == Key::kMapping && path[2] == Key::kIgnored) {
    return {Effect::kWords};
  }
  // The interval in which starts are drawn is no border of the region.
  const bool is_start =
      path[0] == Key::kRegions && std::find(path.begin(), path.end(), Key::kStart) != path.end();
  if (is_start) return {Effect::kStarts};
  for (const auto& [section, effects] : kSectionEffects) {
    if (section != path[0]) continue;
    for (const auto& effect : effects) {
      if (effect) out.push_back(*effect);
    }
  }
  return out;
}

std::string hash_of_settings(const ScenarioSettings& settings, Effect effect,
                             const std::vector<std::string>& without) {
  std::string text;
  for (const auto& setting : settings.all) {
    if (!setting.given || setting.is_default() || setting.path.empty()) continue;
    if (std::find(without.begin(), without.end(), setting.path.front()) != without.end()) continue;
    const auto effects = effects_of(setting.path);
    if (std::find(effects.begin(), effects.end(), effect) == effects.end()) continue;
    text += path_text(setting.path) + '=' + setting.value + '\n';
  }
  return base::sha256_hex(text).substr(0, 16);
}

void insert(ScenarioSettings& settings, Setting setting) {
  const auto at =
      std::lower_bound(settings.all.begin(), settings.all.end(), setting,
                       [](const Setting& a, const Setting& b) { return a.path < b.path; });
  settings.all.insert(at, std::move(setting));
}

ScenarioSettings settings_of(const YamlNode& root, const ReadLog& log,
                             const base::SourceFiles& files) {
  SettingsReader reader(log, files);
  (void)reader.walk(root, {}, nullptr);
  return reader.take();
}

}  // namespace parallax::harness
