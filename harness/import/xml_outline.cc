#include "harness/import/xml_outline.h"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace parallax::harness {
namespace {

constexpr std::string_view kSpaces = " \t\r\n";

class OutlineReader {
 public:
  explicit OutlineReader(std::string_view text) : text_(text) {}

  XmlOutline read() {
    if (text_.size() > kMaxImportBytes) {
      fail(0, fmt::format("the file is longer than {} MiB", kMaxImportBytes >> 20U));
    }
    if (const auto nul = text_.find('\0'); nul != text_.npos) fail(nul, "holds a NUL byte");
    while (!out_.fault && at_ < text_.size()) {
      const auto next = text_.find('<', at_);
      if (next == text_.npos) break;
      at_ = next;
      read_markup();
    }
    if (!out_.fault && !open_.empty()) {
      const XmlElement& last = out_.elements[open_.back()];
      fail(last.offset, fmt::format("`<{}>` is never closed", last.tag));
    }
    if (!out_.fault && out_.elements.empty()) fail(0, "there is no XML element");
    return std::move(out_);
  }

 private:
  bool here(std::string_view word) const { return text_.substr(at_).starts_with(word); }
  void fail(std::size_t offset, std::string message) {
    if (!out_.fault) out_.fault = TextFault{offset, std::move(message)};
  }

  void read_markup() {
    if (here("<!--")) {
      skip_past("-->", 4);
    } else if (here("<?")) {
      const auto end = text_.find("?>", at_);
      const auto odd = text_.find_first_of("<>", at_ + 1);
      if (end == text_.npos || odd != end + 1) {
        fail(at_, "an instruction `<?` does not end with the next `?>`");
      } else {
        at_ = end + 2;
      }
    } else if (here("<![CDATA[")) {
      fail(at_, "CDATA is not read");
    } else if (here("<!")) {
      fail(at_, "document types and entities are not read");
    } else if (here("</")) {
      read_end();
    } else {
      read_start();
    }
  }

  void skip_past(std::string_view end, std::size_t from) {
    const auto found = text_.find(end, at_ + from);
    if (found == text_.npos) return fail(at_, "a comment does not end");
    at_ = found + end.size();
  }

  void read_end() {
    const auto close = text_.find('>', at_);
    if (close == text_.npos) return fail(at_, "a tag does not end");
    auto tag = text_.substr(at_ + 2, close - at_ - 2);
    tag = tag.substr(0, tag.find_last_not_of(kSpaces) + 1);
    if (open_.empty() || out_.elements[open_.back()].tag != tag) {
      return fail(at_, fmt::format("`</{}>` closes nothing that is open", shortened(tag)));
    }
    XmlElement& element = out_.elements[open_.back()];
    element.text = text_.substr(content_.back(), at_ - content_.back());
    open_.pop_back();
    content_.pop_back();
    at_ = element.end = close + 1;
  }

  void read_start() {
    const auto start = at_++;
    XmlElement element;
    element.offset = start;
    element.tag = word();
    if (!open_.empty()) element.parent = open_.back();
    if (element.tag.empty()) return fail(start, "a `<` begins no tag");
    std::set<std::string_view> names;
    for (;;) {
      skip_spaces();
      if (here(">") || here("/>")) break;
      const auto name = word();
      skip_spaces();
      if (name.empty() || !here("=")) return fail(at_, "a tag is not well formed");
      ++at_;
      skip_spaces();
      const char quote = at_ < text_.size() ? text_[at_] : ' ';
      const auto end = quote == '"' || quote == '\'' ? text_.find(quote, at_ + 1) : text_.npos;
      if (end == text_.npos) return fail(start, "the value of an attribute is not well formed");
      const auto value = text_.substr(at_ + 1, end - at_ - 1);
      if (value.find('<') != value.npos) return fail(at_, "the value of an attribute holds a `<`");
      if (!names.insert(name).second) return fail(at_, "an attribute is given twice");
      if (name == "name") element.name = value;
      if (name == "link") element.link = value;
      element.attributes.push_back({name, value});
      at_ = end + 1;
    }
    if (out_.elements.size() == kMaxImportElements) {
      return fail(start, fmt::format("there are more than {} elements", kMaxImportElements));
    }
    if (open_.size() == kMaxImportDepth) {
      return fail(start, fmt::format("elements nest deeper than {}", kMaxImportDepth));
    }
    if (open_.empty() && !out_.elements.empty()) {
      return fail(start, "a second element stands beside the outermost one");
    }
    if (is_part(element) && ++parts_ > kMaxImportParts) {
      return fail(start, fmt::format("there are more than {} models, links, joints and frames",
                                     kMaxImportParts));
    }
    const bool is_empty = here("/>");
    if (is_empty) element.end = at_ + 2;
    out_.elements.push_back(std::move(element));
    if (is_empty) {
      at_ += 2;
      return;
    }
    ++at_;
    open_.push_back(out_.elements.size() - 1);
    content_.push_back(at_);
  }

  void skip_spaces() {
    const auto next = text_.find_first_not_of(kSpaces, at_);
    at_ = next == text_.npos ? text_.size() : next;
  }
  std::string_view word() {
    const auto end = text_.find_first_of(" \t\r\n=/<>\"'&!?", at_);
    const auto found = text_.substr(at_, end == text_.npos ? text_.npos : end - at_);
    at_ += found.size();
    return found;
  }
  static std::string_view shortened(std::string_view tag) { return tag.substr(0, 40); }

  std::string_view text_;
  std::size_t at_ = 0, parts_ = 0;
  XmlOutline out_;
  std::vector<std::size_t> open_, content_;  // elements, and where what is in them begins
};

}  // namespace

const XmlAttribute* XmlElement::find(std::string_view attribute) const {
  for (const XmlAttribute& one : attributes) {
    if (one.name == attribute) return &one;
  }
  return nullptr;
}

bool is_part(const XmlElement& element) {
  return element.tag == "model" || element.tag == "link" || element.tag == "joint" ||
         element.tag == "frame";
}

XmlOutline outline_of(std::string_view text) { return OutlineReader(text).read(); }

}  // namespace parallax::harness
