// An editor shows about its files what `check` says about everything that reads them. The roots
// (scenarios, models) of all open files are checked one after the other; a message that two roots
// give is told once, and a file whose messages are gone is told so.

#include "tools/lsp/publishing.h"

#include <algorithm>
#include <set>
#include <utility>

namespace parallax::tools::lsp {
namespace {

Json diagnostics_of(const Documents& documents, const std::string& path,
                    const std::vector<EditorMessage>& messages) {
  const auto text = documents.text_of()(path).value_or("");
  const Positions positions(text, documents.unit());
  Json list = Json::array();
  for (const auto& message : messages) {
    list.push_back({{"range", range_of(positions, message.begin, message.end)},
                    {"severity", message.is_error ? 1 : 2},
                    {"code", message.code},
                    {"source", "parallax"},
                    {"message", message.text}});
  }
  Json params = {{"uri", documents.uri(path)}, {"diagnostics", std::move(list)}};
  if (const auto* open = documents.find(path)) params["version"] = open->version;
  return params;
}

/// Adds the messages that are not there.
void add_new(std::vector<EditorMessage>& all, std::vector<EditorMessage>& messages) {
  for (auto& message : messages) {
    const bool is_there = std::any_of(all.begin(), all.end(), [&](const auto& other) {
      return other.begin == message.begin && other.end == message.end && other.text == message.text;
    });
    if (!is_there) all.push_back(std::move(message));
  }
}

}  // namespace

bool Publishing::publish(const Documents& documents, std::atomic<bool>& stop,
                         const Notify& notify) {
  std::set<std::string> wanted;
  for (const auto& [path, document] : documents.all()) {
    for (auto& root : roots_of(path, documents.text_of())) wanted.insert(std::move(root));
  }
  std::map<std::string, std::vector<EditorMessage>> by_path;
  for (const auto& root : wanted) {
    auto files = checked(root, documents.texts(), stop);
    if (!files) return false;
    for (auto& [path, messages] : *files) add_new(by_path[path], messages);
  }
  is_current_ = true;
  for (const auto& [path, document] : documents.all()) by_path[path];
  for (const auto& [path, messages] : told_) by_path[path];
  for (const auto& [path, messages] : by_path)
    notify("textDocument/publishDiagnostics", diagnostics_of(documents, path, messages));
  told_ = std::move(by_path);
  std::erase_if(told_, [](const auto& entry) { return entry.second.empty(); });
  return true;
}

const std::vector<EditorMessage>& Publishing::told(const std::string& path) const {
  static const std::vector<EditorMessage> kNone;
  const auto found = told_.find(path);
  return found == told_.end() ? kNone : found->second;
}

}  // namespace parallax::tools::lsp
