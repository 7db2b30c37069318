#include "tools/cli/output.h"

#include <fmt/format.h>
#include <stdio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace parallax::tools {
namespace {

std::atomic<int> g_error{0};  // the first of standard output
std::atomic<bool> g_told{false};
std::atomic<bool> g_printed{false};

void note_error() {
  int none = 0;
  g_error.compare_exchange_strong(none, errno != 0 ? errno : EIO);
}

bool put(const std::string& text) {
  if (g_error.load() != 0) return false;
  if (text.empty()) return true;
  g_printed.store(true);
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return true;
  note_error();
  return false;
}

void put_error(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

bool print(const std::string& text, const base::LinesStyle& style) {
  return put(base::shown_lines(text, style));
}

bool print_exact(const std::string& text) {
  return ::isatty(STDOUT_FILENO) != 0 ? print(text) : put(text);
}

void print_if_free(const std::string& text) {
  if (::ftrylockfile(stdout) != 0) return;
  print(text);
  ::funlockfile(stdout);
}

int output_error() { return g_error.load(); }

void output_error_is_told() { g_told.store(true); }

int close_output(int code) {
  // A stream that was closed from the start loses nothing while nothing is printed.
  if (g_printed.exchange(false)) {
    errno = 0;
    if (std::fclose(stdout) != 0) note_error();  // some file systems report a full disk only here
  }
  const int error = g_error.load();
  if (error == 0) return code;
  // A reader that has seen enough (head) closes the pipe: that is no error to speak of.
  if (error != EPIPE && !g_told.load()) {
    write_error(fmt::format("parallax: standard output: {}\n", std::strerror(error)));
  }
  return code != 0 ? code : 2;
}

void write_error(const std::string& text, const base::LinesStyle& style) {
  put_error(base::shown_lines(text, style));
}

void show_progress(const std::string& line) { put_error('\r' + base::printable(line) + "\x1b[K"); }

void clear_progress() { put_error("\r\x1b[K"); }

}  // namespace parallax::tools
