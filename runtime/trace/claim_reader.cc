#include "runtime/trace/claim_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "compiler/base/codes/artifacts.h"
#include "compiler/base/suggest.h"
#include "compiler/base/whole_number.h"

namespace parallax::runtime {

using compiler::AtomKind;

namespace {

/// Tells how far the lexer has read.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, std::size_t* count) : at_(at), count_(count) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    ++*count_;
    return *this;
  }
  CountingIterator operator++(int) {
    const auto before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  std::size_t* count_;
};

constexpr std::size_t kMaxQuoted = 60;       // bytes of a value in a message
constexpr std::size_t kMaxSuggested = 5000;  // names that a misspelled one is compared with

void collect(const std::vector<SymbolInstances>& symbols, std::unordered_set<std::string>& names) {
  for (const auto& symbol : symbols) names.insert(symbol.atoms.begin(), symbol.atoms.end());
}

std::string quoted(const JsonValue& value) {
  switch (value.kind()) {
    case JsonKind::kNull:
      return "null";
    case JsonKind::kBoolean:
      return value.boolean() ? "true" : "false";
    case JsonKind::kNumber:
      return std::string(value.text().substr(0, kMaxQuoted));
    case JsonKind::kString: {
      const auto text = value.text();
      return fmt::format("`{}{}`", text.substr(0, kMaxQuoted),
                         text.size() > kMaxQuoted ? "..." : "");
    }
    case JsonKind::kArray:
      return "a list";
    case JsonKind::kObject:
      return "an object";
  }
  return {};
}

const char* word_of(AtomKind kind) {
  if (kind == AtomKind::kHappens) return "event";
  return kind == AtomKind::kPredicate ? "formula with the atom" : "fluent";
}

}  // namespace

/// Receives the events of nlohmann-json's parser, which does not recurse; false stops it.
class JsonBuilder {
 public:
  JsonBuilder(JsonDocument& document, std::string_view text, std::uint32_t begin,
              const std::size_t& read, base::DiagnosticSink& sink)
      : document_(document), text_(text), begin_(begin), read_(read), sink_(sink) {}

