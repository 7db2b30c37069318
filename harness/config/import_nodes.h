#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "harness/config/keys.h"
#include "harness/config/yaml_reader.h"
#include "harness/import/import.h"

namespace parallax::harness {

inline YamlNode node_at(YamlNode::Kind kind, const base::SourceRange& range,
                        std::string text = {}) {
  return {kind, range, std::move(text), false, {}, {}};
}

/// A map under way.
class MapNode {
 public:
  explicit MapNode(const base::SourceRange& range) : node_(node_at(YamlNode::Kind::kMap, range)) {}

  void put(std::string_view key, YamlNode value) { put_at(key, node_.range, std::move(value)); }
  void put_at(std::string_view key, const base::SourceRange& range, YamlNode value) {
    node_.entries.push_back({std::string(key), range, std::move(value)});
  }
  void text(std::string_view key, const std::string& value) {
    if (value.empty()) return;
    auto node = node_at(YamlNode::Kind::kScalar, node_.range, value);
    node.quoted = true;
    put(key, std::move(node));
  }
  void word(std::string_view key, std::string_view value) {
    put(key, node_at(YamlNode::Kind::kScalar, node_.range, std::string(value)));
  }
  void number(std::string_view key, double value) { put(key, scalar(value)); }
  void number_unless_zero(std::string_view key, double value) {
    if (value != 0.0) number(key, value);
  }
  void numbers(std::string_view key, std::initializer_list<double> values) {
    auto list = node_at(YamlNode::Kind::kList, node_.range);
    for (const double value : values) list.items.push_back(scalar(value));
    put(key, std::move(list));
  }
  void vector(std::string_view key, const Eigen::Vector3d& v) {
    numbers(key, {v.x(), v.y(), v.z()});
  }
  /// Nothing in the place of one that is not there.
  void stops(std::string_view key, const std::optional<double>& low,
             const std::optional<double>& high) {
    if (!low && !high) return;
    auto list = node_at(YamlNode::Kind::kList, node_.range);
    for (const auto& stop : {low, high}) {
      list.items.push_back(stop ? scalar(*stop) : node_at(YamlNode::Kind::kNull, node_.range));
    }
    put(key, std::move(list));
  }
  YamlNode take() { return std::move(node_); }

 private:
  YamlNode scalar(double value) const {
    return node_at(YamlNode::Kind::kScalar, node_.range, fmt::format("{}", value));
  }
  YamlNode node_;
};

/// An imported body or joint as the tree that a scenario would have for it.
YamlNode body_node(const ImportedBody& made, const base::SourceRange& range);
YamlNode joint_node(const JointSpec& joint, const base::SourceRange& range);

}  // namespace parallax::harness
