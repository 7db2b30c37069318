#pragma once

#include <string>

#include "compiler/base/result.h"
#include "harness/campaign/journal.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"
#include "tools/page/page_data.h"

namespace parallax::tools {

struct PageOptions {
  std::string folder;
  std::string scenario;  // if the file was moved; empty: where the journal says
  bool explain = false;  // also where `explain` has not been at the folder
  bool repair = false;
  std::string ledger;                   // file of known discrepancies; empty: none is asked
  std::vector<std::string> properties;  // of the scenario; with a ledger
};

/// The contents of a run folder's page: report.json and journal as they are, nothing is simulated.
/// Missing, damaged or changed files become a banner. Fails, having reported, only where the folder
/// holds nothing of a run.
base::Result<PageData> gather_page(const PageOptions& options, Context& context);

// Its parts.

/// Adds the contents of report.json, each field as far as it is there and of the right type; false
/// if the text is no report.
bool add_report(const std::string& text, PageData& page);

/// The simulations with their starts and ways; `page` has the report. `further`, which may be null,
/// has simulations that are added later: their variables count.
void add_journal(const harness::JournalText& journal, const harness::JournalText* further,
                 PageData& page);

/// Adds timelines of the discrepancies and of a clean simulation of each trace, after all were
/// judged. `loaded` may be null: then nothing says what was observed.
void add_timelines(const harness::JournalText& journal, const ScenarioModel* loaded,
                   PageData& page);

/// One simulation, not judged yet; `page` has its variables and bodies.
PageSample page_sample(const harness::SampleRecord& record, const PageData& page);

/// Judges the executions of the plan in `journal` whose results are not recorded one by one, with
/// the model as `explain` does it; if there are very many, only the first ones.
void judge_executions(const harness::JournalText& journal, const ScenarioModel& loaded,
                      Context& context, PageData& page);

/// Simulations that `explain` made, also of an executed plan.
void add_further(const harness::JournalText& further, const ScenarioModel& loaded, Context& context,
                 PageData& page);

/// Where simulations fail like the first discrepancy, from the starts on record, where they show
/// it.
void add_rule(PageData& page);

/// Certificates of `prove` that lie in the folder (`*.proof.json`), of the scenario as it was run.
/// `page` has all simulations, judged.
void add_proofs(const PageOptions& options, const harness::JournalHeader& header, PageData& page);

/// Recorded motion of the simulations that matter most; `page` has all of them, judged.
void add_motion(PageData& page);

/// Regions and furniture, sources, axioms by event.
void add_world(const ScenarioModel& loaded, const base::SourceFiles& files, PageData& page);

/// Adds the results of `explain` and `repair` for the folder, without further simulations.
void add_blame(const PageOptions& options, Context& context, PageData& page);
void add_repair(const PageOptions& options, Context& context, PageData& page);

/// Adds the ledger's entries for the run, and for each property whether it rests on an open
/// discrepancy. `scenario`: the file, empty where it has changed since the run. Fails, having
/// reported, where the ledger or a property cannot be read.
base::Status add_ledger(const PageOptions& options, const std::string& scenario, Context& context,
                        PageData& page);

/// The messages of a sink, each on a line.
std::string messages_of(const Context& context);

}  // namespace parallax::tools
