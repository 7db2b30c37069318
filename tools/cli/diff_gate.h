#pragma once

#include <string>

#include "tools/cli/command.h"
#include "tools/diff/gate.h"

namespace parallax::tools {

/// `diff --gate RULES`: the rules, and the Markdown to write; empty: none.
struct GateFiles {
  std::string rules, markdown;
};

/// Checks the change against the rules, prints the results, and writes the Markdown with a picture
/// beside it where a discrepancy of a run can be drawn. 1 unless the gate passes.
int run_gate(const GateInput& input, const GateFiles& files, Invocation& invocation);

/// Makes the simulators of rules that demand runs, of either side. A command that a scenario names
/// is started if it is `permitted`, and told. `invocation` outlives the maker.
SimulatorMaker gate_simulator(bool permitted, const Invocation& invocation);

/// Two revisions of the git repository that a file or folder lies in.
struct GateRevisions {
  std::string before, after;  // as git reads them
  std::string path;           // what of the repository is looked at; empty: the current folder
};

/// The same for folders as two revisions have them, checked out in a temporary folder. `input`: how
/// they are compared; its paths do not count.
int run_revision_gate(const GateRevisions& revisions, const GateInput& input,
                      const GateFiles& files, Invocation& invocation);

}  // namespace parallax::tools
