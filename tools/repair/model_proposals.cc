#include "tools/repair/model_proposals.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_text.h"
#include "compiler/repair/guarded_model.h"
#include "tools/repair/binding_change.h"
#include "tools/repair/edit_scope.h"
#include "tools/repair/edit_search.h"
#include "tools/repair/world_files.h"

namespace parallax::tools {

using compiler::Edit;
using compiler::EditScope;

namespace {

constexpr std::size_t kMostSets = 400;     // that the solver is asked for, of one size
constexpr std::size_t kMostVerified = 40;  // of them are compiled and checked, the likeliest
constexpr std::size_t kMostWays = 32;  // that runs went are put to the solver, failed ones first

class ModelSearch {
 public:
  ModelSearch(const RepairInput& input, Context& context)
      : input_(input), domain_(*input.domain), evidence_(input.evidence), context_(context) {}

  FoundProposals run() {
    if (input_.contradictions.empty()) {
      search_all(Mode::kExact);
      // None of these follows a run to its end: there may be a further mistake behind the first.
      for (std::size_t size = 1; size <= 2 && most_whole() == 0 && !context_.stopped(); ++size) {
        search(Mode::kWhole, size, 0);
      }
      // As a last resort, leaves the outcome open: even for one run that tried twice and saw both
      // outcomes.
      if (result_.proposals.empty() && !context_.stopped()) search(Mode::kOpen, 1);
    } else {
      cautious_ = evidence_;
      // Not a precaution unless the world refused the event in some failed run.
      if (set_aside(evidence_, cautious_) && !search(Mode::kCautious, 1) && !context_.stopped()) {
        search(Mode::kCautious, 2);
      }
      // Then models that admit all runs.
      for (std::size_t size = 1; size <= EditSearch::kMostEdits && !context_.stopped(); ++size) {
        if (search(Mode::kOpen, size)) break;
      }
    }
    if (result_.proposals.empty() && !context_.stopped()) find_nearest_miss();
    return std::move(result_);
  }

 private:
  /// Treatment of runs that went the same way and ended differently.
  enum class Mode : std::uint8_t {
    kExact,     // there are none
    kCautious,  // those that went well are set aside from there on
    kOpen,      // the model may leave open what happens
    kWide,      // kExact, about all that led to the step
    kEither,    // kExact, with conditions of which one of two is enough
    kWhole,     // kWide, about whole runs, which have to go to their end
  };

  std::size_t most_whole() const {
    std::size_t out = 0;
    for (const auto& each : result_.proposals) out = std::max(out, each.verdict.runs_whole);
    return out;
  }

  /// Is some proposal right on all random sequences of events, if there are any?
  bool is_borne_out() const {
    return std::any_of(result_.proposals.begin(), result_.proposals.end(), [&](const auto& each) {
      return !each.open && each.verdict.validated == input_.sequences.choosing.size();
    });
  }

  /// First edits about the steps themselves, then about earlier steps; more edits last.
  void search_all(Mode mode) {
    if (search(mode, 1)) {
      const bool open = std::all_of(result_.proposals.begin(), result_.proposals.end(),
                                    [](const Proposal& each) { return each.open; });
      // An open outcome is no answer where a condition determines it.
      if (open && !context_.stopped() && search(Mode::kEither, 1)) return;
      // Adds a condition to a missing effect if that explains more runs, or replaces constants by
      // variables.
      const auto best = most_whole();
      if (context_.stopped()) return;
      if (best == input_.runs) {
        refine(mode);
        return;
      }
      only_constants_ ? search(mode, 2, std::nullopt, true) : search(mode, 2, best);
      return;
    }
    if (context_.stopped() || search(Mode::kWide, 1) || context_.stopped()) return;
    for (std::size_t size = 2; size <= EditSearch::kMostEdits && !context_.stopped(); ++size) {
      if (search(mode, size)) return;
    }
    if (!context_.stopped()) search(Mode::kEither, 1);
  }

  EditScope scope(Mode mode) const {
    const auto reach = mode == Mode::kWhole  ? ScopeReach::kWholeRuns
                       : mode == Mode::kWide ? ScopeReach::kEarlierSteps
                                             : ScopeReach::kPartings;
    auto out = edit_scope(input_, reach);
    out.open_outcomes = mode == Mode::kOpen;
    out.open_refused = mode == Mode::kExact;
    out.alternatives = mode == Mode::kEither;
    return out;
  }

