#include "tests/tools/page/html_check.h"

#include <algorithm>
#include <utility>

namespace parallax::test {
namespace {

const std::set<std::string, std::less<>> kVoid = {"meta", "input", "br", "link"};
const std::set<std::string, std::less<>> kBlocks = {
    "p",     "h1",      "h2",   "h3",     "tr",      "li",      "section",
    "table", "dt",      "dd",   "div",    "ul",      "nav",     "figcaption",
    "thead", "tbody",   "main", "header", "summary", "pre",     "dl",
    "svg",   "details", "text", "figure", "footer",  "article", "label"};
const std::set<std::string, std::less<>> kKnown = {
    "html",   "head",   "meta",     "title",    "style",   "body",    "a",        "header",
    "p",      "h1",     "h2",       "h3",       "dl",      "div",     "dt",       "dd",
    "nav",    "ul",     "li",       "main",     "section", "article", "table",    "caption",
    "thead",  "tbody",  "tr",       "th",       "td",      "span",    "figure",   "figcaption",
    "pre",    "mark",   "b",        "i",        "code",    "details", "summary",  "input",
    "label",  "select", "option",   "button",   "svg",     "desc",    "g",        "path",
    "rect",   "line",   "text",     "polyline", "polygon", "circle",  "progress", "footer",
    "script", "br",     "noscript", "ol",       "output"};

std::string unescaped(std::string_view text) {
  static const std::vector<std::pair<std::string_view, std::string_view>> kEntities = {
      {"&lt;", "<"},     {"&gt;", ">"},       {"&quot;", "\""}, {"&#39;", "'"}, {"&nbsp;", " "},
      {"&middot;", "-"}, {"&hellip;", "..."}, {"&le;", "<="},   {"&amp;", "&"}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto entity = std::find_if(kEntities.begin(), kEntities.end(), [&](const auto& one) {
      return text.substr(i).starts_with(one.first);
    });
    out += entity == kEntities.end() ? text.substr(i, 1) : entity->second;
    i += entity == kEntities.end() ? 1 : entity->first.size();
  }
  return out;
}

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  HtmlPage scan() {
    constexpr std::string_view kDoctype = "<!DOCTYPE html>";
    if (!text_.starts_with(kDoctype)) fault("no doctype");
    at_ = kDoctype.size();
    while (at_ < text_.size()) {
      if (text_[at_] == '<') {
        tag();
      } else {
        const auto end = std::min(text_.find('<', at_), text_.size());
        if (!open_.empty() && open_.back() != "title")
          add_text(unescaped(text_.substr(at_, end - at_)));
        at_ = end;
      }
    }
    if (!open_.empty()) fault("not closed: " + open_.back());
    for (const auto& target : links_) {
      if (!out_.ids.contains(target)) fault("a link to nowhere: #" + target);
    }
    return std::move(out_);
  }

 private:
  void fault(std::string what) {
    if (out_.faults.size() < 20) out_.faults.push_back(std::move(what));
  }

  void add_text(const std::string& text) {
    for (const char c : text) {
      const bool is_space = c == ' ' || c == '\n' || c == '\t';
      const bool is_pre = std::find(open_.begin(), open_.end(), "pre") != open_.end();
      if (is_pre) {
        out_.text += c;
      } else if (!is_space) {
        out_.text += c;
      } else if (!out_.text.empty() && out_.text.back() != ' ' && out_.text.back() != '\n') {
        out_.text += ' ';
      }
    }
  }
  void new_line() {
    while (!out_.text.empty() && out_.text.back() == ' ') out_.text.pop_back();
    if (!out_.text.empty() && out_.text.back() != '\n') out_.text += '\n';
  }

  void tag() {
    if (text_.substr(at_).starts_with("</")) {
      const auto end = text_.find('>', at_);
      const std::string name(text_.substr(at_ + 2, end - at_ - 2));
      if (open_.empty() || open_.back() != name) {
        fault("</" + name + "> closes " + (open_.empty() ? "nothing" : open_.back()));
      }
      if (!open_.empty()) open_.pop_back();
      if (kBlocks.contains(name)) new_line();
      if (name == "td" || name == "th") add_text(" ");
      at_ = end + 1;
      return;
    }
    auto end = at_ + 1;
    while (end < text_.size() && text_[end] != '>' && text_[end] != ' ' && text_[end] != '/') ++end;
    const std::string name(text_.substr(at_ + 1, end - at_ - 1));
    if (!kKnown.contains(name)) fault("an element <" + name.substr(0, 40) + ">");
    ++out_.elements[name];
    if (kBlocks.contains(name)) new_line();
    at_ = end;
    std::map<std::string, std::string> attributes;
    bool closed = false;
    while (at_ < text_.size() && text_[at_] != '>') {
      if (text_[at_] == ' ' || text_[at_] == '\n') {
        ++at_;
      } else if (text_[at_] == '/') {
        closed = true;
        ++at_;
      } else {
        attribute(attributes);
      }
    }
    ++at_;
    look_at(name, attributes);
    if (name == "style" || name == "script") {
      raw(name, attributes);
    } else if (!closed && !kVoid.contains(name)) {
      open_.push_back(name);
    }
  }

  void attribute(std::map<std::string, std::string>& attributes) {
    auto end = at_;
    while (end < text_.size() &&
           std::string_view("= >/").find(text_[end]) == std::string_view::npos)
      ++end;
    const std::string name(text_.substr(at_, end - at_));
    at_ = end;
    std::string value;
    if (at_ < text_.size() && text_[at_] == '=') {
      if (text_.substr(at_, 2) != "=\"") return fault("no quotes at " + name), void(++at_);
      const auto close = text_.find('"', at_ + 2);
      value = unescaped(text_.substr(at_ + 2, close - at_ - 2));
      at_ = close + 1;
    }
    attributes[name] = value;
  }

  void look_at(const std::string& name, const std::map<std::string, std::string>& attributes) {
    for (const auto& [attribute, value] : attributes) {
      if (attribute == "style" || attribute == "src" || attribute.starts_with("on")) {
        fault("<" + name + " " + attribute + ">");
      }
      if (attribute == "id" && !out_.ids.insert(value).second) fault("the id " + value + " twice");
      if (attribute == "href") {
        value.starts_with('#') ? links_.push_back(value.substr(1)) : fault("a link to " + value);
      }
    }
    const auto meta = attributes.find("http-equiv");
    if (meta != attributes.end() && meta->second == "Content-Security-Policy") {
      out_.policy = attributes.at("content");
    }
  }

  /// Up to the end tag, whatever stands there.
  void raw(const std::string& name, const std::map<std::string, std::string>& attributes) {
    const auto end = text_.find("</" + name, at_);
    const std::string body(text_.substr(at_, end - at_));
    const auto id = attributes.find("id");
    const bool is_motion = id != attributes.end() && id->second == "motion-data";
    (name == "style"               ? out_.style
     : is_motion                   ? out_.motion
     : attributes.contains("type") ? out_.data
                                   : out_.script) += body;
    at_ = text_.find('>', end) + 1;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::string> open_, links_;
  HtmlPage out_;
};

}  // namespace

HtmlPage check_html(std::string_view page) { return Scanner(page).scan(); }

}  // namespace parallax::test
