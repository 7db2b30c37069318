#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// A variable regardless of its timepoint: the fixed ones first, then the slots.
using ModelNode = std::uint32_t;

inline ModelNode node_of(const compiler::CompiledModel& model, std::int32_t variable) {
  const auto place = variable - 1 - model.base();
  return static_cast<ModelNode>(place < 0 ? variable - 1 : model.base() + place % model.stride());
}

/// The variable that a node has at a timepoint; fixed ones are the same at each.
inline std::int32_t variable_at(const compiler::CompiledModel& model, ModelNode node,
                                compiler::Timepoint t) {
  const auto variable = static_cast<std::int32_t>(node) + 1;
  return variable <= model.base() ? variable : variable + t * model.stride();
}

/// A place of a constant as an argument in a printed name, at any depth: bytes of the name.
struct ConstantPlace {
  std::uint32_t begin = 0;
  std::uint32_t size = 0;
  std::uint32_t constant = 0;
};

/// The constants among the arguments of a model's atoms, numbered in the order in which the atoms
/// mention them first: fluents, events, fixed atoms. Numbers are no constants here.
class NamedAtoms {
 public:
  struct Node {
    std::string name;  // with kind and time, which tell atoms of one text apart
    std::vector<ConstantPlace> places;
  };

  explicit NamedAtoms(const compiler::CompiledModel& model);

  const std::vector<std::string>& constants() const { return constants_; }
  /// The text of a node; a node without a name has none.
  const Node& node(ModelNode node) const { return nodes_[node]; }
  std::size_t node_count() const { return nodes_.size(); }
  /// Nodes that mention the constant, each once.
  const std::vector<ModelNode>& mentions(std::uint32_t constant) const {
    return mentions_[constant];
  }
  /// The node whose name is that of `node` with every constant replaced by its image; none if the
  /// model has no such node.
  std::optional<ModelNode> image(ModelNode node, std::span<const std::uint32_t> images) const;

 private:
  void add(ModelNode node, std::string prefix, std::string_view name);
  void add_place(Node& entry, ModelNode node, std::size_t begin, std::size_t end);

  std::vector<std::string> constants_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::vector<Node> nodes_;
  std::vector<std::vector<ModelNode>> mentions_;
  std::unordered_map<std::string, ModelNode> by_name_;
};

/// Calls `visit(begin, end)` for every argument of a printed name that has no arguments itself and
/// does not begin as a number does.
template <typename Visit>
void for_each_constant(std::string_view name, const Visit& visit) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (c != '(' && c != ')' && c != ',') continue;
    const bool is_argument = c != '(' && i > begin;
    const char first = begin < name.size() ? name[begin] : '0';
    if (is_argument && first != '-' && (first < '0' || first > '9')) visit(begin, i);
    begin = i + 1;
  }
}

}  // namespace parallax::runtime