  /// True if there are proposals that admit more than `whole` runs to their end; `conditional`:
  /// only effects with a condition.
  bool search(Mode mode, std::size_t size, std::optional<std::size_t> whole = std::nullopt,
              bool conditional = false) {
    const auto& evidence = mode == Mode::kCautious ? cautious_ : evidence_;
    auto& known = searches_[mode];
    if (!known) {
      known = std::make_unique<Prepared>();
      known->guarded = guarded(mode);
      if (known->guarded->model) {
        const auto& edits = known->guarded->edits;
        known->evidence = ways(evidence);
        if (mode == Mode::kWhole) ask_to_the_end(known->evidence);
        known->search = std::make_unique<EditSearch>(*known->guarded->model, edits, known->evidence,
                                                     context_.stop());
        for (std::size_t i = 0; i < edits.size() && mode == Mode::kCautious; ++i) {
          if (opens(edits[i])) known->search->exclude(i);
        }
      }
    }
    if (!known->search) return false;
    auto found = known->search->find(size, kMostSets);
    const auto& edits = known->guarded->edits;
    if (conditional) {
      std::erase_if(found.sets, [&](const auto& set) {
        return std::none_of(set.begin(), set.end(), [&](std::size_t edit) {
          return edits[edit].kind == Edit::Kind::kAddCondition;
        });
      });
    }
    return take(*known, found, evidence, mode, whole);
  }

  /// A model with the edits in it, compiled.
  struct Guarded {
    std::vector<Edit> edits;
    std::optional<compiler::CompiledModel> model;
  };

  /// The edits and the compiled model of a mode. kCautious shares those of kOpen: compiling takes
  /// longer than all queries together.
  std::shared_ptr<const Guarded> guarded(Mode mode) {
    auto& known = guarded_[mode == Mode::kCautious ? Mode::kOpen : mode];
    if (known) return known;
    auto out = std::make_shared<Guarded>();
    known = out;
    out->edits = compiler::edits_in_scope(domain_.ast, *domain_.typed, domain_.forms,
                                          scope(mode == Mode::kCautious ? Mode::kOpen : mode));
    if (mode == Mode::kWide) keep_few(out->edits, {});
    if (mode == Mode::kWhole) keep_few(out->edits, parting_events());
    result_.edits = std::max(result_.edits, out->edits.size());
    std::size_t horizon = 1;
    for (const auto& seen : evidence_) {
      horizon = std::max(horizon, mode == Mode::kWhole ? seen.steps.size() : seen.needed());
    }
    std::string why;
    do {
      const auto text = compiler::guarded_text(domain_.ast, *domain_.typed, domain_.files,
                                               domain_.forms, out->edits);
      out->model = compile_text(text, static_cast<std::int64_t>(horizon), context_, why);
    } while (!out->model && !context_.stopped() && fewer(out->edits));
    if (!out->model) {
      result_.remarks.push_back("the edits could not be compiled together: " + why);
    }
    return known;
  }

  static bool opens(const Edit& edit) {
    return edit.kind == Edit::Kind::kOpenEvent || edit.frees ||
           (edit.kind == Edit::Kind::kAddEffect && edit.text.starts_with("Releases"));
  }

  /// Reduces the edits of a model that is too large: drops conditions of new effects, then the
  /// odder half. False: there are too few already.
  static bool fewer(std::vector<Edit>& edits) {
    constexpr std::size_t kFew = 50;
    if (edits.size() <= kFew) return false;
    const auto before = edits.size();
    // The remaining edits refer to no others, so that they may be sorted.
    std::erase_if(edits, [](const Edit& edit) { return edit.kind == Edit::Kind::kAddCondition; });
    if (edits.size() < before) return true;
    std::stable_sort(edits.begin(), edits.end(),
                     [](const Edit& a, const Edit& b) { return a.oddity < b.oddity; });
    edits.resize(before / 2);
    return true;
  }

  static std::vector<Evidence> ways(std::vector<Evidence> evidence) {
    std::stable_partition(evidence.begin(), evidence.end(),
                          [](const Evidence& seen) { return seen.divergence.has_value(); });
    if (evidence.size() > kMostWays) evidence.resize(kMostWays);
    return evidence;
  }

  std::set<std::string> parting_events() const {
    std::set<std::string> out;
    for (const auto& parting : input_.partings) out.insert(base::symbol_of(parting.step.event));
    return out;
  }

  /// Requires of a repaired model to follow each run to its end, not to the first difference alone.
  static void ask_to_the_end(std::vector<Evidence>& evidence) {
    for (auto& seen : evidence) {
      if (seen.divergence) seen.divergence = seen.steps.size();
    }
  }

