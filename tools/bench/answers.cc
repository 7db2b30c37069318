#include "tools/bench/answers.h"

namespace parallax::tools {
namespace {

constexpr const char* kDigits = "0123456789";

/// The digits after the last `mark` and blanks.
std::string number_after(const std::string& text, const std::string& mark) {
  const auto at = text.rfind(mark);
  if (at == std::string::npos) return "";
  const auto begin = text.find_first_not_of(' ', at + mark.size());
  if (begin == std::string::npos) return "";
  const auto end = text.find_first_not_of(kDigits, begin);
  return text.substr(begin, end == std::string::npos ? end : end - begin);
}

}  // namespace

std::string clingo_answer(const std::string& tail) {
  const auto at = tail.rfind("\nModels ");
  if (at == std::string::npos) return "";
  return number_after(tail.substr(at, tail.find('\n', at + 1) - at), ":");
}

std::string jsonl_answer(const std::string& tail) {
  const auto at = tail.rfind("{\"summary\":true");
  return at == std::string::npos ? "" : number_after(tail.substr(at), "\"traces\":");
}

std::string count_answer(const std::string& tail) {
  const auto line = tail.substr(0, tail.find('\n'));
  return line.find_first_not_of(kDigits) == std::string::npos ? line : "";
}

}  // namespace parallax::tools
