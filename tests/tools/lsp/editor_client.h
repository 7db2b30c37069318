#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace parallax::test {

/// An editor: starts `parallax lsp` and speaks to it over pipes.
class EditorClient {
 public:
  using Json = nlohmann::json;

  EditorClient();
  ~EditorClient();
  EditorClient(const EditorClient&) = delete;
  EditorClient& operator=(const EditorClient&) = delete;

  void raw(const std::string& bytes);
  void send(const Json& message);
  void note(const std::string& method, const Json& params);
  /// The result, or the error, of a request; messages about files that come meanwhile are kept.
  Json ask(const std::string& method, const Json& params);
  /// Opens a file of the disk with this text.
  void open(const std::string& path, const std::string& text, int version = 1);
  /// Replaces bytes of a text without characters beyond ASCII, as an editor tells it.
  void edit(const std::string& path, const std::string& text, std::size_t begin, std::size_t end,
            const std::string& fresh, int version);
  /// The messages about this version of a file, as they were published last.
  Json diagnostics(const std::string& path, int version);
  /// The next message; discarded at the end of the output.
  Json read();
  int process() const { return pid_; }
  /// The messages about a file that were published last, of any version; null: never.
  Json last_diagnostics(const std::string& path) const;
  void close_input();
  /// Nobody reads what the server says any more.
  void close_output();
  /// Waits for the server's end; its exit code.
  int end();

 private:
  void keep(const Json& message);

  int in_ = -1, out_ = -1, pid_ = -1, id_ = 0;
  std::string buffer_;
  std::map<std::string, Json> published_;  // the parameters, by URI
};

std::string uri(const std::string& path);
nlohmann::json place_in(const std::string& text, std::size_t offset);

}  // namespace parallax::test
