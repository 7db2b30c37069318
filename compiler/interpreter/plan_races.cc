// Variables, globals, cells and links of designators that units may read and write, by their code
// and that of all that they may call. Where a function value is called nobody can tell which: any
// that the plan makes counts. Cells of one kind are taken for one, so an answer may name what never
// meets, but misses nothing.
#include "compiler/interpreter/plan_races.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>
#include <tuple>
#include <vector>

#include "compiler/builtins/plan_builtins.h"

namespace parallax::compiler {
namespace {

enum class Shared : std::uint8_t { kVariable, kGlobal, kCells, kLinks };
using Thing = std::tuple<Shared, std::uint32_t, std::uint32_t>;

/// A built-in that reads or writes cells of one kind.
struct CellUse {
  std::string_view name;
  std::uint32_t kind = 0;
  bool writes = false;
};
constexpr CellUse kCellUses[] = {{"%set-value", 0, true},
                                 {"value", 0},
                                 {"peek-value", 0},
                                 {"%set-hash", 1, true},
                                 {"remhash", 1, true},
                                 {"clrhash", 1, true},
                                 {"gethash", 1},
                                 {"hash-table-count", 1},
                                 {"hash-table-keys", 1},
                                 {"hash-table-values", 1},
                                 {"hash-table-alist", 1},
                                 {"%set-aref", 2, true},
                                 {"aref", 2},
                                 {"svref", 2},
                                 {"%elements", 2},
                                 {"coerce", 2},
                                 {"%set-slot", 3, true},
                                 {"%typed-slot", 3},
                                 {"slot-value", 3},
                                 {"copy-structure", 3}};

/// Built-ins that look at which designators have been equated; `equate` and its like change that.
constexpr std::string_view kLinkReaders[] = {"current-desig", "newest-effective-designator",
                                             "first-desig", "desig-equal", "reference"};

struct Uses {
  std::set<Thing> read, written;
};

class RaceFinder {
 public:
  RaceFinder(PlanCode& code, bool ruled) : code_(code), ruled_(ruled) {}

  void find() {
    std::vector<CodeGap> gaps;
    for (std::uint32_t unit = 0; unit < code_.units.size(); ++unit) {
      for (const auto& instruction : code_.units[unit].code) {
        if (instruction.op == PlanOp::kPar && races(code_.pars[instruction.a])) {
          gaps.push_back({"when branches change what others use", instruction.source});
        } else if (walks_array(instruction) && uses_of(unit).written.contains(arrays())) {
          gaps.push_back({"changes of an array behind a loop across it", instruction.source,
                          GapKind::kMeaning});
        }
      }
    }
    code_.gaps.insert(code_.gaps.end(), gaps.begin(), gaps.end());
  }

 private:
  static Thing arrays() { return {Shared::kCells, 2, 0}; }

  static bool walks_array(const PlanInstruction& instruction) {
    return instruction.op == PlanOp::kBuiltin && plan_builtins()[instruction.a].name == "%elements";
  }

  bool races(const ParBranches& par) const {
    std::vector<Uses> all;
    for (const auto unit : par.units) all.push_back(uses_of(unit));
    const auto around = around_of(par.units.front());
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (i == k) continue;
        for (const auto& thing : all[i].written) {
          const auto& [kind, unit, place] = thing;
          if (kind == Shared::kVariable && !around.contains(unit)) continue;  // each has its own
          if (all[k].read.contains(thing) || all[k].written.contains(thing)) return true;
        }
      }
    }
    return false;
  }

  std::set<std::uint32_t> around_of(std::uint32_t unit) const {
    std::set<std::uint32_t> out;
    for (auto at = code_.units[unit].around; at; at = code_.units[*at].around) out.insert(*at);
    return out;
  }

  /// The variable b of the frame a links out.
  Thing variable(std::uint32_t unit, const PlanInstruction& instruction) const {
    for (auto level = instruction.a; level > 0 && code_.units[unit].around; --level) {
      unit = *code_.units[unit].around;
    }
    return {Shared::kVariable, unit, instruction.b};
  }

  Uses uses_of(std::uint32_t first) const {
    Uses out;
    std::set<std::uint32_t> known = {first};
    std::vector<std::uint32_t> open = {first};
    const auto calls = [&](std::uint32_t unit) {
      if (known.insert(unit).second) open.push_back(unit);
    };
    while (!open.empty()) {
      const auto unit = open.back();
      open.pop_back();
      for (const auto& instruction : code_.units[unit].code) {
        note(unit, instruction, out);
        note_calls(instruction, calls);
      }
    }
    return out;
  }

  void note(std::uint32_t unit, const PlanInstruction& instruction, Uses& out) const {
    const auto op = instruction.op;
    const auto a = instruction.a;
    if (op == PlanOp::kLoad) out.read.insert(variable(unit, instruction));
    if (op == PlanOp::kStore) out.written.insert(variable(unit, instruction));
    if (op == PlanOp::kLoadGlobal) out.read.insert({Shared::kGlobal, a, 0});
    if (op == PlanOp::kStoreSpecial) out.written.insert({Shared::kGlobal, a, 0});
    if (op == PlanOp::kBuiltin) note_cells(plan_builtins()[a].name, out);
    if (code_.identities) note_links(instruction, out);
  }

  /// A perform is about the designators that are current.
  void note_links(const PlanInstruction& instruction, Uses& out) const {
    const Thing links = {Shared::kLinks, 0, 0};
    if (instruction.op == PlanOp::kPerform) {
      out.read.insert(links);
      if (ruled_) out.written.insert(links);
    }
    if (instruction.op != PlanOp::kBuiltin) return;
    const auto name = plan_builtins()[instruction.a].name;
    const bool child = name == "make-designator" && instruction.b == 3;
    if (name == "equate" || name == "next-solution" || child) out.written.insert(links);
    const auto reads = std::find(std::begin(kLinkReaders), std::end(kLinkReaders), name);
    if (reads != std::end(kLinkReaders)) out.read.insert(links);
  }

  static void note_cells(std::string_view builtin, Uses& out) {
    const auto* use = std::find_if(std::begin(kCellUses), std::end(kCellUses),
                                   [&](const CellUse& one) { return one.name == builtin; });
    if (use == std::end(kCellUses)) return;
    (use->writes ? out.written : out.read).insert({Shared::kCells, use->kind, 0});
  }

  template <typename Calls>
  void note_calls(const PlanInstruction& instruction, const Calls& calls) const {
    const auto op = instruction.op;
    const auto a = instruction.a;
    if (op == PlanOp::kCall || op == PlanOp::kCallLocal || op == PlanOp::kPushCleanup ||
        op == PlanOp::kRunCleanup) {
      calls(a);
    } else if (op == PlanOp::kCallValue) {
      for (const auto& made : code_.functions_made) {
        if (!made.builtin) calls(made.unit);
      }
    } else if (op == PlanOp::kPushHandlers) {
      for (const auto& clause : code_.handlers[a]) calls(clause.unit);
    } else if (op == PlanOp::kPar) {
      for (const auto unit : code_.pars[a].units) calls(unit);
    } else if (ruled_ && (op == PlanOp::kPerform || op == PlanOp::kHolds)) {
      for (const auto& [name, unit] : code_.functions) calls(unit);
    }
  }

  PlanCode& code_;
  const bool ruled_;
};

}  // namespace

void note_races(PlanCode& code, bool ruled) { RaceFinder(code, ruled).find(); }

}  // namespace parallax::compiler
