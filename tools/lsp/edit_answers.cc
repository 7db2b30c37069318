// Answers that are changes of texts: a new name everywhere, the layout of `fmt`, the mends that
// messages name. A rename is tried before it is answered: the compiler checks the renamed texts,
// and an error that was not there before refuses it.

#include "tools/lsp/edit_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/file_io.h"
#include "compiler/syntax/formatter.h"
#include "tools/lsp/diagnosis.h"
#include "tools/lsp/file_text.h"
#include "tools/lsp/name_answers.h"

namespace parallax::tools::lsp {
namespace {

std::string first_new_error(const std::map<std::string, std::vector<EditorMessage>>& before,
                            const std::map<std::string, std::vector<EditorMessage>>& after) {
  std::multiset<std::string> known;
  for (const auto& [path, messages] : before) {
    for (const auto& message : messages) known.insert(path + message.code);
  }
  for (const auto& [path, messages] : after) {
    for (const auto& message : messages) {
      const auto found = known.find(path + message.code);
      if (found != known.end()) {
        known.erase(found);
      } else if (message.is_error) {
        return message.text.substr(0, message.text.find('\n'));
      }
    }
  }
  return {};
}

/// Can plans and tables have this name? Letters in them are lower case, whatever is typed.
bool is_plan_word(std::string_view word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return is_word(c) ? std::isupper(static_cast<unsigned char>(c)) == 0 : c == '-' || c == '*';
  });
}

}  // namespace

Json name_range(Documents& documents, const Json& params) {
  const auto at = asked_place(documents, params);
  if (at.name == nullptr) return nullptr;
  const auto positions = documents.positions(at.path);
  for (const auto& place : documents.names(at.path).places(*at.name)) {
    if (place.path == at.path && place.begin <= at.offset && at.offset <= place.end) {
      return range_of(positions, place.begin, place.end);
    }
  }
  return nullptr;
}

Json rename(Documents& documents, const Json& params) {
  const auto at = asked_place(documents, params);
  if (at.name == nullptr) throw Refused{RpcError::kFailed, "no declared name stands here"};
  const auto fresh = text_member(params, "newName");
  const auto old = at.name->name;
  const auto family = family_of(at.path, documents.text_of());
  const NameMap all(family, documents.text_of());
  const auto* name = all.at(at.path, at.offset);
  const auto group = at.name->key.substr(0, at.name->key.size() - old.size());
  if (is_of_plans(at.name->kind) && !is_plan_word(fresh))
    throw Refused{RpcError::kFailed, fmt::format("`{}` is no name of a plan", fresh)};
  if (name == nullptr || all.find(group + fresh) != nullptr) {
    throw Refused{RpcError::kFailed, fmt::format("`{}` is declared already", fresh)};
  }
  std::map<std::string, std::vector<NamedPlace>> by_path;
  for (const auto& place : all.places(*name)) by_path[place.path].push_back(place);
  auto renamed = documents.texts();
  Json changes = Json::object();
  for (const auto& [path, places] : by_path) {
    auto text = documents.text_of()(path).value_or("");
    const Positions positions(text, documents.unit());
    Json edits = Json::array();
    for (const auto& place : places) {
      // A variable keeps the digits behind its sort.
      edits.push_back({{"range", range_of(positions, place.begin, place.begin + old.size())},
                       {"newText", fresh}});
    }
    auto changed_text = text;
    for (auto place = places.rbegin(); place != places.rend(); ++place)
      changed_text.replace(place->begin, old.size(), fresh);
    renamed.set(path, std::move(changed_text));
    changes[documents.uri(path)] = std::move(edits);
  }
  std::atomic<bool> never{false};
  std::set<std::string> roots;
  for (const auto& path : family) {
    for (auto& root : roots_of(path, documents.text_of())) roots.insert(std::move(root));
  }
  for (const auto& root : roots) {
    const auto before = checked(root, documents.texts(), never),
               after = checked(root, renamed, never);
    const auto fault = first_new_error(*before, *after);
    if (!fault.empty())
      throw Refused{RpcError::kFailed,
                    fmt::format("with `{}` the model has an error: {}", fresh, fault)};
  }
  return {{"changes", std::move(changes)}};
}

Json formatting(Documents& documents, const Json& params) {
  const auto path = documents.asked_path(params);
  const auto& text = documents.text(path);
  if (!path.ends_with(".e")) return nullptr;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto file = base::register_text(path, text, files, sink);
  const auto formatted = file ? compiler::format_text(*file, files, sink)
                              : base::Result<std::string>(sink.already_reported());
  if (!formatted) throw Refused{RpcError::kFailed, "a text with syntax errors is not formatted"};
  if (*formatted == text) return Json::array();
  return Json::array(
      {{{"range", range_of(documents.positions(path), 0, text.size())}, {"newText", *formatted}}});
}

Json actions(Documents& documents, const Publishing& published, const Json& params) {
  const auto path = documents.asked_path(params);
  const auto& text = documents.text(path);
  const Positions positions(text, documents.unit());
  const auto& range = member(params, "range");
  const auto begin = positions.offset(place_of(member(range, "start"))),
             end = positions.offset(place_of(member(range, "end")));
  Json out = Json::array();
  if (!published.is_current()) return out;  // the places of messages are those of older texts
  for (const auto& message : published.told(path)) {
    if (message.fix.empty() || message.end < begin || message.begin > end) continue;
    const auto fix = fix_of(message, text);
    if (!fix) continue;
    const Json edit = {{"range", range_of(positions, fix->begin, fix->end)},
                       {"newText", fix->text}};
    out.push_back({{"title", message.fix},
                   {"kind", "quickfix"},
                   {"edit", {{"changes", {{documents.uri(path), Json::array({edit})}}}}}});
  }
  return out;
}

}  // namespace parallax::tools::lsp