  // NOLINTBEGIN(readability-identifier-naming): the parser asks for these names.
  bool null() { return scalar(JsonKind::kNull); }
  bool boolean(bool value) { return scalar(JsonKind::kBoolean, value); }
  bool number_integer(std::int64_t) { return scalar(JsonKind::kNumber); }
  bool number_unsigned(std::uint64_t) { return scalar(JsonKind::kNumber); }
  bool number_float(double, const std::string&) { return scalar(JsonKind::kNumber); }
  bool string(std::string& value) { return scalar(JsonKind::kString, false, &value); }
  bool binary(std::vector<std::uint8_t>&) { return false; }
  bool key(std::string& value) { return scalar(JsonKind::kString, false, &value); }
  bool start_object(std::size_t) { return open(JsonKind::kObject); }
  bool start_array(std::size_t) { return open(JsonKind::kArray); }
  bool end_object() {
    std::uint32_t place = 0;
    if (document_.has_duplicate(stack_.back().node, place)) {
      return fail(document_.nodes_[place].begin, document_.nodes_[place].end,
                  "the name stands twice in the object");
    }
    return close();
  }
  bool end_array() { return close(); }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception&) {
    const auto size = static_cast<std::uint32_t>(text_.size());
    const auto at = std::min(static_cast<std::uint32_t>(position), size);
    if (at == 0 || text_.find_first_not_of(" \t\r\n", at - 1) == std::string_view::npos) {
      return fail(begin_ + size, begin_ + size, "it ends within a value");
    }
    return fail(begin_ + at - 1, begin_ + at, "this is no JSON");
  }
  // NOLINTEND(readability-identifier-naming)
  bool failed() const { return failed_; }

 private:
  struct Level {
    std::uint32_t node, last;  // the last child so far
  };

  bool fail(std::uint32_t begin, std::uint32_t end, const char* what) {
    if (!failed_) sink_.error(codes::kTraceFileSyntax, {document_.file_, begin, end}, what);
    failed_ = true;
    return false;
  }

  /// Where the token that was just read begins: behind the one before and the marks between.
  std::uint32_t token_begin() const {
    const auto at = std::min(text_.find_first_not_of(" \t\r\n,:", last_end_), text_.size());
    return static_cast<std::uint32_t>(at);
  }

  std::uint32_t append(JsonKind kind) {
    const auto index = static_cast<std::uint32_t>(document_.nodes_.size());
    JsonDocument::Node node;
    node.kind = kind;
    node.begin = begin_ + token_begin();
    document_.nodes_.push_back(node);
    if (!stack_.empty()) {
      auto& level = stack_.back();
      auto& link = level.last == JsonDocument::kNone ? document_.nodes_[level.node].child
                                                     : document_.nodes_[level.last].next;
      link = index;
      level.last = index;
    }
    return index;
  }

  bool room(std::uint32_t at) {
    if (document_.nodes_.size() < JsonDocument::kMaxValues) return true;
    return fail(begin_ + at, begin_ + at + 1, "it has more than four million values");
  }

  bool scalar(JsonKind kind, bool truth = false, const std::string* value = nullptr) {
    const auto at = token_begin();
    if (!room(at)) return false;
    auto& node = document_.nodes_[append(kind)];
    node.truth = truth;
    auto end = static_cast<std::uint32_t>(read_);
    if (kind == JsonKind::kNumber) {  // the lexer has read the character behind it
      end = static_cast<std::uint32_t>(
          std::min(text_.find_first_not_of("+-.0123456789eE", at), text_.size()));
    }
    node.end = begin_ + end;
    last_end_ = end;
    if (value != nullptr) {
      node.text = static_cast<std::uint32_t>(document_.pool_.size());
      node.size = static_cast<std::uint32_t>(value->size());
      document_.pool_ += *value;
    }
    return true;
  }

  bool open(JsonKind kind) {
    const auto at = token_begin();
    if (!room(at)) return false;
    if (stack_.size() == JsonDocument::kMaxDepth) {
      return fail(begin_ + at, begin_ + at + 1, "it nests too deep");
    }
    const auto index = append(kind);
    stack_.push_back({index, JsonDocument::kNone});
    last_end_ = at + 1;
    return true;
  }

  bool close() {
    const auto at = token_begin();  // of the bracket
    document_.nodes_[stack_.back().node].end = begin_ + at + 1;
    stack_.pop_back();
    last_end_ = at + 1;
    return true;
  }

  JsonDocument& document_;
  std::string_view text_;
  std::uint32_t begin_;
  const std::size_t& read_;
  base::DiagnosticSink& sink_;
  std::vector<Level> stack_;
  std::size_t last_end_ = 0;
  bool failed_ = false;
};

base::Result<JsonDocument> JsonDocument::parse(base::SourceRange text,
                                               const base::SourceFiles& files,
                                               base::DiagnosticSink& sink) {
  const auto part = files.text(text);
  JsonDocument document(files[text.file].text(), text.file);
  std::size_t read = 0;
  JsonBuilder builder(document, part, text.begin, read, sink);
  const CountingIterator begin(part.data(), &read), end(part.data() + part.size(), &read);
  if (nlohmann::json::sax_parse(begin, end, &builder)) return document;
  if (builder.failed()) return sink.already_reported();
  return sink.error(codes::kTraceFileSyntax, text, "this is no JSON");
}

bool JsonDocument::has_duplicate(std::uint32_t object, std::uint32_t& place) const {
  std::vector<std::pair<std::string_view, std::uint32_t>> names;
  for (auto i = nodes_[object].child; i != kNone; i = nodes_[nodes_[i].next].next) {
    names.emplace_back(std::string_view(pool_).substr(nodes_[i].text, nodes_[i].size), i);
  }
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(
      names.begin(), names.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice == names.end()) return false;
  place = std::next(twice)->second;
  return true;
}

JsonKind JsonValue::kind() const { return document_->nodes_[index_].kind; }

base::SourceRange JsonValue::source() const {
  const auto& node = document_->nodes_[index_];
  return {document_->file_, node.begin, node.end};
}

bool JsonValue::boolean() const { return document_->nodes_[index_].truth; }

std::string_view JsonValue::text() const {
  const auto& node = document_->nodes_[index_];
  if (node.kind == JsonKind::kNumber) {
    return document_->file_text_.substr(node.begin, node.end - node.begin);
  }
  return std::string_view(document_->pool_).substr(node.text, node.size);
}

std::optional<std::int64_t> JsonValue::integer() const {
  if (!is(JsonKind::kNumber)) return std::nullopt;
  return base::whole_number<std::int64_t>(text());
}

