#include "compiler/lisp/lisp_data.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/base/ascii.h"

namespace parallax::compiler {
namespace {

bool needs_bars(std::string_view name) {
  if (name.empty() || name == ".") return true;
  Number ignored;
  if (Number::parse(name, ignored) != Number::Parse::kNotANumber) return true;
  for (const char c : name) {
    if (base::is_upper(c)) return true;
    const auto byte = static_cast<unsigned char>(c);
    if (byte <= 0x20 || byte == 0x7F) return true;
    if (std::string_view("()\"';`,|\\:#").find(c) != std::string_view::npos) return true;
  }
  return name.find_first_not_of('.') == std::string_view::npos;
}

void print_escaped(std::string_view text, char quote, std::string& out) {
  out += quote;
  for (const char c : text) {
    if (c == quote || c == '\\') out += '\\';
    out += c;
  }
  out += quote;
}

void print_name(std::string_view name, std::string& out) {
  if (needs_bars(name)) {
    print_escaped(name, '|', out);
  } else {
    out += name;
  }
}

void print_atom(const LispData& data, DatumId id, std::string& out) {
  switch (data[id].kind) {
    case DatumKind::kSymbol:
      if (!data.package(id).empty()) {
        print_name(data.package(id), out);
        out += "::";
      }
      print_name(data.name(id), out);
      return;
    case DatumKind::kKeyword:
      out += ':';
      print_name(data.name(id), out);
      return;
    case DatumKind::kNumber:
      out += data.number(id).to_string();
      return;
    case DatumKind::kString:
      print_escaped(data.name(id), '"', out);
      return;
    case DatumKind::kCharacter:
      out += "#\\" + data.name(id);
      return;
    case DatumKind::kList:
      return;
  }
}

bool equal_shallow(const LispData& a, DatumId left, const LispData& b, DatumId right) {
  if (a[left].kind != b[right].kind) return false;
  switch (a[left].kind) {
    case DatumKind::kSymbol:
    case DatumKind::kKeyword:
    case DatumKind::kString:
    case DatumKind::kCharacter:
      return a.name(left) == b.name(right) && a.package(left) == b.package(right);
    case DatumKind::kNumber:
      return a.number(left) == b.number(right);
    case DatumKind::kList:
      return a[left].count == b[right].count && a[left].dotted == b[right].dotted;
  }
  return false;
}

}  // namespace

LispData::LispData() { intern(""); }

NameId LispData::intern(std::string_view text) {
  const auto found = name_ids_.find(text);
  if (found != name_ids_.end()) return found->second;
  const NameId id(static_cast<std::uint32_t>(names_.size()));
  names_.emplace_back(text);
  name_ids_.emplace(std::string(text), id);
  return id;
}

DatumId LispData::add_named(DatumKind kind, std::string_view name, std::string_view package,
                            base::SourceRange source, bool external) {
  const auto id = intern(name);
  return data_.add({kind, false, external, id, intern(package), id, 0, 0, nullptr, source});
}

DatumId LispData::add_number(const Number& number, base::SourceRange source) {
  const auto index = static_cast<std::uint32_t>(numbers_.size());
  numbers_.push_back(number);
  return data_.add(
      {DatumKind::kNumber, false, false, NameId(), NameId(), NameId(), index, 0, nullptr, source});
}

DatumId LispData::add_list(std::span<const DatumId> children, base::SourceRange source) {
  const auto* kept = keep(children);
  const auto count = static_cast<std::uint32_t>(children.size());
  return data_.add(
      {DatumKind::kList, false, false, NameId(), NameId(), NameId(), 0, count, kept, source});
}

const DatumId* LispData::keep(std::span<const DatumId> children) {
  constexpr std::size_t kBlock = 4096;
  places_ += children.size();
  if (block_used_ + children.size() > block_size_) {
    block_size_ = std::max(kBlock, children.size());
    block_used_ = 0;
    blocks_.push_back(std::make_unique<DatumId[]>(block_size_));
  }
  if (children.empty()) return nullptr;
  auto* out = blocks_.back().get() + block_used_;
  std::copy(children.begin(), children.end(), out);
  block_used_ += children.size();
  return out;
}

void LispData::note_expansion(DatumId begin, DatumId call) {
  if (begin < end_id()) expansions_.push_back({begin, end_id(), call});
}

std::optional<DatumId> LispData::macro_call(DatumId id) const {
  const auto after = std::upper_bound(expansions_.begin(), expansions_.end(), id,
                                      [](DatumId at, const Part& part) { return at < part.begin; });
  if (after == expansions_.begin()) return std::nullopt;
  const auto& part = *std::prev(after);
  return id < part.end ? std::optional(part.call) : std::nullopt;
}

DatumId LispData::add_dotted(std::vector<DatumId> items, DatumId tail, base::SourceRange source) {
  const auto word = head(tail);
  const bool comma = word == "unquote" || word == "unquote-splicing";
  bool dotted = true;
  if (is_nil(tail)) {
    dotted = false;
  } else if (is_list(tail) && !comma) {
    dotted = is_dotted(tail);
    const auto rest = children(tail);
    items.insert(items.end(), rest.begin(), rest.end());
  } else {
    items.push_back(tail);
  }
  const auto id = add_list(items, source);
  data_[id].dotted = dotted;
  return id;
}

std::span<const DatumId> LispData::children(DatumId id) const {
  const auto& datum = data_[id];
  if (datum.kind != DatumKind::kList) return {};
  return {datum.children, datum.count};
}

bool LispData::is_symbol(DatumId id, std::string_view wanted) const {
  return is_symbol(id) && name(id) == wanted;
}

bool LispData::is_nil(DatumId id) const {
  return is_list(id) ? data_[id].count == 0 : is_symbol(id, "nil");
}

std::optional<std::string_view> LispData::head(DatumId id) const {
  const auto items = children(id);
  if (items.empty() || !is_symbol(items.front())) return std::nullopt;
  return name(items.front());
}

bool equal_data(const LispData& a, DatumId left, const LispData& b, DatumId right) {
  std::vector<std::pair<DatumId, DatumId>> open = {{left, right}};
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    if (!equal_shallow(a, x, b, y)) return false;
    const auto xs = a.children(x);
    const auto ys = b.children(y);
    for (std::size_t i = 0; i < xs.size(); ++i) open.emplace_back(xs[i], ys[i]);
  }
  return true;
}

std::string print_datum(const LispData& data, DatumId id) {
  std::string out;
  std::vector<std::pair<DatumId, std::size_t>> open;  // a list and its next child
  const auto begin = [&](DatumId datum) {
    if (!data.is_list(datum)) return print_atom(data, datum, out);
    out += '(';
    open.emplace_back(datum, 0);
  };
  begin(id);
  while (!open.empty()) {
    const auto items = data.children(open.back().first);
    const auto next = open.back().second++;
    if (next == items.size()) {
      out += ')';
      open.pop_back();
      continue;
    }
    if (next != 0) out += ' ';
    if (data.is_dotted(open.back().first) && next + 1 == items.size()) out += ". ";
    begin(items[next]);
  }
  return out;
}

}  // namespace parallax::compiler
