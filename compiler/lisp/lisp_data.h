#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/id.h"
#include "compiler/base/source_file.h"
#include "compiler/lisp/number.h"

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
  bool dotted = false;       // lists: the last child is the tail
  bool external = false;     // symbols: written with one colon, so it must be exported
  NameId name;               // symbols, keywords (without colon), strings, characters
  NameId package;            // symbols: the prefix as written; empty without one
  NameId key;                // symbols: the function or global that it may mean (resolve_packages)
  std::uint32_t number = 0;  // numbers: index
  std::uint32_t count = 0;   // lists: of their children
  const DatumId* children = nullptr;
  base::SourceRange source;
};

/// Arena of data; ids, children and names stay valid as it grows: macros add data while a plan is
/// compiled.
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
  /// Number of data, or of places in lists if there are more: (a . (b c)) copies what it folds.
  std::size_t size() const { return std::max(data_.size(), places_); }
  /// The elements of a list; empty for anything else.
  std::span<const DatumId> children(DatumId id) const;
  const std::string& name(DatumId id) const { return names_[data_[id].name.index()]; }
  const std::string& package(DatumId id) const { return names_[data_[id].package.index()]; }
  /// Key by which the plan's functions and globals are found; the name unless packages say
  /// otherwise.
  const std::string& key(DatumId id) const { return names_[data_[id].key.index()]; }
  void set_key(DatumId id, std::string_view key) { data_[id].key = intern(key); }
  bool knows_name(std::string_view name) const { return name_ids_.contains(name); }
  const Number& number(DatumId id) const { return numbers_[data_[id].number]; }
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

  /// Marks the data added from `begin` on as the expansion of the macro call `call`.
  void note_expansion(DatumId begin, DatumId call);
  /// The call of the macro that made this datum, if one did.
  std::optional<DatumId> macro_call(DatumId id) const;
  /// Marks the data added from `begin` on as our own Lisp: errors in it are those of its caller.
  void note_library(DatumId begin) { library_ = {begin, end_id(), begin}; }
  bool in_library(DatumId id) const { return library_.begin <= id && id < library_.end; }
  DatumId end_id() const { return data_.id_at(data_.size()); }

 private:
  /// Data [begin, end), in the order of begin.
  struct Part {
    DatumId begin;
    DatumId end;
    DatumId call;
  };
  NameId intern(std::string_view text);
  const DatumId* keep(std::span<const DatumId> children);
  base::Store<DatumId, Datum> data_;
  std::vector<std::unique_ptr<DatumId[]>> blocks_;  // children, a list's side by side
  std::size_t block_used_ = 0;
  std::size_t block_size_ = 0;
  std::size_t places_ = 0;
  std::vector<Part> expansions_;
  Part library_;
  std::vector<Number> numbers_;
  std::deque<std::string> names_;
  std::map<std::string, NameId, std::less<>> name_ids_;
};

/// Same structure, names and packages; places do not matter.
bool equal_data(const LispData& a, DatumId left, const LispData& b, DatumId right);

/// Text on one line that reads back as an equal datum.
std::string print_datum(const LispData& data, DatumId id);

}  // namespace parallax::compiler
