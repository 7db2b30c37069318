#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/id.h"
#include "compiler/base/source_file.h"
#include "compiler/plan/number.h"

namespace parallax::compiler {

struct DatumTag {
  static constexpr bool kOrdered = true;  // order of completion while reading
};
struct NameTag {};
using DatumId = base::Id<DatumTag>;
using NameId = base::Id<NameTag>;  // an interned spelling

enum class DatumKind : std::uint8_t { kSymbol, kKeyword, kNumber, kString, kCharacter, kList };

/// One datum with its place. 'x is the list (quote x), `x (quasiquote x), ,x (unquote x),
/// ,@x (unquote-splicing x), #'f (function f). () is an empty list, nil a symbol. (a b . c) is a
/// dotted list of three children, the last of which is the tail: no list, nil or a list in the
/// place of a tail are folded into the list around it, but for a comma form.
struct Datum {
  DatumKind kind = DatumKind::kList;
  bool dotted = false;      // lists: the last child is the tail
  bool external = false;    // symbols: written with one colon, so it must be exported
  NameId name;              // symbols, keywords (without colon), strings, characters
  NameId package;           // symbols: the prefix as written; empty without one
  NameId key;               // symbols: the function or global that it may mean (resolve_packages)
  std::uint32_t first = 0;  // lists: children [first, first + count); numbers: index
  std::uint32_t count = 0;
  base::SourceRange source;
};

/// Arena of data; ids stay valid as it grows.
class LispData {
 public:
  LispData();
  DatumId add_named(DatumKind kind, std::string_view name, std::string_view package,
                    base::SourceRange source, bool external = false);
  DatumId add_number(const Number& number, base::SourceRange source);
  DatumId add_list(std::span<const DatumId> children, base::SourceRange source);
  /// The list of `children` that ends in `tail`.
  DatumId add_dotted(std::vector<DatumId> children, DatumId tail, base::SourceRange source);

  const Datum& operator[](DatumId id) const { return data_[id]; }
  /// Data, or places in lists if those are more: (a . (b c)) copies what it folds.
  std::size_t size() const { return std::max(data_.size(), children_.size()); }
  /// The elements of a list; empty for anything else. Valid until the next add_list.
  std::span<const DatumId> children(DatumId id) const;
  const std::string& name(DatumId id) const { return names_[data_[id].name.index()]; }
  const std::string& package(DatumId id) const { return names_[data_[id].package.index()]; }
  /// What the plan's functions and globals are found by; the name unless packages say otherwise.
  const std::string& key(DatumId id) const { return names_[data_[id].key.index()]; }
  void set_key(DatumId id, std::string_view key) { data_[id].key = intern(key); }
  const Number& number(DatumId id) const { return numbers_[data_[id].first]; }
  const base::SourceRange& source(DatumId id) const { return data_[id].source; }

  bool is_list(DatumId id) const { return data_[id].kind == DatumKind::kList; }
  bool is_dotted(DatumId id) const { return data_[id].dotted; }
  bool is_symbol(DatumId id) const { return data_[id].kind == DatumKind::kSymbol; }
  bool is_symbol(DatumId id, std::string_view name) const;
  bool is_keyword(DatumId id) const { return data_[id].kind == DatumKind::kKeyword; }
  bool is_string(DatumId id) const { return data_[id].kind == DatumKind::kString; }
  bool is_number(DatumId id) const { return data_[id].kind == DatumKind::kNumber; }
  /// The empty list and the symbol nil are the same thing.
  bool is_nil(DatumId id) const;
  /// The symbol at the head of a non-empty list.
  std::optional<std::string_view> head(DatumId id) const;

 private:
  NameId intern(std::string_view text);
  base::Store<DatumId, Datum> data_;
  std::vector<DatumId> children_;
  std::vector<Number> numbers_;
  std::vector<std::string> names_;
  std::map<std::string, NameId, std::less<>> name_ids_;
};

/// Same structure, names and packages; places do not matter.
bool equal_data(const LispData& a, DatumId left, const LispData& b, DatumId right);

/// Text on one line that reads back as an equal datum.
std::string print_datum(const LispData& data, DatumId id);

}  // namespace parallax::compiler
