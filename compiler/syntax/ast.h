#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/base/id.h"
#include "compiler/base/source_file.h"
#include "compiler/base/word_table.h"

namespace parallax::compiler {

struct NodeTag {
  static constexpr bool kOrdered = true;  // children before parents, in source order
};
using NodeId = base::Id<NodeTag>;

/// Formulas and terms share one kind of tree, as they share one nonterminal; telling them apart is
/// the checker's work.
enum class NodeKind : std::uint8_t {
  kName,    // variable or constant; no children
  kNumber,  // digits, perhaps with a decimal part; no children
  kApply,   // NAME(...); the arguments
  kUnary,   // one child
  kBinary,  // two children; any number from two on for `&` and `|`
  kForall,  // the variables (kName), then the body
  kExists,  // the same
  kCount,   // `count{x: F}`: the same
  kSum,     // `sum{x: W: F}`: the variables, the weight, the body
};
constexpr bool is_quantifier(NodeKind kind) {
  return kind == NodeKind::kForall || kind == NodeKind::kExists;
}
constexpr bool is_aggregate(NodeKind kind) {
  return kind == NodeKind::kCount || kind == NodeKind::kSum;
}

enum class Operator : std::uint8_t {
  kImplies,
  kIff,
  kOr,
  kAnd,
  kEqual,
  kNotEqual,
  kLess,
  kLessEqual,
  kGreaterEqual,
  kGreater,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kModulo,
  kNot,     // unary
  kNegate,  // unary -
  kPlus,    // unary +
  // Operators of properties and state constraints; all but the last two are unary.
  kAlways,
  kEventually,
  kNext,
  kWeakNext,
  kHistorically,
  kOnce,
  kPreviously,
  kUntil,
  kSince,
};

constexpr bool is_comparison(Operator op) {
  return op >= Operator::kEqual && op <= Operator::kGreater;
}
constexpr bool is_temporal(Operator op) { return op >= Operator::kAlways; }
constexpr bool is_binary_temporal(Operator op) { return op >= Operator::kUntil; }
/// The temporal operator with this name: `always`.
std::optional<Operator> temporal_operator(std::string_view word);

/// The spelling in the source, such as "<->".
inline constexpr auto kOperatorSigns =
    base::word_table<Operator>("->", "<->", "|", "&", "=", "!=", "<", "<=", ">=", ">", "+", "-",
                               "*", "/", "^", "%", "!", "-", "+", "always", "eventually", "next",
                               "weak_next", "historically", "once", "previously", "until", "since");
constexpr std::string_view spelling(Operator op) { return kOperatorSigns.of(op); }

/// A piece of one file's text; empty means "not there".
struct Word {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  bool empty() const { return begin == end; }
  friend bool operator==(const Word&, const Word&) = default;
};

/// 24 bytes, because a file of 64 MB may hold tens of millions.
struct Node {
  NodeKind kind = NodeKind::kName;
  Operator op = Operator::kAnd;  // kUnary, kBinary
  std::uint32_t begin = 0;       // byte range in the file
  std::uint32_t end = 0;
  std::uint32_t name_length = 0;  // of the name at `begin`, where the kind has one
  std::uint32_t first_child = 0;
  std::uint32_t child_count = 0;

