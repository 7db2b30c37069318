#include "tests/support/xml.h"

#include <cctype>
#include <stdexcept>

namespace parallax::test {
namespace {

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  XmlElement document() {
    if (text_.starts_with("<?xml ")) at_ = need(text_.find("?>")) + 2;
    blanks();
    XmlElement root = element();
    blanks();
    if (at_ != text_.size()) fail("text after the outermost element");
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("offset " + std::to_string(at_) + ": " + what);
  }
  std::size_t need(std::size_t found) const {
    if (found == std::string_view::npos) fail("unfinished");
    return found;
  }
  char peek() const {
    if (at_ >= text_.size()) fail("unfinished");
    return text_[at_];
  }
  void blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  void expect(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) fail("expected " + std::string(word));
    at_ += word.size();
  }

  std::string name() {
    const auto begin = at_;
    while (std::isalnum(static_cast<unsigned char>(peek())) != 0 || peek() == '-' ||
           peek() == ':' || peek() == '_') {
      ++at_;
    }
    if (at_ == begin) fail("expected a name");
    return std::string(text_.substr(begin, at_ - begin));
  }

  std::string entity() {
    const auto end = need(text_.find(';', at_));
    const auto word = text_.substr(at_ + 1, end - at_ - 1);
    static const std::map<std::string_view, std::string> kKnown = {
        {"lt", "<"}, {"gt", ">"}, {"amp", "&"}, {"quot", "\""}, {"apos", "'"}};
    std::string out;
    if (const auto known = kKnown.find(word); known != kKnown.end()) {
      out = known->second;
    } else if (word.size() > 1 && word.size() < 4 && word[0] == '#' &&
               word.find_first_not_of("0123456789", 1) == std::string_view::npos) {
      out = static_cast<char>(std::stoi(std::string(word.substr(1))));
    } else {
      fail("an unknown entity");
    }
    at_ = end + 1;
    return out;
  }

  std::string characters(char end) {
    std::string out;
    while (peek() != end) {
      const auto byte = static_cast<unsigned char>(peek());
      if (byte < 0x20U && byte != '\n' && byte != '\t') fail("a control character");
      if (byte == '<') {
        if (end == '<') break;
        fail("`<` in an attribute");
      }
      if (byte == '&') {
        out += entity();
      } else {
        out += text_[at_++];
      }
    }
    return out;
  }

  void attributes(XmlElement& element) {
    for (;;) {
      const auto before = at_;
      blanks();
      if (peek() == '>' || peek() == '/') return;
      if (before == at_) fail("no blank before an attribute");
      const auto key = name();
      expect("=\"");
      if (!element.attributes.emplace(key, characters('"')).second) fail("a second " + key);
      ++at_;
    }
  }

  XmlElement element() {
    expect("<");
    XmlElement out;
    out.name = name();
    attributes(out);
    if (peek() == '/') {
      expect("/>");
      return out;
    }
    expect(">");
    for (;;) {
      out.text += characters('<');
      if (text_.substr(at_, 2) == "</") break;
      out.children.push_back(element());
    }
    expect("</");
    expect(out.name);
    blanks();
    expect(">");
    return out;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

void collect(const XmlElement& element, std::string_view wanted,
             std::vector<const XmlElement*>& out) {
  if (element.name == wanted) out.push_back(&element);
  for (const auto& child : element.children) collect(child, wanted, out);
}

}  // namespace

std::vector<const XmlElement*> XmlElement::all(std::string_view wanted) const {
  std::vector<const XmlElement*> out;
  collect(*this, wanted, out);
  return out;
}

const std::string& XmlElement::at(const std::string& attribute) const {
  const auto found = attributes.find(attribute);
  if (found == attributes.end()) {
    throw std::runtime_error("<" + name + "> has no attribute " + attribute);
  }
  return found->second;
}

XmlElement parse_xml(std::string_view text) { return Parser(text).document(); }

}  // namespace parallax::test
