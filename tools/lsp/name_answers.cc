// Answers about names: what a name is (hover), where it stands, which ones there are. They come
// from the declarations and places that tools/lsp/project finds; a file on disk is read where the
// answer lies in it.

#include "tools/lsp/name_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

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
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
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
  std::string words;
  if (at.name != nullptr) {
    words = fmt::format("```\n{}\n```\n", at.name->declaration);
    if (!at.name->comment.empty()) words += at.name->comment + "\n\n";
    constexpr std::size_t kMost = 8;
    const auto effects = documents.names(at.path).effects(*at.name);
    for (std::size_t i = 0; i < std::min(effects.size(), kMost); ++i) {
      words += fmt::format("```\n{}\n```\n", effects[i]);
    }
    if (effects.size() > kMost)
      words += fmt::format("and {} more effect axioms\n", effects.size() - kMost);
    if (at.name->kind == NameKind::kSort) words += elements_of(*at.name, documents.names(at.path));
  } else {
    words = core_help(word_at(documents.text(at.path), at.offset));
  }
  if (words.empty()) return nullptr;
  return {{"contents", {{"kind", "markdown"}, {"value", words}}}};
}

Json definition(Documents& documents, const Json& params) {
  const auto at = asked_place(documents, params);
  if (at.name == nullptr) return nullptr;
  return locations(documents, {{at.name->path, at.name->begin, at.name->end}}).front();
}

Json references(Documents& documents, const Json& params) {
  const auto at = asked_place(documents, params);
  if (at.name == nullptr) return Json::array();
  return locations(documents, documents.names(at.path).places(*at.name));
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
  Json items = Json::array();
  const auto add = [&](std::string_view label, int kind, std::string_view detail) {
    items.push_back({{"label", label}, {"kind", kind}, {"detail", detail}});
  };
  for (const auto& [name, declared] : documents.names(path).declared()) {
    // Numbers of the protocol: class, constant, field, event, function.
    static constexpr int kKinds[] = {7, 21, 5, 23, 3, 3};
    add(name, kKinds[static_cast<std::size_t>(declared.kind)], declared.declaration);
  }
  constexpr int kKeyword = 14;
  for (const auto* word : {"AntiTrajectory", "Happens", "HoldsAt", "Initiates", "ReleasedAt",
                           "Releases", "Terminates", "Trajectory"}) {
    add(word, kKeyword, "event calculus");
  }
  if (path.ends_with(".e")) {
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
  for (const auto& [name, declared] : documents.names(path).declared()) {
    if (declared.path != path) continue;
    static constexpr int kKinds[] = {5, 14, 8, 24, 12, 12};
    const auto range = range_of(positions, declared.begin, declared.end);
    out.push_back({{"name", name},
                   {"detail", declared.declaration},
                   {"kind", kKinds[static_cast<std::size_t>(declared.kind)]},
                   {"range", range},
                   {"selectionRange", range}});
  }
  return out;
}

}  // namespace parallax::tools::lsp
