// One thread reads messages, the other one answers them in their order. After a change of a text it
// waits until nothing more comes for a moment, and checks the roots of what is open with the
// compiler itself; a change that comes meanwhile raises the stop flag of that check, whose result
// is then not told. Names are found by tools/lsp/project, anew after each change: a few
// milliseconds for ten thousand lines.

#include "tools/lsp/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "compiler/base/diagnostic.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/syntax/formatter.h"
#include "tools/app/version.h"
#include "tools/lsp/diagnosis.h"
#include "tools/lsp/frames.h"
#include "tools/lsp/positions.h"
#include "tools/lsp/project.h"

namespace parallax::tools::lsp {
namespace {

using Json = nlohmann::json;

constexpr auto kQuiet = std::chrono::milliseconds(30);

enum class RpcError : int {
  kParse = -32700,
  kInvalidRequest = -32600,
  kNoMethod = -32601,
  kInvalidParams = -32602,
  kNotInitialized = -32002,
  kFailed = -32803,
};

struct Refused {
  RpcError code;
  std::string text;
};

struct OpenDocument {
  std::string uri, text;
  std::int64_t version = 0;
};

const Json& member(const Json& object, const char* name) {
  const auto* found = base::json_member(object, name);
  if (found == nullptr)
    throw Refused{RpcError::kInvalidParams, fmt::format("`{}` is missing", name)};
  return *found;
}

std::string text_member(const Json& object, const char* name) {
  const auto text = base::json_as<std::string>(member(object, name));
  if (!text) throw Refused{RpcError::kInvalidParams, fmt::format("`{}` is no text", name)};
  return *text;
}

std::int64_t number_member(const Json& object, const char* name) {
  const auto number = base::json_as<std::int64_t>(member(object, name));
  if (!number)
    throw Refused{RpcError::kInvalidParams, fmt::format("`{}` is no whole number", name)};
  return *number;
}

EditorPlace place_of(const Json& position) {
  return {number_member(position, "line"), number_member(position, "character")};
}

Json json_of(const EditorPlace& place) {
  return {{"line", place.line}, {"character", place.column}};
}

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

class EditorServer {
 public:
  EditorServer(int in, int out) : reader_(in), out_(out) {}

  int run() {
    std::thread reading([this] { read(); });
    const int code = answer_all();
    reading.join();
    return code;
  }

 private:
  // Reading.

  static bool is_exit(const std::string& message) {
    if (message.find("\"exit\"") == std::string::npos) return false;
    const auto parsed = base::parse_json(message);
    const auto* method = base::json_member(parsed, "method");
    return method != nullptr && *method == "exit";
  }

  void read() {
    while (auto message = reader_.next()) {
      const bool is_last = is_exit(*message);
      const bool is_change = message->find("textDocument/did") != std::string::npos;
      {
        const std::lock_guard lock(mutex_);
        queue_.push_back(*std::move(message));
        arrived_.notify_one();
      }
      // Behind what it announces, so that a check which begins meanwhile sees one of both.
      if (is_last || is_change) stop_.store(true);
      if (is_last) break;
    }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    stop_.store(true);
    arrived_.notify_one();
  }

  /// None: nothing came for a moment, and something is to be checked; or the client is gone.
  std::optional<std::string> next_message() {
    std::unique_lock lock(mutex_);
    const auto ready = [this] { return !queue_.empty() || ended_; };
    if (dirty_) {
      arrived_.wait_for(lock, kQuiet, ready);
    } else {
      arrived_.wait(lock, ready);
    }
    if (queue_.empty()) return std::nullopt;
    auto message = std::move(queue_.front());
    queue_.pop_front();
    return message;
  }

  bool is_over() {
    const std::lock_guard lock(mutex_);
    return ended_ && queue_.empty();
  }

  int answer_all() {
    while (!is_over() && !has_left_) {
      const auto message = next_message();
      if (message) {
        answer(*message);
      } else if (dirty_ && !is_over()) {
        diagnose();
      }
    }
    // The reader is behind its last message, or at the end of the input.
    return has_left_ && was_shut_down_ ? 0 : 1;
  }

  // Answering.

  void send(const Json& message) {
    // Texts go back as they are: what is shown is the editor's business.
    const auto text = message.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (!write_frame(out_, text)) stop_.store(true);
  }

