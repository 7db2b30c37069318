#include "compiler/base/open_texts.h"

#include <system_error>
#include <utility>

namespace parallax::base {
namespace {

thread_local const OpenTexts* edited_texts = nullptr;

std::string absolute_key(const std::filesystem::path& path) {
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(path, error);
  return error ? path.string() : real.string();
}

}  // namespace

void OpenTexts::set(const std::filesystem::path& path, std::string text) {
  texts_[absolute_key(path)] = std::move(text);
}

void OpenTexts::remove(const std::filesystem::path& path) { texts_.erase(absolute_key(path)); }

const std::string* OpenTexts::find(const std::filesystem::path& path) const {
  if (texts_.empty()) return nullptr;
  const auto found = texts_.find(absolute_key(path));
  return found == texts_.end() ? nullptr : &found->second;
}

ReadOpenTexts::ReadOpenTexts(const OpenTexts& texts) : before_(edited_texts) {
  edited_texts = &texts;
}
ReadOpenTexts::~ReadOpenTexts() { edited_texts = before_; }

const std::string* ReadOpenTexts::find(const std::filesystem::path& path) {
  return edited_texts == nullptr ? nullptr : edited_texts->find(path);
}

}  // namespace parallax::base