  /// Far from the step, conditions are only dropped and effects only mended: there are too many new
  /// ones.
  static void keep_few(std::vector<Edit>& edits, const std::set<std::string>& near) {
    constexpr std::size_t kMostWide = 600;
    using Kind = Edit::Kind;
    std::erase_if(edits, [&](const Edit& edit) {
      const bool narrows = edit.kind == Kind::kNarrow || edit.kind == Kind::kNarrowEvent ||
                           edit.kind == Kind::kRequire;
      return edit.kind == Kind::kAddCondition || (narrows && !near.contains(edit.event));
    });
    std::stable_sort(edits.begin(), edits.end(),
                     [](const Edit& a, const Edit& b) { return a.oddity < b.oddity; });
    if (edits.size() > kMostWide) edits.resize(kMostWide);
  }

  struct Prepared {
    std::shared_ptr<const Guarded> guarded;
    std::vector<Evidence> evidence;  // that the search is asked about; all of it is checked later
    std::unique_ptr<EditSearch> search;
  };

  /// The proposal that these edits are. None: the check of their text says no.
  std::optional<Proposal> proposal_of(const Prepared& prepared, const compiler::EditText& texts,
                                      const std::vector<std::size_t>& set,
                                      const std::vector<Evidence>& evidence, Mode mode) {
    const auto& edits = prepared.guarded->edits;
    const auto changes = texts.changes(set);
    Proposal proposal;
    proposal.text = compiler::flat_text(domain_.ast, domain_.files, changes);
    proposal.verdict =
        verify(*proposal.text, evidence, input_.sequences.choosing, context_, input_.memo.get());
    if (!proposal.verdict.admits) {
      result_.remarks.push_back(
          fmt::format("not proposed, as the check of its text says no: {} ({})", texts.words(set),
                      proposal.verdict.why));
      return std::nullopt;
    }
    proposal.precaution = mode == Mode::kCautious;
    // An effect with its conditions is one axiom, and one edit with the first of them.
    const auto conditions = std::count_if(set.begin(), set.end(), [&](std::size_t edit) {
      return edits[edit].kind == Edit::Kind::kAddCondition;
    });
    proposal.size = set.size() - (conditions > 0 ? 1 : 0);
    for (const auto edit : set) proposal.oddity += edits[edit].oddity;
    proposal.words = texts.words(set);
    proposal.files = changed_files(domain_.files, changes);
    for (const auto edit : set) {
      const auto& each = edits[edit];
      if (!opens(each)) continue;
      tell_failures(each.event, proposal);
      proposal.open = true;
    }
    return proposal;
  }

  /// Adds conditions to a new effect or trigger, one after the other, as long as random sequences
  /// bear out more of it: the runs, which it explains without them, ask for none. All that bear out
  /// as much are proposed, as these sequences cannot tell which is right.
  void refine(Mode mode) {
    const auto& known = searches_[mode];
    if (input_.sequences.choosing.empty() || !known || !known->search || is_borne_out()) return;
    const auto& edits = known->guarded->edits;
    const compiler::EditText texts(domain_.ast, domain_.files, domain_.forms, edits,
                                   files_of_world());
    const auto is_new = [&](std::size_t edit) {
      return !opens(edits[edit]) && (edits[edit].kind == Edit::Kind::kAddEffect ||
                                     edits[edit].kind == Edit::Kind::kAddTrigger);
    };
    std::pair<std::size_t, std::vector<std::size_t>> best;
    for (const auto& [validated, set] : taken_) {
      const bool better = best.second.empty() || validated > best.first;
      if (better && std::count_if(set.begin(), set.end(), is_new) == 1) best = {validated, set};
    }
    constexpr int kMostConditions = 3;
    for (int round = 0; round < kMostConditions && !best.second.empty(); ++round) {
      const auto of = *std::find_if(best.second.begin(), best.second.end(), is_new);
      std::vector<Proposal> found;
      auto improved = best;
      for (std::size_t i = of + 1; i < edits.size() && !context_.stopped(); ++i) {
        if (edits[i].kind != Edit::Kind::kAddCondition || edits[i].of != of) break;
        auto set = best.second;
        if (std::find(set.begin(), set.end(), i) != set.end()) continue;
        set.push_back(i);
        std::sort(set.begin(), set.end());
        auto proposal = proposal_of(*known, texts, set, evidence_, mode);
        if (!proposal || proposal->verdict.validated <= best.first) continue;
        const auto right = proposal->verdict.validated;
        if (right < improved.first) continue;
        if (right > improved.first) {
          improved = {right, std::move(set)};
          found.clear();
        }
        found.push_back(*std::move(proposal));
      }
      if (found.empty()) return;
      best = std::move(improved);
      for (auto& each : found) result_.proposals.push_back(std::move(each));
      if (is_borne_out()) return;
    }
  }

