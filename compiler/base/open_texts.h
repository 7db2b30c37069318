#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace parallax::base {

/// Texts that somebody is editing, by path: they are newer than the files.
class OpenTexts {
 public:
  void set(const std::filesystem::path& path, std::string text);
  void remove(const std::filesystem::path& path);
  /// Null where nobody edits the file.
  const std::string* find(const std::filesystem::path& path) const;

 private:
  std::map<std::string, std::string> texts_;  // by absolute path
};

/// While it lives, read_file in this thread takes these texts for what the files hold.
class ReadOpenTexts {
 public:
  explicit ReadOpenTexts(const OpenTexts& texts);
  ~ReadOpenTexts();
  ReadOpenTexts(const ReadOpenTexts&) = delete;
  ReadOpenTexts& operator=(const ReadOpenTexts&) = delete;

  /// The text to be read for the path in this thread; null: the file's own.
  static const std::string* find(const std::filesystem::path& path);

 private:
  const OpenTexts* before_;
};

}  // namespace parallax::base
