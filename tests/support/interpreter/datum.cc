#include "tests/support/interpreter/datum.h"

#include <cctype>
#include <cstdlib>
#include <stdexcept>

namespace parallax::test {
namespace {

Datum symbol(std::string text) {
  Datum out;
  out.kind = Datum::Kind::kSymbol;
  out.text = std::move(text);
  return out;
}

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  std::vector<Datum> all() {
    std::vector<Datum> out;
    for (skip(); i_ < text_.size(); skip()) out.push_back(datum());
    return out;
  }

 private:
  void skip() {
    while (i_ < text_.size()) {
      if (text_[i_] == ';') {
        while (i_ < text_.size() && text_[i_] != '\n') ++i_;
      } else if (std::isspace(static_cast<unsigned char>(text_[i_])) != 0) {
        ++i_;
      } else {
        return;
      }
    }
  }

  Datum wrapped(const char* name, std::size_t length) {
    i_ += length;
    skip();
    Datum out;
    out.items.push_back(symbol(name));
    out.items.push_back(datum());
    return out;
  }

  Datum datum() {
    if (i_ >= text_.size()) throw std::runtime_error("the text ends in a datum");
    if (text_[i_] == '\'') return wrapped("quote", 1);
    if (text_.substr(i_).starts_with("#'")) return wrapped("function", 2);
    if (text_[i_] == '(') return list();
    if (text_[i_] == '"') return string();
    const auto begin = i_;
    while (i_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[i_])) == 0 &&
           std::string_view("();\"'").find(text_[i_]) == std::string_view::npos) {
      ++i_;
    }
    return atom(std::string(text_.substr(begin, i_ - begin)));
  }

  Datum list() {
    Datum out;
    ++i_;
    for (skip(); i_ < text_.size() && text_[i_] != ')'; skip()) out.items.push_back(datum());
    if (i_ == text_.size()) throw std::runtime_error("a list is not closed");
    ++i_;
    return out;
  }

  Datum string() {
    Datum out;
    out.kind = Datum::Kind::kString;
    for (++i_; i_ < text_.size() && text_[i_] != '"'; ++i_) out.text += text_[i_];
    ++i_;
    return out;
  }

  static Datum atom(std::string word) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (end == word.c_str() + word.size() && !word.empty()) {
      Datum out;
      out.kind = Datum::Kind::kNumber;
      out.number = number;
      out.text = std::move(word);
      return out;
    }
    const bool keyword = word.starts_with(':');
    if (const auto colon = word.rfind(':'); colon != std::string::npos) word.erase(0, colon + 1);
    for (auto& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    auto out = symbol(std::move(word));
    out.keyword = keyword;
    return out;
  }

  std::string_view text_;
  std::size_t i_ = 0;
};

}  // namespace

std::vector<Datum> read_data(std::string_view text) { return Reader(text).all(); }

std::string print(const Datum& datum) {
  if (datum.kind == Datum::Kind::kString) return '"' + datum.text + '"';
  if (!datum.is_list()) return (datum.keyword ? ":" : "") + datum.text;
  if (datum.head() == "quote" && datum.items.size() == 2) return "'" + print(datum.items[1]);
  std::string out = "(";
  for (const auto& item : datum.items) {
    if (out.size() > 1) out += ' ';
    out += print(item);
  }
  return out + ")";
}

}  // namespace parallax::test
