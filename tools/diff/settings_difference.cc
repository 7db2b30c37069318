#include "tools/diff/settings_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "compiler/compare/fact.h"

namespace parallax::tools {
namespace {

using harness::Setting;
using Path = std::vector<std::string>;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kPresent = "{}";  // the value of a map that says nothing else

bool is_below(const Path& path, const Path& top) {
  return path.size() >= top.size() && std::equal(top.begin(), top.end(), path.begin());
}

/// One side by path.
class Side {
 public:
  explicit Side(const harness::ScenarioSettings& settings) : all_(settings.all) {}

  const Setting* find(const Path& path) const {
    const auto at = first_from(path);
    return at != all_.end() && at->path == path ? &*at : nullptr;
  }
  /// Does the scenario have a key at the path or below it?
  bool says_below(const Path& top) const {
    for (auto at = first_from(top); at != all_.end() && is_below(at->path, top); ++at) {
      if (at->given) return true;
    }
    return false;
  }
  /// Values at the path or below it that are given and not the default.
  std::size_t count_below(const Path& top) const {
    std::size_t count = 0;
    for (auto at = first_from(top); at != all_.end() && is_below(at->path, top); ++at) {
      if (at->given && !at->is_default()) ++count;
    }
    return count;
  }
  const std::vector<Setting>& all() const { return all_; }

 private:
  std::vector<Setting>::const_iterator first_from(const Path& path) const {
    return std::lower_bound(all_.begin(), all_.end(), path,
                            [](const Setting& one, const Path& two) { return one.path < two; });
  }
  const std::vector<Setting>& all_;
};

class SettingsComparison {
 public:
  SettingsComparison(const harness::ScenarioSettings& before,
                     const harness::ScenarioSettings& after)
      : old_(before), new_(after) {}

  std::vector<SettingChange> run() && {
    for (const auto& setting : old_.all()) {
      const auto* other = new_.find(setting.path);
      if (other == nullptr) {
        one_sided(setting, true);
      } else if (setting.value != other->value) {
        changed(&setting, other);
      }
    }
    for (const auto& setting : new_.all()) {
      if (old_.find(setting.path) == nullptr) one_sided(setting, false);
    }
    std::vector<SettingChange> out;
    for (auto& [path, change] : changes_) {
      if (change.before != change.after) out.push_back(std::move(change));
    }
    return out;
  }

 private:
  static void put(SettingChange& change, const Setting& setting, bool is_old) {
    (is_old ? change.before : change.after) = setting.value;
    (is_old ? change.before_is_default : change.after_is_default) = !setting.given;
    (is_old ? change.old_file : change.new_file) = setting.file;
    (is_old ? change.old_line : change.new_line) = setting.line;
  }

  SettingChange& at(const Path& path) {
    auto& change = changes_[path];
    change.path = path;
    change.effects = harness::effects_of(path);
    return change;
  }

  void changed(const Setting* before, const Setting* after) {
    auto& change = at(before->path);
    put(change, *before, true);
    put(change, *after, false);
  }

  /// The other side lacks even the map in which the key would be.
  void one_sided(const Setting& setting, bool is_old) {
    const auto& other = is_old ? new_ : old_;
    if (!setting.given || setting.is_default()) return;
    if (setting.value == kPresent && other.says_below(setting.path)) return;
    // The highest key that the other side lacks, if it stands for more than this one value.
    Path top = setting.path;
    while (top.size() > 1) {
      const Path higher(top.begin(), top.end() - 1);
      if (other.says_below(higher)) break;
      top = higher;
    }
    if (setting.fallback && (is_old ? old_ : new_).count_below(top) == 1) top = setting.path;
    auto& change = at(top);
    if (top == setting.path) {
      put(change, setting, is_old);
      if (setting.fallback) {
        (is_old ? change.after : change.before) = *setting.fallback;
        (is_old ? change.after_is_default : change.before_is_default) = true;
      }
      return;
    }
    auto& text = is_old ? change.before : change.after;
    text += fmt::format(
        "{}{}: {}", text.empty() ? "" : ", ",
        harness::path_text(
            {setting.path.begin() + static_cast<std::ptrdiff_t>(top.size()), setting.path.end()}),
        setting.value);
    auto& file = is_old ? change.old_file : change.new_file;
    auto& line = is_old ? change.old_line : change.new_line;
    if (file.empty() || (file == setting.file && setting.line < line)) {
      file = setting.file;
      line = setting.line;
    }
  }

