// The texts that an editor has open. It sends changes as ranges of lines and columns; the text is
// kept whole, and what is known about names is dropped with each change. Names are found anew at
// the next question: a few milliseconds for a model of usual size.

#include "tools/lsp/documents.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/file_io.h"

namespace parallax::tools::lsp {

bool Documents::open(const Json& params) {
  const auto& document = member(params, "textDocument");
  const auto uri = text_member(document, "uri");
  const auto path = path_of_uri(uri);
  if (path.empty()) return false;
  documents_[path] = {uri, text_member(document, "text"), number_member(document, "version")};
  texts_.set(path, documents_[path].text);
  forget_names();
  return true;
}

bool Documents::change(const Json& params) {
  const auto& named = member(params, "textDocument");
  const auto found = documents_.find(path_of_uri(text_member(named, "uri")));
  if (found == documents_.end()) return false;
  auto& document = found->second;
  const auto& changes = member(params, "contentChanges");
  if (!changes.is_array()) throw Refused{RpcError::kInvalidParams, "`contentChanges` is no list"};
  auto changed = document.text;
  for (const auto& one : changes) {
    auto text = text_member(one, "text");
    const auto* range = base::json_member(one, "range");
    if (range == nullptr || range->is_null()) {
      changed = std::move(text);
      continue;
    }
    const Positions positions(changed, unit_);
    const auto begin = positions.offset(place_of(member(*range, "start")));
    const auto end = std::max(begin, positions.offset(place_of(member(*range, "end"))));
    changed.replace(begin, end - begin, text);
  }
  document.text = std::move(changed);
  if (const auto* version = base::json_member(named, "version")) {
    document.version = base::json_as<std::int64_t>(*version).value_or(document.version);
  }
  texts_.set(found->first, document.text);
  forget_names();
  return true;
}

bool Documents::close(const Json& params) {
  const auto path = path_of_uri(text_member(member(params, "textDocument"), "uri"));
  texts_.remove(path);
  forget_names();
  return documents_.erase(path) > 0;
}

const OpenDocument* Documents::find(const std::string& path) const {
  const auto found = documents_.find(path);
  return found == documents_.end() ? nullptr : &found->second;
}

TextOf Documents::text_of() const {
  return [this](const std::string& path) -> std::optional<std::string> {
    if (const auto* open = find(path)) return open->text;
    base::DiagnosticSink unread;
    auto text = base::read_file(path, unread);
    if (!text) return std::nullopt;
    return *std::move(text);
  };
}

std::string Documents::uri(const std::string& path) const {
  const auto* open = find(path);
  return open == nullptr ? uri_of_path(path) : open->uri;
}

std::string Documents::asked_path(const Json& params) const {
  auto path = path_of_uri(text_member(member(params, "textDocument"), "uri"));
  if (find(path) == nullptr) throw Refused{RpcError::kInvalidParams, "this document is not open"};
  return path;
}

const NameMap& Documents::names(const std::string& path) {
  auto& known = names_[path];
  if (!known) {
    std::vector<std::string> paths = {path};
    for (const auto& root : roots_of(path, text_of())) {
      for (auto& one : files_below(root, text_of())) paths.push_back(std::move(one));
    }
    std::sort(paths.begin(), paths.end());
    paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
    known = std::make_unique<NameMap>(paths, text_of());
  }
  return *known;
}

const CompiledTexts& Documents::compiled(const std::string& path) {
  constexpr double kMostSeconds = 1.0;  // somebody waits
  const auto roots = roots_of(path, text_of());
  const auto& root = roots.empty() ? path : roots.front();
  auto& known = compiled_[root];
  if (!known) known = std::make_unique<CompiledTexts>(root, texts_, kMostSeconds);
  return *known;
}

}  // namespace parallax::tools::lsp
