#include "compiler/ground/shared_instances.h"

#include <set>
#include <string>
#include <tuple>

#include "compiler/base/codes/grounding.h"

namespace parallax::compiler {
namespace {

class SharedInstanceReport {
 public:
  SharedInstanceReport(GroundModel& model, FormulaGrounder& grounder, base::DiagnosticSink& sink)
      : model_(model), grounder_(grounder), sink_(sink) {}

  /// Looks at the instances of the conjunct until every part that can be missing was.
  void look_at(const SharedInstance& shared) {
    grounder_.start(shared.source);
    const auto& variables = shared.variables;
    const auto found =
        grounder_.instances(variables, conjuncts_of(model_.typed(), shared.condition, false));
    const auto width = variables.size();
    const auto count = width == 0 ? 1 : found.size() / width;
    std::size_t left = shared.parts.size();
    for (std::size_t i = 0; i < count && left > 0 && grounder_.spend(1); ++i) {
      for (std::size_t k = 0; k < width; ++k) grounder_.bind(variables[k], found[i * width + k]);
      if (!can_be_said(shared)) continue;
      for (const auto& part : shared.parts) {
        if (grounder_.ground(part.existence) || grounder_.failed()) continue;
        if (report(shared, part, found.data() + i * width)) --left;
      }
    }
    for (const auto variable : variables) grounder_.unbind(variable);
  }

 private:
  bool can_be_said(const SharedInstance& shared) {
    if (!grounder_.ground(shared.existence)) return false;
    const auto condition = grounder_.ground(shared.condition);
    return condition && *condition != model_.formulas().falsity();
  }

  /// False: it was reported before.
  bool report(const SharedInstance& shared, const SharedInstance::Part& part,
              const GroundTermId* values) {
    const auto place = std::tuple(part.source.file.index(), part.source.begin, part.source.end);
    if (!reported_.insert(place).second) return false;
    std::string instance;
    for (std::size_t k = 0; k < shared.variables.size(); ++k) {
      instance += (k == 0 ? ", as for " : ", ") +
                  model_.typed().variables[shared.variables[k]].name + "=" +
                  model_.terms().text(values[k], model_.typed());
    }
    sink_.warning(codes::kInstanceNotSaid, part.source, instance)
        .note(shared.source, "then this is not said either");
    return true;
  }

  GroundModel& model_;
  FormulaGrounder& grounder_;
  base::DiagnosticSink& sink_;
  std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> reported_;
};

}  // namespace

void report_shared_instances(GroundModel& model, FormulaGrounder& grounder,
                             base::DiagnosticSink& sink) {
  SharedInstanceReport report(model, grounder, sink);
  for (const auto& shared : model.typed().shared_instances) {
    report.look_at(shared);
    if (grounder.failed()) return;
  }
}

}  // namespace parallax::compiler