  Side old_, new_;
  std::map<Path, SettingChange> changes_;
};

std::string heading(const std::vector<harness::Effect>& effects) {
  std::string out;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    out += (i == 0 ? "" : " and ") + std::string(to_string(effects[i]));
  }
  return out;
}

char mark(const SettingChange& change) {
  if (change.before.empty()) return '+';
  return change.after.empty() ? '-' : '~';
}

std::string place(const SettingChange& change) {
  const bool is_new = !change.new_file.empty();
  return compiler::to_string(compiler::FactPlace{is_new ? change.new_file : change.old_file,
                                                 is_new ? change.new_line : change.old_line});
}

OrderedJson place_json(const std::string& file, std::uint32_t line) {
  return file.empty() ? OrderedJson(nullptr) : OrderedJson{{"file", file}, {"line", line}};
}

}  // namespace

std::vector<SettingChange> compare_settings(const harness::ScenarioSettings& before,
                                            const harness::ScenarioSettings& after) {
  return SettingsComparison(before, after).run();
}

std::string change_text(const SettingChange& change) {
  const auto [before, after] = compiler::changed_parts(change.before, change.after);
  const auto side = [](const std::string& text, bool is_default) {
    return is_default ? text + " (default)" : text;
  };
  auto out = harness::path_text(change.path);
  if (!before.empty()) out += ' ' + side(before, change.before_is_default);
  if (!before.empty() && !after.empty()) out += " ->";
  if (!after.empty()) out += ' ' + side(after, change.after_is_default);
  return base::printable(out);
}

std::string settings_text(const std::vector<SettingChange>& changes, bool stat) {
  std::map<std::vector<harness::Effect>, std::vector<const SettingChange*>> groups;
  for (const auto& change : changes) groups[change.effects].push_back(&change);
  std::string out;
  for (const auto& [effects, group] : groups) {
    std::string numbers;
    for (const auto& [sign, word] : {std::pair{'-', "removed"}, {'+', "added"}, {'~', "changed"}}) {
      const auto count =
          std::count_if(group.begin(), group.end(),
                        [&, sign = sign](const auto* one) { return mark(*one) == sign; });
      if (count != 0) numbers += fmt::format("{}{} {}", numbers.empty() ? "" : ", ", count, word);
    }
    out += fmt::format("{}: {}\n", heading(effects), numbers);
    if (stat) continue;
    for (const auto* change : group) {
      out += fmt::format("  {} {}  {}\n", mark(*change), place(*change), change_text(*change));
    }
  }
  return out;
}

std::string settings_json(const std::vector<SettingChange>& changes) {
  OrderedJson out = OrderedJson::array();
  for (const auto& change : changes) {
    OrderedJson effects = OrderedJson::array();
    for (const auto effect : change.effects) effects.push_back(to_string(effect));
    const auto value = [](const std::string& text) {
      return text.empty() ? OrderedJson(nullptr) : OrderedJson(text);
    };
    out.push_back({{"path", harness::path_text(change.path)},
                   {"old", value(change.before)},
                   {"new", value(change.after)},
                   {"changes", effects},
                   {"old_place", place_json(change.old_file, change.old_line)},
                   {"new_place", place_json(change.new_file, change.new_line)}});
  }
  return base::json_text(out);
}

}  // namespace parallax::tools
