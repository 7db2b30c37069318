#include "tools/suite/collected_cases.h"

#include <filesystem>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"

namespace parallax::tools {
namespace {

/// A case by its name alone: `FILE`, or `FILE:ID`.
SuiteCase named_case(const std::string& name) {
  const auto colon = name.rfind(':');
  const bool is_scenario =
      colon == std::string::npos || name.ends_with(".yaml") || name.ends_with(".yml");
  SuiteCase out{name, name, ".", harness::Expectation{}};
  if (is_scenario) {
    const auto slash = name.rfind('/');
    if (slash != std::string::npos) out.group = name.substr(0, slash);
  } else {
    out.file = out.group = name.substr(0, colon);
    out.id = name.substr(colon + 1);
    out.check = harness::ManifestCase{};
  }
  out.is_removed = true;
  return out;
}

}  // namespace

std::set<std::string> last_names(const StoredResults& earlier, const std::string& history,
                                 const std::function<bool(const SuiteSelection&)>& is_comparable) {
  std::set<std::string> out;
  const auto& suite = earlier.identity;
  if (is_comparable({suite.paths, suite.only, suite.fast})) {
    for (const auto& [name, one] : earlier.cases) out.insert(name);
  }
  const std::string all;
  if (is_comparable({suite.paths, all, false})) {
    out.insert(earlier.known.begin(), earlier.known.end());
  }
  std::error_code error;
  if (history.empty() || !std::filesystem::exists(history, error)) return out;
  base::DiagnosticSink unread;  // one that cannot be read is refused elsewhere
  const auto lines = read_history(history, unread);
  if (!lines) return out;
  for (auto line = lines->lines.rbegin(); line != lines->lines.rend(); ++line) {
    if (!is_comparable({line->paths, line->only, line->fast})) continue;
    for (const auto& [name, one] : line->cases) out.insert(name);
    break;
  }
  return out;
}

std::set<std::string> known_names(const StoredResults& earlier, const SuiteIdentity& suite) {
  const bool is_whole = suite.only.empty() && !suite.fast;
  if (is_whole || normal_paths(earlier.identity.paths) != normal_paths(suite.paths)) return {};
  auto out = earlier.known;
  for (const auto& [name, one] : earlier.cases) out.insert(name);
  return out;
}

std::vector<SuiteCase> removed_cases(const std::set<std::string>& names,
                                     const std::set<std::string>& last, const std::string& only,
                                     const Shard& shard) {
  std::vector<SuiteCase> out;
  for (const auto& name : last) {
    if (names.contains(name) || name.find(only) == std::string::npos) continue;
    auto one = named_case(name);
    if (in_shard(one.id, shard)) out.push_back(std::move(one));
  }
  return out;
}

std::string collected_text(const std::vector<SuiteCase>& cases) {
  std::string out;
  for (const auto& one : cases) {
    if (!one.is_removed) out += base::printable(one.name()) + '\n';
  }
  return out;
}

std::string collected_document(const std::vector<SuiteCase>& cases,
                               const std::vector<std::string>& unused_goldens) {
  auto list = nlohmann::json::array();
  auto removed = nlohmann::json::array();
  for (const auto& one : cases) {
    if (one.is_removed) {
      removed.push_back(one.name());
      continue;
    }
    const bool is_scenario = std::holds_alternative<harness::Expectation>(one.check);
    list.push_back(
        {{"case", one.name()}, {"file", one.file}, {"kind", is_scenario ? "scenario" : "traces"}});
    if (one.line > 0) list.back()["line"] = one.line;
  }
  const nlohmann::json document = {
      {"status", "ok"}, {"cases", list}, {"removed", removed}, {"unused_goldens", unused_goldens}};
  return base::json_text(document) + '\n';
}

}  // namespace parallax::tools
