// The conversation with an editor. One thread reads messages, the other one answers them in their
// order. After a change of a text it waits until nothing more comes for a moment, and checks what
// is open with the compiler itself; a change that comes meanwhile raises the stop flag of that
// check, whose result is then not told. Answers are made in name_answers and edit_answers, texts
// are kept in documents, messages are told by publishing.

#include "tools/lsp/server.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "tools/app/version.h"
#include "tools/lsp/documents.h"
#include "tools/lsp/edit_answers.h"
#include "tools/lsp/frames.h"
#include "tools/lsp/lenses.h"
#include "tools/lsp/name_answers.h"
#include "tools/lsp/publishing.h"
#include "tools/lsp/rpc.h"
#include "tools/lsp/semantic_tokens.h"
#include "tools/lsp/yaml_answers.h"

namespace parallax::tools::lsp {
namespace {

constexpr auto kQuiet = std::chrono::milliseconds(5);
constexpr int kKeptBytes = 64 << 20;

/// A question about open documents.
struct Question {
  std::string_view method;
  Json (*answer)(Documents& documents, const Json& params);
};

constexpr std::array<Question, 12> kQuestions = {{
    {"textDocument/hover", hover},
    {"textDocument/definition", definition},
    {"textDocument/references", references},
    {"textDocument/documentHighlight", highlights},
    {"textDocument/prepareRename", name_range},
    {"textDocument/rename", rename},
    {"textDocument/completion", completion},
    {"textDocument/documentSymbol", symbols},
    {"textDocument/formatting", formatting},
    {"textDocument/semanticTokens/full", semantic_tokens},
    {"textDocument/codeLens", lenses},
    {"textDocument/inlayHint", unit_hints},
}};

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
    if (!published_.is_current()) {
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
      } else if (!published_.is_current() && !is_over()) {
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
      if (!id->is_string() && !id->is_number() && !id->is_null())
        return refuse(nullptr, RpcError::kInvalidRequest, "`id` is no number and no text");
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
    const bool is_changed = (method == "textDocument/didOpen" && documents_.open(params)) ||
                            (method == "textDocument/didChange" && documents_.change(params)) ||
                            (method == "textDocument/didClose" && documents_.close(params)) ||
                            method == "textDocument/didSave" ||
                            method == "workspace/didChangeWatchedFiles";
    if (!is_changed) return;
    published_.outdate();
    documents_.forget_names();
  }

  Json result(const std::string& method, const Json& params) {
    if (method == "initialize") return initialize(params);
    if (method == "shutdown") {
      was_shut_down_ = true;
      return nullptr;
    }
    if (method == "textDocument/codeAction") return actions(documents_, published_, params);
    const auto* question = std::find_if(kQuestions.begin(), kQuestions.end(),
                                        [&](const auto& one) { return one.method == method; });
    if (question != kQuestions.end()) return question->answer(documents_, params);
    throw Refused{RpcError::kNoMethod, fmt::format("there is no method `{}`", method)};
  }

  Json initialize(const Json& params) {
    is_ready_ = true;
    if (const auto* client = base::json_member(params, "capabilities")) {
      if (const auto* general = base::json_member(*client, "general")) {
        if (const auto* units = base::json_member(*general, "positionEncodings");
            units != nullptr && units->is_array()) {
          if (std::find(units->begin(), units->end(), Json("utf-8")) != units->end())
            documents_.count_columns_in(ColumnUnit::kByte);
        }
      }
    }
    return {{"serverInfo", {{"name", "parallax"}, {"version", kVersion}}},
            {"capabilities",
             {{"positionEncoding", documents_.unit() == ColumnUnit::kByte ? "utf-8" : "utf-16"},
              {"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", true}}},
              {"hoverProvider", true},
              {"definitionProvider", true},
              {"referencesProvider", true},
              {"documentHighlightProvider", true},
              {"renameProvider", {{"prepareProvider", true}}},
              {"completionProvider", {{"resolveProvider", false}}},
              {"documentSymbolProvider", true},
              {"documentFormattingProvider", true},
              {"semanticTokensProvider",
               {{"legend", {{"tokenTypes", token_legend()}, {"tokenModifiers", Json::array()}}},
                {"full", true}}},
              {"codeLensProvider", {{"resolveProvider", false}}},
              {"inlayHintProvider", true},
              {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}}}}};
  }

  void diagnose() {
    stop_.store(false);
    if (is_waiting()) return;  // it came before the flag was lowered
    published_.publish(documents_, stop_, [this](const char* method, Json params) {
      notify(method, std::move(params));
    });
  }

  bool is_waiting() {
    const std::lock_guard lock(mutex_);
    return !queue_.empty() || ended_;
  }

  FrameReader reader_;
  int out_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable arrived_;
  std::deque<std::string> queue_;
  bool ended_ = false;

  std::atomic<bool> stop_{false};
  bool is_ready_ = false, was_shut_down_ = false, has_left_ = false;
  Documents documents_;
  Publishing published_;
};

}  // namespace

int serve_editor(int in, int out) {
  // A check takes about as much memory as the one before. Given back to the system in between, it
  // would come back page by page, which takes longer than to parse the model.
  ::mallopt(M_MMAP_THRESHOLD, kKeptBytes);
  ::mallopt(M_TRIM_THRESHOLD, kKeptBytes);
  return EditorServer(in, out).run();
}

}  // namespace parallax::tools::lsp
