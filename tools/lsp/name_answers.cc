// Answers about names: what a name is (hover), where it stands, which ones there are. They come
// from the declarations and places that tools/lsp/project finds; a file on disk is read where the
// answer lies in it.

#include "tools/lsp/name_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/lsp/file_text.h"
#include "tools/lsp/last_trace.h"
#include "tools/lsp/yaml_answers.h"

namespace parallax::tools::lsp {
namespace {

std::string_view core_help(std::string_view word) {
  struct Line {
    std::string_view word, help;
  };
  static constexpr Line kLines[] = {
      {"Happens", "`Happens(event, time)`: the event occurs at the timepoint."},
      {"HoldsAt", "`HoldsAt(fluent, time)`: the fluent is true at the timepoint."},
      {"ReleasedAt",
       "`ReleasedAt(fluent, time)`: the fluent does not follow inertia at the timepoint."},
      {"Initiates",
       "`Initiates(event, fluent, time)`: if the event occurs at the timepoint, the fluent is true "
       "after it."},
      {"Terminates",
       "`Terminates(event, fluent, time)`: if the event occurs at the timepoint, the fluent is "
       "false after it."},
      {"Releases",
       "`Releases(event, fluent, time)`: if the event occurs at the timepoint, the fluent leaves "
       "inertia after it."},
      {"Trajectory",
       "`Trajectory(fluent1, time, fluent2, offset)`: while fluent1 holds, started at the "
       "timepoint, fluent2 holds so much later."},
      {"AntiTrajectory",
       "`AntiTrajectory(fluent1, time, fluent2, offset)`: while fluent1 is false, ended at the "
       "timepoint, fluent2 holds so much later."}};
  for (const auto& line : kLines) {
    if (line.word == word) return line.help;
  }
  return {};
}

std::string word_at(std::string_view text, std::size_t offset) {
  auto begin = offset, end = offset;
  while (begin > 0 && is_word(text[begin - 1])) --begin;
  while (end < text.size() && is_word(text[end])) ++end;
  return std::string(text.substr(begin, end - begin));
}

std::string elements_of(const DeclaredName& sort, const NameMap& names) {
  std::string list;
  for (const auto& [name, declared] : names.declared()) {
    if (declared.kind == NameKind::kConstant && declared.declaration.starts_with(sort.name + " ")) {
      list += (list.empty() ? "" : ", ") + name;
    }
  }
  return list.empty() ? "" : "elements: " + list + "\n";
}

/// The protocol's `Location`s of places, which come file by file.
Json locations(const Documents& documents, const std::vector<NamedPlace>& places) {
  Json out = Json::array();
  for (std::size_t i = 0; i < places.size();) {
    const auto& path = places[i].path;
    const auto text = documents.text_of()(path).value_or("");
    const Positions positions(text, documents.unit());
    for (; i < places.size() && places[i].path == path; ++i) {
      out.push_back({{"uri", documents.uri(path)},
                     {"range", range_of(positions, places[i].begin, places[i].end)}});
    }
  }
  return out;
}

}  // namespace

AskedPlace asked_place(Documents& documents, const Json& params) {
  AskedPlace out{documents.asked_path(params)};
  out.offset = documents.positions(out.path).offset(place_of(member(params, "position")));
  out.name = documents.names(out.path).at(out.path, out.offset);
  return out;
}

Json hover(Documents& documents, const Json& params) {
  const auto at = asked_place(documents, params);
  const auto& text = documents.text(at.path);
  std::string words;
  if (at.name != nullptr) {
    const auto& names = documents.names(at.path);
    words = fmt::format("```\n{}\n```\n", at.name->declaration);
    if (!at.name->comment.empty()) words += at.name->comment + "\n\n";
    if (const auto* event = names.find(at.name->event))
      words += fmt::format("```\n{}\n```\n", event->declaration);
    constexpr std::size_t kMost = 8;
    const auto effects = names.effects(*at.name);
    for (std::size_t i = 0; i < std::min(effects.size(), kMost); ++i) {
      words += fmt::format("```\n{}\n```\n", effects[i]);
    }
    if (effects.size() > kMost)
      words += fmt::format("and {} more effect axioms\n", effects.size() - kMost);
    if (at.name->kind == NameKind::kFluent) {
      auto roots = roots_of(at.path, documents.text_of());
      std::erase_if(roots, [](const auto& root) { return !is_yaml(root); });
      words += last_values(at.name->name, roots);
    }
    if (at.name->kind == NameKind::kSort) words += elements_of(*at.name, names);
  } else {
    words = is_yaml(at.path) ? yaml_hover(text, at.offset) : "";
    if (words.empty()) words = core_help(word_at(text, at.offset));
  }
  words += documents.compiled(at.path).about(at.path, at.offset);
  if (words.empty()) return nullptr;
  return {{"contents", {{"kind", "markdown"}, {"value", words}}}};
}

Json definition(Documents& documents, const Json& params) {
  const auto at = asked_place(documents, params);
  if (at.name == nullptr) return nullptr;
  auto out = locations(documents, {{at.name->path, at.name->begin, at.name->end}});
  // An entry of a table also leads to the event that it performs.
  if (const auto* event = documents.names(at.path).find(at.name->event)) {
    out.push_back(locations(documents, {{event->path, event->begin, event->end}}).front());
    return out;
  }
  return out.front();
}

Json references(Documents& documents, const Json& params) {
  const auto at = asked_place(documents, params);
  if (at.name == nullptr) return Json::array();
  const auto& names = documents.names(at.path);
  auto places = names.places(*at.name);
  for (auto& perform : names.performs(*at.name)) places.push_back(std::move(perform));
  return locations(documents, places);
}

Json highlights(Documents& documents, const Json& params) {
  const auto at = asked_place(documents, params);
  Json out = Json::array();
  if (at.name == nullptr) return out;
  const auto positions = documents.positions(at.path);
  for (const auto& place : documents.names(at.path).places(*at.name)) {
    if (place.path == at.path)
      out.push_back({{"range", range_of(positions, place.begin, place.end)}});
  }
  return out;
}

Json completion(Documents& documents, const Json& params) {
  const auto path = documents.asked_path(params);
  const auto& text = documents.text(path);
  Json items = Json::array();
  if (is_yaml(path)) {
    const auto offset = documents.positions(path).offset(place_of(member(params, "position")));
    items = yaml_completion(text, offset);
  }
  const auto add = [&](std::string_view label, int kind, std::string_view detail) {
    items.push_back({{"label", label}, {"kind", kind}, {"detail", detail}});
  };
  const bool has_plan_names = is_plan(path) || is_table(path);
  for (const auto& [key, declared] : documents.names(path).declared()) {
    if (is_of_plans(declared.kind) && !has_plan_names) continue;
    // Numbers of the protocol: class, constant, field, event, function, method.
    static constexpr std::array<int, kNameKinds> kKinds = {7, 21, 5, 23, 3, 3, 2, 3};
    add(declared.name, kKinds[static_cast<std::size_t>(declared.kind)], declared.declaration);
  }
  constexpr int kKeyword = 14;
  for (const auto* word : {"AntiTrajectory", "Happens", "HoldsAt", "Initiates", "ReleasedAt",
                           "Releases", "Terminates", "Trajectory"}) {
    add(word, kKeyword, "event calculus");
  }
  if (is_model(path)) {
    for (const auto* word : {"completion", "event", "fluent", "function", "load", "mutex",
                             "noninertial", "option", "predicate", "range", "sort", "xor"}) {
      add(word, kKeyword, "statement");
    }
  }
  return {{"isIncomplete", false}, {"items", std::move(items)}};
}

Json symbols(Documents& documents, const Json& params) {
  const auto path = documents.asked_path(params);
  const auto positions = documents.positions(path);
  Json out = Json::array();
  for (const auto& [key, declared] : documents.names(path).declared()) {
    if (declared.path != path) continue;
    // Class, constant, field, event, function, method.
    static constexpr std::array<int, kNameKinds> kKinds = {5, 14, 8, 24, 12, 12, 6, 12};
    const auto range = range_of(positions, declared.begin, declared.end);
    out.push_back({{"name", declared.name},
                   {"detail", declared.declaration},
                   {"kind", kKinds[static_cast<std::size_t>(declared.kind)]},
                   {"range", range},
                   {"selectionRange", range}});
  }
  return out;
}

}  // namespace parallax::tools::lsp