  void notify(const char* method, Json params) {
    send({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
  }

  void refuse(const Json& id, RpcError code, const std::string& text) {
    send({{"jsonrpc", "2.0"},
          {"id", id},
          {"error", {{"code", static_cast<int>(code)}, {"message", text}}}});
  }

  void answer(const std::string& text) {
    if (text.empty()) {
      notify("window/logMessage",
             {{"type", 1}, {"message", "parallax: a message of more than 64 MB was dropped"}});
      return;
    }
    const auto message = base::parse_json(text);
    if (message.is_discarded() || !message.is_object())
      return refuse(nullptr, RpcError::kParse, "this is no JSON object");
    const auto* id = base::json_member(message, "id");
    const auto* named = base::json_member(message, "method");
    if (named == nullptr) return;  // an answer, and nothing was asked
    const auto method = base::json_as<std::string>(*named).value_or("");
    static const Json kNothing = Json::object();
    const auto* given = base::json_member(message, "params");
    const Json& params = given == nullptr ? kNothing : *given;
    try {
      if (id == nullptr) return take(method, params);
      if (!is_ready_ && method != "initialize")
        throw Refused{RpcError::kNotInitialized, "`initialize` comes first"};
      if (was_shut_down_)
        throw Refused{RpcError::kInvalidRequest, "after `shutdown` only `exit` may come"};
      send({{"jsonrpc", "2.0"}, {"id", *id}, {"result", result(method, params)}});
    } catch (const Refused& refused) {
      if (id != nullptr) refuse(*id, refused.code, refused.text);
    }
  }

  void take(const std::string& method, const Json& params) {
    if (method == "exit") has_left_ = true;
    if (!is_ready_) return;
    if (method == "textDocument/didOpen") return open(params);
    if (method == "textDocument/didChange") return change(params);
    if (method == "textDocument/didSave") return changed();
    if (method == "workspace/didChangeWatchedFiles") return changed();
    if (method == "textDocument/didClose") {
      const auto path = path_of_uri(text_member(member(params, "textDocument"), "uri"));
      documents_.erase(path);
      texts_.remove(path);
      changed();
    }
  }

  Json result(const std::string& method, const Json& params) {
    if (method == "initialize") return initialize(params);
    if (method == "shutdown") {
      was_shut_down_ = true;
      return nullptr;
    }
    if (method == "textDocument/hover") return hover(params);
    if (method == "textDocument/definition") return definition(params);
    if (method == "textDocument/references") return references(params);
    if (method == "textDocument/documentHighlight") return highlights(params);
    if (method == "textDocument/prepareRename") return name_range(params);
    if (method == "textDocument/rename") return rename(params);
    if (method == "textDocument/completion") return completion(params);
    if (method == "textDocument/documentSymbol") return symbols(params);
    if (method == "textDocument/formatting") return formatting(params);
    if (method == "textDocument/codeAction") return actions(params);
    throw Refused{RpcError::kNoMethod, fmt::format("there is no method `{}`", method)};
  }

  Json initialize(const Json& params) {
    is_ready_ = true;
    if (const auto* client = base::json_member(params, "capabilities")) {
      if (const auto* general = base::json_member(*client, "general")) {
        if (const auto* units = base::json_member(*general, "positionEncodings");
            units != nullptr && units->is_array()) {
          if (std::find(units->begin(), units->end(), Json("utf-8")) != units->end())
            unit_ = ColumnUnit::kByte;
        }
      }
    }
    return {{"serverInfo", {{"name", "parallax"}, {"version", kVersion}}},
            {"capabilities",
             {{"positionEncoding", unit_ == ColumnUnit::kByte ? "utf-8" : "utf-16"},
              {"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", true}}},
              {"hoverProvider", true},
              {"definitionProvider", true},
              {"referencesProvider", true},
              {"documentHighlightProvider", true},
              {"renameProvider", {{"prepareProvider", true}}},
              {"completionProvider", {{"resolveProvider", false}}},
              {"documentSymbolProvider", true},
              {"documentFormattingProvider", true},
              {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}}}}};
  }

  // Texts.

  void open(const Json& params) {
    const auto& document = member(params, "textDocument");
    const auto uri = text_member(document, "uri");
    const auto path = path_of_uri(uri);
    if (path.empty()) return;
    documents_[path] = {uri, text_member(document, "text"), number_member(document, "version")};
    texts_.set(path, documents_[path].text);
    changed();
  }

