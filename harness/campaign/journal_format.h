#pragma once

// The lines of RUN_DIR/journal.ndjson as text (docs/reference/formats.md): a header, then one line
// per trace before its first sample, one per finished simulation, in order of completion.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/campaign/campaign.h"
#include "harness/campaign/recorded_options.h"
#include "harness/campaign/sample_record.h"

namespace parallax::harness {

/// The properties that must be equal for a run to be continued or repeated, except for the name of
/// the scenario, the folder it was started in and `max_runs`.
struct JournalHeader {
  std::string scenario;      // as the user wrote it
  std::string start_folder;  // where that path starts; empty in older journals
  std::string scenario_hash;
  std::uint64_t seed = 0;
  std::string tool_version;
  std::string arithmetic;   // of its machine (CampaignOptions); empty: not known
  std::string build;        // of its program and libraries, likewise
  bool mixed = false;       // workers may differ in both, and each simulation names its kind
  SimulatorInfo simulator;  // without parameters and actions: the scenario was checked against them
  std::string command_hash;   // over the files of its command; empty: built in, or an older journal
  std::int64_t max_runs = 0;  // of a trace; 0: as the criterion needs
  std::string options;        // canonical JSON of criterion, limits without max_runs, keep_going
  RecordedOptions asked;      // the same, as it was read
};
JournalHeader journal_header(const Scenario& scenario, const CampaignOptions& options,
                             const SimulatorInfo& simulator);

/// A trace that was handed to the simulator. Of one that was read the symbols are those that the
/// journal names, and the plan's arguments are in the calls only.
struct TraceLine {
  std::shared_ptr<const CampaignTrace> trace;
  std::vector<ActionCall> calls;  // by event
  /// Number of the initial state that it begins in, from 2; the line of a trace itself is that of
  /// the first, or only one, and has 0.
  std::int64_t start_state = 0;
  /// How the initial states of the trace are drawn: "uniform of 6". Empty: there is one, or one
  /// only was sampled, as in older journals.
  std::string initial_states = {};
  friend bool operator==(const TraceLine& a, const TraceLine& b);
};
/// The same trace with the same calls, by names, wherever the plan's events stand.
bool same_but_for_places(const TraceLine& a, const TraceLine& b);

std::string encode(const JournalHeader& header);
std::string encode(const TraceLine& trace);
std::string encode(const SampleRecord& record);

struct ForeignLine {
  std::string why;  // "`seed` is missing"
};
std::variant<JournalHeader, ForeignLine> decode_header(std::string_view line);
/// `symbols`: of all traces of the journal; the names of the line are added.
std::variant<TraceLine, SampleRecord, ForeignLine> decode_line(
    std::string_view line, const std::shared_ptr<compiler::SymbolTable>& symbols);

/// Has a file of the simulator's command changed since? Older journals do not tell.
bool command_changed(const JournalHeader& recorded, const std::string& command_hash);

/// The first field in which two headers differ and must not, with both values.
struct HeaderDifference {
  std::string field;  // "seed", "options.criterion.epsilon"
  std::string recorded, now;
};
/// Differences between the machine that made a simulation and this one, as far as they are known.
struct MachineChange {
  bool arithmetic = false;  // the machine calculates otherwise
  bool build = false;       // another build of the program or of a library
};
MachineChange machine_change(const JournalHeader& recorded, const SampleRecord& record,
                             const std::string& arithmetic, const std::string& build);

std::optional<HeaderDifference> header_difference(const JournalHeader& recorded,
                                                  const JournalHeader& now);

}  // namespace parallax::harness