std::vector<JsonValue> JsonValue::items() const {
  std::vector<JsonValue> out;
  if (!is(JsonKind::kArray) && !is(JsonKind::kObject)) return out;
  const auto& nodes = document_->nodes_;
  for (auto i = nodes[index_].child; i != JsonDocument::kNone; i = nodes[i].next) {
    out.push_back({document_, i});
  }
  return out;
}

std::vector<JsonValue> JsonValue::members() const { return items(); }

std::optional<JsonValue> JsonValue::find(std::string_view name) const {
  if (!is(JsonKind::kObject)) return std::nullopt;
  const auto& nodes = document_->nodes_;
  for (auto i = nodes[index_].child; i != JsonDocument::kNone; i = nodes[nodes[i].next].next) {
    if (JsonValue(document_, i).text() == name) return JsonValue(document_, nodes[i].next);
  }
  return std::nullopt;
}

ClaimReader::ClaimReader(const Vocabulary& vocabulary, base::DiagnosticSink& sink)
    : vocabulary_(&vocabulary), sink_(sink) {
  collect(vocabulary.fluents, fluents_);
  collect(vocabulary.events, events_);
  collect(vocabulary.predicates, predicates_);
}

base::Reported ClaimReader::unexpected(std::string_view what, const JsonValue& found) {
  return sink_.error(codes::kTraceFileShape, found.source(), what, quoted(found));
}

const std::vector<SymbolInstances>& ClaimReader::symbols_of(AtomKind kind) const {
  if (kind == AtomKind::kHappens) return vocabulary_->events;
  return kind == AtomKind::kPredicate ? vocabulary_->predicates : vocabulary_->fluents;
}

bool ClaimReader::has_symbol(AtomKind kind, const std::string& symbol) const {
  if (vocabulary_ == nullptr) return true;
  const auto& symbols = symbols_of(kind);
  return std::any_of(symbols.begin(), symbols.end(),
                     [&](const auto& one) { return one.symbol == symbol; });
}

bool ClaimReader::may_happen_last(const std::string& event, Timepoint length) const {
  if (vocabulary_ == nullptr) return true;
  return length == vocabulary_->horizon && vocabulary_->last_events.contains(event);
}

bool ClaimReader::has(AtomKind kind, const std::string& name) const {
  if (vocabulary_ == nullptr) return true;
  if (kind == AtomKind::kHappens) return events_.contains(name);
  if (kind == AtomKind::kPredicate) return predicates_.contains(name);
  return fluents_.contains(name);
}

/// E6103, reported, for an atom that the model does not have.
bool ClaimReader::know(AtomKind kind, const std::string& name, base::SourceRange source) {
  if (has(kind, name)) return true;
  auto built = sink_.error(codes::kTraceUnknownAtom, source, word_of(kind), name);
  std::vector<std::string> names;
  for (const auto& symbol : symbols_of(kind)) {
    names.insert(names.end(), symbol.atoms.begin(), symbol.atoms.end());
  }
  if (names.size() > kMaxSuggested) return false;
  if (const auto near = base::nearest_name(name, names)) {
    built.fix(fmt::format("replace `{}` with `{}`", name, *near));
  }
  return false;
}

bool ClaimReader::claim(AtomKind kind, std::string name, const AtomClaim& claim,
                        AtomClaims& claims) {
  if (!know(kind, name, claim.source)) return false;
  const auto [entry, added] = claims.listed.try_emplace(std::move(name), claim);
  if (added || entry->second.value == claim.value) return true;
  sink_
      .error(codes::kTraceFileShape, claim.source, fmt::format("one value of `{}`", entry->first),
             "another one")
      .note(entry->second.source, "the first one stands here");
  return false;
}

bool ClaimReader::leave_open(AtomKind kind, std::string name, base::SourceRange source,
                             AtomClaims& claims) {
  if (!know(kind, name, source)) return false;
  const auto claimed = claims.listed.find(name);
  if (claimed == claims.listed.end()) {
    claims.open.insert(std::move(name));
    return true;
  }
  sink_
      .error(codes::kTraceFileShape, source, "an atom that has no value",
             fmt::format("`{}`, which has one", name))
      .note(claimed->second.source, "the value stands here");
  return false;
}

}  // namespace parallax::runtime