  void change(const Json& params) {
    const auto& named = member(params, "textDocument");
    const auto found = documents_.find(path_of_uri(text_member(named, "uri")));
    if (found == documents_.end()) return;
    auto& document = found->second;
    const auto& changes = member(params, "contentChanges");
    if (!changes.is_array()) throw Refused{RpcError::kInvalidParams, "`contentChanges` is no list"};
    for (const auto& one : changes) {
      const auto text = text_member(one, "text");
      const auto* range = base::json_member(one, "range");
      if (range == nullptr || range->is_null()) {
        document.text = text;
        continue;
      }
      const Positions positions(document.text, unit_);
      const auto begin = positions.offset(place_of(member(*range, "start")));
      const auto end = std::max(begin, positions.offset(place_of(member(*range, "end"))));
      document.text.replace(begin, end - begin, text);
    }
    if (const auto* version = base::json_member(named, "version")) {
      document.version = base::json_as<std::int64_t>(*version).value_or(document.version);
    }
    texts_.set(found->first, document.text);
    changed();
  }

  void changed() {
    dirty_ = true;
    names_.clear();
  }

  TextOf text_of() const {
    return [this](const std::string& path) -> std::optional<std::string> {
      const auto open = documents_.find(path);
      if (open != documents_.end()) return open->second.text;
      base::DiagnosticSink unread;
      auto text = base::read_file(path, unread);
      if (!text) return std::nullopt;
      return *std::move(text);
    };
  }

  /// The path of the document that a request is about; it must be open.
  std::string asked_path(const Json& params) const {
    const auto path = path_of_uri(text_member(member(params, "textDocument"), "uri"));
    if (!documents_.contains(path))
      throw Refused{RpcError::kInvalidParams, "this document is not open"};
    return path;
  }

  const NameMap& names(const std::string& path) {
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

  // Diagnostics.

  void diagnose() {
    std::set<std::string> wanted;
    for (const auto& [path, document] : documents_) {
      for (auto& root : roots_of(path, text_of())) wanted.insert(std::move(root));
    }
    stop_.store(false);
    if (is_waiting()) return;  // it came before the flag was lowered
    std::map<std::string, std::map<std::string, std::vector<EditorMessage>>> found;
    for (const auto& root : wanted) {
      auto messages = checked(root, texts_, stop_);
      if (!messages) return;  // a newer text is on its way
      found[root] = *std::move(messages);
    }
    dirty_ = false;
    std::map<std::string, std::vector<EditorMessage>> by_path;
    for (auto& [root, files] : found) {
      for (auto& [path, messages] : files) {
        auto& all = by_path[path];
        for (auto& message : messages) {
          const bool is_there = std::any_of(all.begin(), all.end(), [&](const auto& other) {
            return other.begin == message.begin && other.end == message.end &&
                   other.text == message.text;
          });
          if (!is_there) all.push_back(std::move(message));
        }
      }
    }
    for (const auto& [path, document] : documents_) by_path[path];
    for (const auto& [path, messages] : told_) by_path[path];
    for (const auto& [path, messages] : by_path) publish(path, messages);
    told_ = std::move(by_path);
    std::erase_if(told_, [](const auto& entry) { return entry.second.empty(); });
  }

  bool is_waiting() {
    const std::lock_guard lock(mutex_);
    return !queue_.empty() || ended_;
  }

  void publish(const std::string& path, const std::vector<EditorMessage>& messages) {
    const auto open = documents_.find(path);
    const auto text = text_of()(path).value_or("");
    const Positions positions(text, unit_);
    Json list = Json::array();
    for (const auto& message : messages) {
      list.push_back({{"range", range_of(positions, message.begin, message.end)},
                      {"severity", message.is_error ? 1 : 2},
                      {"code", message.code},
                      {"source", "parallax"},
                      {"message", message.text}});
    }
    Json params = {{"uri", open == documents_.end() ? uri_of_path(path) : open->second.uri},
                   {"diagnostics", std::move(list)}};
    if (open != documents_.end()) params["version"] = open->second.version;
    notify("textDocument/publishDiagnostics", std::move(params));
  }

  static Json range_of(const Positions& positions, std::size_t begin, std::size_t end) {
    return {{"start", json_of(positions.place(begin))}, {"end", json_of(positions.place(end))}};
  }

  // Names.

  struct Asked {
    std::string path;
    std::size_t offset = 0;
    const DeclaredName* name = nullptr;
  };

  Asked asked(const Json& params) {
    Asked out{asked_path(params)};
    const Positions positions(documents_[out.path].text, unit_);
    out.offset = positions.offset(place_of(member(params, "position")));
    out.name = names(out.path).at(out.path, out.offset);
    return out;
  }

  Json location(const std::string& path, std::size_t begin, std::size_t end) const {
    const auto text = text_of()(path).value_or("");
    const auto open = documents_.find(path);
    return {{"uri", open == documents_.end() ? uri_of_path(path) : open->second.uri},
            {"range", range_of(Positions(text, unit_), begin, end)}};
  }

  std::string word_at(const Asked& at) const {
    const auto& text = documents_.at(at.path).text;
    const auto is_word = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    };
    auto begin = at.offset, end = at.offset;
    while (begin > 0 && is_word(text[begin - 1])) --begin;
    while (end < text.size() && is_word(text[end])) ++end;
    return text.substr(begin, end - begin);
  }

