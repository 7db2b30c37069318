#include "compiler/artifact/symbol_reader.h"

#include <fmt/format.h>

#include "compiler/artifact/derived.h"
#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

// "Times" of what is unique in the whole model.
constexpr Timepoint kEveryTime = -1;
constexpr Timepoint kNoTime = -2;

}  // namespace

bool SymbolReader::unique(AtomKind kind, Timepoint time, const std::string& name, bool declared) {
  const auto key = fmt::format("{} {} {} {}", declared, static_cast<int>(kind), time, name);
  if (names_.insert(key).second) return true;
  return cursor_.fail(DiagnosticCode::kArtifactTwice,
                      fmt::format("{} `{}`", to_string(kind), name));
}

bool SymbolReader::claim_slot(std::int64_t slot, AtomKind kind, const std::string& name) {
  const auto index = static_cast<std::size_t>(slot);
  slot_taken_.resize(model_.slots.size(), false);
  if (slot_taken_[index]) {
    return cursor_.fail(DiagnosticCode::kArtifactTwice, fmt::format("slot {}", slot));
  }
  slot_taken_[index] = true;
  model_.slots[index] = {kind, name};
  return is_nameless(kind) || unique(kind, kEveryTime, name, false);
}

/// `NAME SLOT` or `NAME never`; slots from `lower` up to and without `upper`.
bool SymbolReader::read_ground_name(std::string_view what, AtomKind kind, std::int64_t lower,
                                    std::int64_t upper, GroundName& name) {
  if (!cursor_.word(what, name.name) || !unique(kind, kNoTime, name.name, true)) return false;
  const auto text = cursor_.raw_word();
  if (text == "never") return true;
  std::int64_t slot = 0;
  if (!cursor_.parse_number(text, "a slot", lower, upper - 1, slot)) return false;
  name.slot = static_cast<std::uint32_t>(slot);
  return claim_slot(slot, kind, name.name);
}

bool SymbolReader::read_fluent() {
  GroundName fluent;
  std::optional<std::uint32_t> released;
  if (!read_ground_name("the name of a fluent", AtomKind::kHoldsAt, 0, model_.state_slots,
                        fluent)) {
    return false;
  }
  if (!cursor_.at_line_end()) {
    if (cursor_.raw_word() != "released") return cursor_.expected("`released`");
    std::int64_t slot = 0;
    if (!cursor_.number("a slot", 0, std::int64_t{model_.state_slots} - 1, slot) ||
        !claim_slot(slot, AtomKind::kReleasedAt, fluent.name)) {
      return false;
    }
    released = static_cast<std::uint32_t>(slot);
  }
  model_.fluents.push_back(std::move(fluent));
  model_.release_slots.push_back(released);
  return cursor_.end_of_line();
}

bool SymbolReader::read_event() {
  GroundName event;
  if (!read_ground_name("the name of an event", AtomKind::kHappens, model_.state_slots,
                        model_.stride(), event)) {
    return false;
  }
  model_.events.push_back(std::move(event));
  return cursor_.end_of_line();
}

bool SymbolReader::read_kind(AtomKind& kind) {
  const auto known = atom_kind(cursor_.raw_word());
  if (!known) return cursor_.expected("the kind of an atom");
  kind = *known;
  return true;
}

bool SymbolReader::read_slot() {
  std::int64_t slot = 0;
  auto kind = AtomKind::kUnused;
  std::string name;
  return cursor_.number("a slot", 0, std::int64_t{model_.stride()} - 1, slot) && read_kind(kind) &&
         cursor_.word("a name", name) && claim_slot(slot, kind, name) && cursor_.end_of_line();
}

bool SymbolReader::read_atom() {
  std::int64_t v = 0, time = 0;
  Atom atom;
  if (!cursor_.number("a variable", 1, model_.base(), v)) return false;
  const auto index = static_cast<std::size_t>(v) - 1;
  fixed_taken_.resize(model_.fixed.size(), false);
  if (fixed_taken_[index]) {
    return cursor_.fail(DiagnosticCode::kArtifactTwice, fmt::format("variable {}", v));
  }
  fixed_taken_[index] = true;
  std::string name;
  if (!read_kind(atom.kind) || !cursor_.word("a name", name)) return false;
  if (!cursor_.at_line_end()) {
    const auto last = model_.horizon - (atom.kind == AtomKind::kHappens ? 1 : 0);
    if (!cursor_.number("a timepoint", 0, last, time)) return false;
    atom.time = static_cast<Timepoint>(time);
  }
  const bool timeless = atom.kind == AtomKind::kHoldsAt || atom.kind == AtomKind::kHappens ||
                        atom.kind == AtomKind::kReleasedAt;
  if (timeless && !atom.time) return cursor_.expected("a timepoint");
  if (!is_nameless(atom.kind) && !unique(atom.kind, atom.time.value_or(kNoTime), name, false)) {
    return false;
  }
  if (is_of_plan(atom.kind)) {
    atom.plan = plan_atom(atom.kind, name);
  } else {
    atom.name = std::move(name);
  }
  model_.fixed[index] = std::move(atom);
  return cursor_.end_of_line();
}

void SymbolReader::name_the_rest() {
  const auto occurring = occurrences(model_);
  slot_taken_.resize(model_.slots.size(), false);
  fixed_taken_.resize(model_.fixed.size(), false);
  for (std::size_t i = 0; i < model_.slots.size(); ++i) {
    if (!slot_taken_[i] && occurring.slots[i]) model_.slots[i].kind = AtomKind::kAuxiliary;
  }
  for (std::size_t i = 0; i < model_.fixed.size(); ++i) {
    if (!fixed_taken_[i] && occurring.fixed[i]) model_.fixed[i].kind = AtomKind::kAuxiliary;
  }
}

bool SymbolReader::check_hits() {
  if (!model_.has_constraints) return true;
  const AtomIndex index(model_);
  for (Timepoint t = 1; t <= model_.horizon; ++t) {
    if (index.hit(t)) continue;
    return cursor_.fail(DiagnosticCode::kArtifactMissing,
                        fmt::format("c dec atom VARIABLE Hit hit {}", t));
  }
  return true;
}

}  // namespace parallax::compiler