  bool take(const Prepared& prepared, const EditSearch::Found& found,
            const std::vector<Evidence>& evidence, Mode mode, std::optional<std::size_t> whole) {
    const auto& edits = prepared.guarded->edits;
    const compiler::EditText texts(domain_.ast, domain_.files, domain_.forms, edits,
                                   files_of_world());
    std::vector<Proposal> tried;
    std::vector<std::vector<std::size_t>> sets = found.sets;
    const auto oddity = [&](const std::vector<std::size_t>& set) {
      int out = 0;
      for (const auto edit : set) out += edits[edit].oddity;
      return out;
    };
    std::stable_sort(sets.begin(), sets.end(), [&](const auto& a, const auto& b) {
      return oddity(a) != oddity(b) ? oddity(a) < oddity(b) : a < b;
    });
    result_.more = result_.more || !found.complete || sets.size() > kMostVerified;
    std::set<std::string> seen;
    for (const auto& set : sets) {
      if (tried.size() == kMostVerified || context_.stopped()) break;
      const auto text = compiler::flat_text(domain_.ast, domain_.files, texts.changes(set));
      if (!seen.insert(text).second) continue;
      auto proposal = proposal_of(prepared, texts, set, evidence, mode);
      if (!proposal) continue;
      if (whole && proposal->verdict.runs_whole <= *whole) continue;
      only_constants_ = (tried.empty() || only_constants_) &&
                        std::all_of(set.begin(), set.end(),
                                    [&](auto edit) { return edits[edit].names_constants; });
      taken_.emplace_back(proposal->verdict.validated, set);
      tried.push_back(*std::move(proposal));
    }
    const bool any = !tried.empty();
    if (!any) only_constants_ = false;
    auto& all = result_.proposals;
    all.insert(all.end(), std::make_move_iterator(tried.begin()),
               std::make_move_iterator(tried.end()));
    return any;
  }

  /// Adds what the plan is told where the world refused the event that may fail now.
  void tell_failures(const std::string& event, Proposal& proposal) const {
    std::set<std::string> told;
    for (const auto& parting : input_.partings) {
      const auto& step = parting.step;
      if (!step.failed || base::symbol_of(step.event) != event) continue;
      if (!told.insert(step.reason).second) continue;
      auto bound = bound_failure(input_, step);
      if (!bound) continue;
      proposal.evidence.push_back(std::move(bound->words));
      if (!bound->file || proposal.changes == Proposal::Changes::kBinding) continue;
      proposal.files.push_back(*std::move(bound->file));
      proposal.changes = Proposal::Changes::kBinding;
    }
  }

  /// The numbers of the model's files that the world reads as well.
  std::set<std::uint32_t> files_of_world() const {
    std::vector<ChangedFile> all;
    for (std::uint32_t i = 0; i < domain_.files.size(); ++i) {
      all.push_back({domain_.files[base::FileId(i)].name(), "", ""});
    }
    const auto shared = read_by_world(input_.loaded.scenario, all, context_);
    std::set<std::uint32_t> out;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      if (std::find(shared.begin(), shared.end(), all[i].name) != shared.end()) out.insert(i);
    }
    return out;
  }

  void find_nearest_miss() {
    auto& known = searches_[input_.contradictions.empty() ? Mode::kExact : Mode::kOpen];
    if (!known || !known->search) return;
    const compiler::EditText texts(domain_.ast, domain_.files, domain_.forms,
                                   known->guarded->edits);
    for (std::size_t i = 0; i < known->evidence.size(); ++i) {
      if (!known->evidence[i].divergence) continue;
      const auto set = known->search->find_for({i}, 1);
      if (!set || set->empty()) continue;
      result_.nearest_miss =
          fmt::format("{}: explains run {} and the clean ones, not all that failed",
                      texts.words(*set), known->evidence[i].ids.front());
      return;
    }
  }

  const RepairInput& input_;
  const DomainModel& domain_;
  const std::vector<Evidence>& evidence_;
  std::vector<Evidence> cautious_;
  Context& context_;
  std::map<Mode, std::shared_ptr<const Guarded>> guarded_;
  std::map<Mode, std::unique_ptr<Prepared>> searches_;
  FoundProposals result_;
  /// Sets of edits that were taken, with the random sequences that they are right on.
  std::vector<std::pair<std::size_t, std::vector<std::size_t>>> taken_;
  bool only_constants_ = false;  // of what was taken last: all are effects that name constants
};

}  // namespace

FoundProposals model_proposals(const RepairInput& input, Context& context) {
  return ModelSearch(input, context).run();
}

}  // namespace parallax::tools
