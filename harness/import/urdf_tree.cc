#include "harness/import/urdf_tree.h"

#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <set>

namespace parallax::harness {
namespace {

struct Edge {
  std::optional<std::string_view> parent, child;
  std::size_t offset = 0;
};

std::string_view short_name(std::string_view name) { return name.substr(0, 80); }

/// The links that joints name, by the joint's number; or what is wrong with one of them.
std::optional<TextFault> read_edges(const XmlOutline& outline, std::map<std::size_t, Edge>& edges) {
  for (const XmlElement& element : outline.elements) {
    if (!element.parent || (element.tag != "parent" && element.tag != "child")) continue;
    const XmlElement& joint = outline.elements[*element.parent];
    const bool top = joint.parent && !outline.elements[*joint.parent].parent;
    if (!top || joint.tag != "joint") continue;
    // The same name can be written in many ways with these, and would be another one here.
    if (element.link.find('&') != element.link.npos) {
      return TextFault{element.offset, "the name of a link holds a `&`"};
    }
    Edge& edge = edges[*element.parent];
    edge.offset = joint.offset;
    auto& end = element.tag == "parent" ? edge.parent : edge.child;
    if (end) {
      return TextFault{element.offset, fmt::format("the joint `{}` has two elements <{}>",
                                                   short_name(joint.name), element.tag)};
    }
    end = element.link;
  }
  return std::nullopt;
}

}  // namespace

std::optional<TextFault> tree_fault(const XmlOutline& outline) {
  std::map<std::size_t, Edge> edges;
  if (auto fault = read_edges(outline, edges)) return fault;
  struct Above {
    std::string_view parent;
    std::size_t offset = 0;
  };
  std::map<std::string_view, Above> above;  // by child
  for (const auto& [number, edge] : edges) {
    if (!edge.parent || !edge.child) continue;  // said by the library
    if (!above.emplace(*edge.child, Above{*edge.parent, edge.offset}).second) {
      return TextFault{edge.offset,
                       fmt::format("the link `{}` hangs on two joints", short_name(*edge.child))};
    }
  }
  std::set<std::string_view> done;  // no circle on the way up from here
  for (const auto& [child, unused] : above) {
    std::set<std::string_view> path;
    std::string_view link = child;
    while (!done.contains(link)) {
      const auto joint = above.find(link);
      if (joint == above.end()) break;
      if (!path.insert(link).second) {
        return TextFault{
            joint->second.offset,
            fmt::format("the link `{}` hangs on itself, in a circle of joints", short_name(link))};
      }
      link = joint->second.parent;
    }
    done.merge(path);
  }
  return std::nullopt;
}

}  // namespace parallax::harness