  Json hover(const Json& params) {
    const auto at = asked(params);
    std::string words;
    if (at.name != nullptr) {
      words = fmt::format("```\n{}\n```\n", at.name->declaration);
      if (!at.name->comment.empty()) words += at.name->comment + "\n\n";
      constexpr std::size_t kMost = 8;
      const auto effects = names(at.path).effects(*at.name);
      for (std::size_t i = 0; i < std::min(effects.size(), kMost); ++i) {
        words += fmt::format("```\n{}\n```\n", effects[i]);
      }
      if (effects.size() > kMost)
        words += fmt::format("and {} more effect axioms\n", effects.size() - kMost);
      if (at.name->kind == NameKind::kSort) words += elements_of(*at.name, at.path);
    } else {
      words = core_help(word_at(at));
    }
    if (words.empty()) return nullptr;
    return {{"contents", {{"kind", "markdown"}, {"value", words}}}};
  }

  std::string elements_of(const DeclaredName& sort, const std::string& path) {
    std::string list;
    for (const auto& [name, declared] : names(path).declared()) {
      if (declared.kind == NameKind::kConstant &&
          declared.declaration.starts_with(sort.name + " ")) {
        list += (list.empty() ? "" : ", ") + name;
      }
    }
    return list.empty() ? "" : "elements: " + list + "\n";
  }

  Json definition(const Json& params) {
    const auto at = asked(params);
    if (at.name == nullptr) return nullptr;
    return location(at.name->path, at.name->begin, at.name->end);
  }

  Json references(const Json& params) {
    const auto at = asked(params);
    Json out = Json::array();
    if (at.name == nullptr) return out;
    for (const auto& place : names(at.path).places(*at.name))
      out.push_back(location(place.path, place.begin, place.end));
    return out;
  }

  Json highlights(const Json& params) {
    const auto at = asked(params);
    Json out = Json::array();
    if (at.name == nullptr) return out;
    const Positions positions(documents_[at.path].text, unit_);
    for (const auto& place : names(at.path).places(*at.name)) {
      if (place.path == at.path)
        out.push_back({{"range", range_of(positions, place.begin, place.end)}});
    }
    return out;
  }

  Json name_range(const Json& params) {
    const auto at = asked(params);
    if (at.name == nullptr) return nullptr;
    const Positions positions(documents_[at.path].text, unit_);
    for (const auto& place : names(at.path).places(*at.name)) {
      if (place.path == at.path && place.begin <= at.offset && at.offset <= place.end) {
        return range_of(positions, place.begin, place.end);
      }
    }
    return nullptr;
  }

