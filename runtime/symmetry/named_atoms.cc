#include "runtime/symmetry/named_atoms.h"

#include <variant>

namespace parallax::runtime {

using compiler::CompiledModel;

namespace {

/// The object that an atom of the plan speaks of, as the last argument of a text.
std::string text_of_plan(compiler::AtomKind kind, const compiler::PlanAtom& plan) {
  if (const auto* returned = std::get_if<compiler::ReturnedObject>(&plan)) {
    return "(" + returned->object + ")";
  }
  if (const auto* value = std::get_if<compiler::RegisterValue>(&plan)) {
    return value->name + "(" + value->object + ")";
  }
  return compiler::to_string(kind, plan);
}

std::string prefix_of(compiler::AtomKind kind, std::optional<compiler::Timepoint> time) {
  std::string out(compiler::to_string(kind));
  if (time) out += '@' + std::to_string(*time);
  return out + ' ';
}

}  // namespace

NamedAtoms::NamedAtoms(const CompiledModel& model)
    : nodes_(model.fixed.size() + model.slots.size()) {
  const auto base = static_cast<ModelNode>(model.base());
  const auto add_slot = [&](std::uint32_t slot) {
    const auto& [kind, name] = model.slots[slot];
    if (!compiler::is_nameless(kind)) add(base + slot, prefix_of(kind, std::nullopt), name);
  };
  // Constants are met in the order of declaration, not of slots.
  for (const auto& fluent : model.fluents) {
    if (fluent.slot) add_slot(*fluent.slot);
  }
  for (const auto& event : model.events) {
    if (event.slot) add_slot(*event.slot);
  }
  for (std::uint32_t slot = 0; slot < model.slots.size(); ++slot) {
    if (nodes_[base + slot].name.empty()) add_slot(slot);
  }
  for (std::size_t i = 0; i < model.fixed.size(); ++i) {
    const auto& atom = model.fixed[i];
    if (compiler::is_nameless(atom.kind)) continue;
    const auto name =
        compiler::is_of_plan(atom.kind) ? text_of_plan(atom.kind, atom.plan) : atom.name;
    add(static_cast<ModelNode>(i), prefix_of(atom.kind, atom.time), name);
  }
}

void NamedAtoms::add(ModelNode node, std::string prefix, std::string_view name) {
  auto& entry = nodes_[node];
  const auto skip = prefix.size();
  entry.name = std::move(prefix);
  entry.name += name;
  for_each_constant(name, [&](std::size_t begin, std::size_t end) {
    add_place(entry, node, skip + begin, skip + end);
  });
  by_name_.emplace(entry.name, node);
}

void NamedAtoms::add_place(Node& entry, ModelNode node, std::size_t begin, std::size_t end) {
  auto text = entry.name.substr(begin, end - begin);
  const auto [found, is_new] =
      numbers_.emplace(text, static_cast<std::uint32_t>(constants_.size()));
  if (is_new) {
    constants_.push_back(std::move(text));
    mentions_.emplace_back();
  }
  auto& mentions = mentions_[found->second];
  if (mentions.empty() || mentions.back() != node) mentions.push_back(node);
  entry.places.push_back(
      {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin), found->second});
}

std::optional<ModelNode> NamedAtoms::image(ModelNode node,
                                           std::span<const std::uint32_t> images) const {
  const auto& entry = nodes_[node];
  std::string name;
  std::size_t copied = 0;
  for (const auto& place : entry.places) {
    if (images[place.constant] == place.constant) continue;
    name.append(entry.name, copied, place.begin - copied);
    name += constants_[images[place.constant]];
    copied = place.begin + place.size;
  }
  if (copied == 0) return node;
  name.append(entry.name, copied, std::string::npos);
  const auto found = by_name_.find(name);
  if (found == by_name_.end()) return std::nullopt;
  return found->second;
}

}  // namespace parallax::runtime