  /// How many of the first children are variables that the node binds.
  std::uint32_t bound_count() const {
    if (kind == NodeKind::kSum) return child_count - 2;
    return is_quantifier(kind) || kind == NodeKind::kCount ? child_count - 1 : 0;
  }
};

enum class StatementKind : std::uint8_t {
  kOption,         // option NAME VALUE            name, value
  kRange,          // range SORT MIN MAX           sort, Ast::bounds
  kSort,           // sort a, b: c                 items, each with an optional parent
  kReifiedSort,    // reified sort a: b            the same
  kConstants,      // SORT[!] C1, C2               sort, additional, items
  kConstructor,    // SORT Name(s1,s2): r          sort, name, items (argument sorts), value (r)
  kXor,            // xor A, B                     items
  kMutex,          // mutex A, B                   items
  kNoninertial,    // noninertial F, G             items
  kManualRelease,  // manualrelease F, G           items
  kIgnore,         // ignore N1, N2                items
  kCompletion,     // completion [LABEL] P         label, name
  kLoad,           // load PATH                    value
  kMinimize,       // minimize OBJECTIVE           value
  kFormula,        // [LABEL:] formula.            label, formula, first_node
};

struct Item {
  Word name;
  Word parent;  // kSort, kReifiedSort
};

struct SortBounds {
  std::int64_t lower = 0;
  std::int64_t upper = 0;
};

/// One statement or formula; which fields are set stands beside the kind. Items are
/// [first_item, first_item + item_count) of the Ast.
struct Statement {
  StatementKind kind = StatementKind::kFormula;
  bool additional = false;  // `SORT! C`
  Word source;              // the whole statement without blanks around it
  Word sort, name, value, label;
  std::uint32_t first_item = 0;
  std::uint32_t item_count = 0;
  NodeId formula;     // root
  NodeId first_node;  // the nodes of the formula are first_node ... formula, in this order
};

/// One parsed text. Nodes live in an arena (no destructor walks a tree), names are views into the
/// SourceFile, which must outlive the Ast.
class Ast {
 public:
  Ast(base::FileId file, std::string_view text) : file_(file), text_(text) {}

  base::FileId file() const { return file_; }
  const std::vector<Statement>& statements() const { return statements_; }
  const Item* items(const Statement& statement) const {
    return items_.data() + statement.first_item;
  }

  /// Bounds of a kRange statement.
  const SortBounds& bounds(const Statement& statement) const {
    return bounds_[statement.first_item];
  }

  const Node& operator[](NodeId id) const {
    return chunks_[id.index() >> kChunkBits][id.index() & (kChunkSize - 1)];
  }
  std::size_t node_count() const { return node_count_; }
  NodeId child(const Node& node, std::uint32_t position) const {
    return children_[node.first_child + position];
  }
  /// The name of kName and kApply, the digits of kNumber, the word of an aggregate.
  std::string_view name(const Node& node) const {
    return text_.substr(node.begin, node.name_length);
  }
  base::SourceRange source(const Node& node) const { return {file_, node.begin, node.end}; }
  base::SourceRange name_source(const Node& node) const {
    return {file_, node.begin, node.begin + node.name_length};
  }
  std::string_view text(const Word& word) const {
    return text_.substr(word.begin, word.end - word.begin);
  }
  base::SourceRange source(const Word& word) const { return {file_, word.begin, word.end}; }

  /// For parsers and generators. Children must have been added before.
  NodeId add(Node node);
  NodeId add(Node node, const NodeId* children, std::size_t count);
  /// The same with the children given one by one: `child(i)`.
  template <typename Child>
  NodeId add_with(Node node, std::size_t count, const Child& child) {
    node.first_child = static_cast<std::uint32_t>(children_.size());
    node.child_count = static_cast<std::uint32_t>(count);
    // A node with millions of children must not double its memory.
    if (count > children_.size()) children_.reserve(children_.size() + count);
    for (std::size_t i = 0; i < count; ++i) children_.push_back(child(i));
    return add(node);
  }
  void add(const Statement& statement) { statements_.push_back(statement); }
  std::uint32_t add_item(const Item& item);
  std::uint32_t add_bounds(const SortBounds& bounds);

 private:
  static constexpr std::uint32_t kChunkBits = 14;
  static constexpr std::uint32_t kChunkSize = 1U << kChunkBits;

  base::FileId file_;
  std::string_view text_;  // of the SourceFile `file_`
  std::vector<Statement> statements_;
  std::vector<Item> items_;
  std::vector<SortBounds> bounds_;
  std::vector<std::unique_ptr<Node[]>> chunks_;  // no copy while growing
  std::vector<NodeId> children_;
  std::size_t node_count_ = 0;
};

/// True if the two trees have the same shape, operators and names, wherever they stand.
bool same_tree(const Ast& a, NodeId a_root, const Ast& b, NodeId b_root);

}  // namespace parallax::compiler