  /// Everywhere, unless the compiler then finds errors that were not there: a name that is taken,
  /// or none at all.
  Json rename(const Json& params) {
    const auto at = asked(params);
    if (at.name == nullptr) throw Refused{RpcError::kFailed, "no declared name stands here"};
    const auto fresh = text_member(params, "newName");
    const auto old = at.name->name;
    const auto family = family_of(at.path, text_of());
    const NameMap all(family, text_of());
    const auto* name = all.at(at.path, at.offset);
    if (name == nullptr || all.declared().contains(fresh)) {
      throw Refused{RpcError::kFailed, fmt::format("`{}` is declared already", fresh)};
    }
    std::map<std::string, std::vector<NamedPlace>> by_path;
    for (const auto& place : all.places(*name)) by_path[place.path].push_back(place);
    auto renamed = texts_;
    Json changes = Json::object();
    for (const auto& [path, places] : by_path) {
      auto text = text_of()(path).value_or("");
      const Positions positions(text, unit_);
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
      const auto open = documents_.find(path);
      changes[open == documents_.end() ? uri_of_path(path) : open->second.uri] = std::move(edits);
    }
    std::atomic<bool> never{false};
    std::set<std::string> roots;
    for (const auto& path : family) {
      for (auto& root : roots_of(path, text_of())) roots.insert(std::move(root));
    }
    for (const auto& root : roots) {
      const auto before = checked(root, texts_, never), after = checked(root, renamed, never);
      const auto fault = first_new_error(*before, *after);
      if (!fault.empty())
        throw Refused{RpcError::kFailed,
                      fmt::format("with `{}` the model has an error: {}", fresh, fault)};
    }
    return {{"changes", std::move(changes)}};
  }

  static std::string first_new_error(
      const std::map<std::string, std::vector<EditorMessage>>& before,
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

  Json completion(const Json& params) {
    const auto path = asked_path(params);
    Json items = Json::array();
    const auto add = [&](std::string_view label, int kind, std::string_view detail) {
      items.push_back({{"label", label}, {"kind", kind}, {"detail", detail}});
    };
    for (const auto& [name, declared] : names(path).declared()) {
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

  Json symbols(const Json& params) {
    const auto path = asked_path(params);
    const Positions positions(documents_[path].text, unit_);
    Json out = Json::array();
    for (const auto& [name, declared] : names(path).declared()) {
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

  Json formatting(const Json& params) {
    const auto path = asked_path(params);
    const auto& text = documents_[path].text;
    if (!path.ends_with(".e")) return nullptr;
    base::SourceFiles files;
    base::DiagnosticSink sink;
    const auto file = base::register_text(path, text, files, sink);
    const auto formatted = file ? compiler::format_text(*file, files, sink)
                                : base::Result<std::string>(sink.already_reported());
    if (!formatted) throw Refused{RpcError::kFailed, "a text with syntax errors is not formatted"};
    if (*formatted == text) return Json::array();
    return Json::array(
        {{{"range", range_of(Positions(text, unit_), 0, text.size())}, {"newText", *formatted}}});
  }

  /// The mends that messages in the range name, where a change of text is one.
  Json actions(const Json& params) {
    const auto path = asked_path(params);
    const auto& text = documents_[path].text;
    const Positions positions(text, unit_);
    const auto& range = member(params, "range");
    const auto begin = positions.offset(place_of(member(range, "start"))),
               end = positions.offset(place_of(member(range, "end")));
    Json out = Json::array();
    const auto told = told_.find(path);
    if (told == told_.end() || dirty_) return out;
    for (const auto& message : told->second) {
      if (message.fix.empty() || message.end < begin || message.begin > end) continue;
      const auto fix = fix_of(message, text);
      if (!fix) continue;
      const Json edit = {{"range", range_of(positions, fix->begin, fix->end)},
                         {"newText", fix->text}};
      out.push_back({{"title", message.fix},
                     {"kind", "quickfix"},
                     {"edit", {{"changes", {{documents_[path].uri, Json::array({edit})}}}}}});
    }
    return out;
  }

  FrameReader reader_;
  int out_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable arrived_;
  std::deque<std::string> queue_;
  bool ended_ = false;

  std::atomic<bool> stop_{false};
  bool is_ready_ = false, was_shut_down_ = false, has_left_ = false;
  bool dirty_ = false;  // something open was not checked since it changed
  ColumnUnit unit_ = ColumnUnit::kUtf16;
  std::map<std::string, OpenDocument> documents_;  // by path
  base::OpenTexts texts_;                          // the same texts
  std::map<std::string, std::unique_ptr<NameMap>> names_;
  std::map<std::string, std::vector<EditorMessage>> told_;  // by path; none without a message
};

}  // namespace

int serve_editor(int in, int out) { return EditorServer(in, out).run(); }

}  // namespace parallax::tools::lsp
