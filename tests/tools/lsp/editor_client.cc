#include "tests/tools/lsp/editor_client.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "compiler/base/file_io.h"
#include "compiler/base/subprocess.h"

namespace parallax::test {

std::string uri(const std::string& path) { return "file://" + path; }

nlohmann::json place_in(const std::string& text, std::size_t offset) {
  const auto before = text.substr(0, offset);
  const auto line = std::count(before.begin(), before.end(), '\n');
  const auto start = before.rfind('\n');
  const auto column = start == std::string::npos ? offset : offset - start - 1;
  return {{"line", line}, {"character", column}};
}

EditorClient::EditorClient() {
  int to[2], from[2];
  if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe");
  base::SpawnOptions options;
  options.input = to[0];
  options.output = from[1];
  const auto started = base::spawn({PARALLAX_PROGRAM, "lsp"}, options);
  ::close(to[0]);
  ::close(from[1]);
  in_ = to[1];
  out_ = from[0];
  pid_ = started.pid;
  if (pid_ < 0) throw std::runtime_error("the server does not start");
}

EditorClient::~EditorClient() {
  close_input();
  if (pid_ > 0) base::wait_for(pid_);
  close_output();
}

void EditorClient::raw(const std::string& bytes) { base::write_all(in_, bytes); }

void EditorClient::send(const Json& message) {
  const auto text = message.dump();
  raw("Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
}

void EditorClient::note(const std::string& method, const Json& params) {
  send({{"jsonrpc", "2.0"}, {"method", method}, {"params", params}});
}

EditorClient::Json EditorClient::read() {
  const auto fill = [&] {
    char chunk[1U << 16U];
    const auto count = ::read(out_, chunk, sizeof chunk);
    if (count <= 0) return false;
    buffer_.append(chunk, static_cast<std::size_t>(count));
    return true;
  };
  std::size_t head = 0;
  while ((head = buffer_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) return Json(Json::value_t::discarded);
  }
  const auto length = std::stoul(buffer_.substr(buffer_.find(':') + 1));
  while (buffer_.size() < head + 4 + length) {
    if (!fill()) return Json(Json::value_t::discarded);
  }
  auto message = Json::parse(buffer_.substr(head + 4, length));
  buffer_.erase(0, head + 4 + length);
  return message;
}

EditorClient::Json EditorClient::ask(const std::string& method, const Json& params) {
  const int id = ++id_;
  send({{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}});
  while (true) {
    auto message = read();
    if (message.is_discarded()) throw std::runtime_error("the server ended at " + method);
    if (message.value("id", Json()) == id)
      return message.contains("result") ? message["result"] : message["error"];
    keep(message);
  }
}

void EditorClient::keep(const Json& message) {
  if (message.value("method", "") == "textDocument/publishDiagnostics")
    published_[message["params"]["uri"].get<std::string>()] = message["params"];
}

void EditorClient::open(const std::string& path, const std::string& text, int version) {
  note("textDocument/didOpen",
       {{"textDocument",
         {{"uri", uri(path)}, {"languageId", "dec"}, {"version", version}, {"text", text}}}});
}

void EditorClient::edit(const std::string& path, const std::string& text, std::size_t begin,
                        std::size_t end, const std::string& fresh, int version) {
  const Json change = {{"range", {{"start", place_in(text, begin)}, {"end", place_in(text, end)}}},
                       {"text", fresh}};
  note("textDocument/didChange", {{"textDocument", {{"uri", uri(path)}, {"version", version}}},
                                  {"contentChanges", Json::array({change})}});
}

EditorClient::Json EditorClient::diagnostics(const std::string& path, int version) {
  while (true) {
    const auto found = published_.find(uri(path));
    if (found != published_.end() && found->second.value("version", -1) == version)
      return found->second["diagnostics"];
    const auto message = read();
    if (message.is_discarded()) throw std::runtime_error("the server ended before its diagnostics");
    keep(message);
  }
}

EditorClient::Json EditorClient::last_diagnostics(const std::string& path) const {
  const auto found = published_.find(uri(path));
  return found == published_.end() ? Json() : found->second["diagnostics"];
}

void EditorClient::close_input() {
  if (in_ >= 0) ::close(in_);
  in_ = -1;
}

void EditorClient::close_output() {
  if (out_ >= 0) ::close(out_);
  out_ = -1;
}

int EditorClient::end() {
  while (out_ >= 0 && !read().is_discarded()) {
  }
  const int code = base::wait_for(pid_);
  pid_ = -1;
  return code;
}

}  // namespace parallax::test
