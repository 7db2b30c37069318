#include "tools/cli/help_topics.h"

namespace parallax::tools {
namespace {

constexpr HelpTopic kTopics[] = {
    {"exit-codes", "What a command says by the way it ends",
     "    0    nothing to report\n"
     "    1    a finding: a discrepancy, a violated property, a difference\n"
     "    2    usage: the command line, or a file that cannot be read or written\n"
     "    3    an input was rejected; the message says where and why\n"
     "    4    inconclusive: a limit or a signal came first, or too little was simulated\n"
     "    5    an internal error, or a result that an independent check did not confirm\n"
     "    130  interrupted (SIGINT), 143 terminated (SIGTERM)\n"
     "The help of each command says what 0, 1 and 4 mean there.\n"},
    {"files", "Which files there are, and which command reads them",
     "    *.e            a model: what happens and what it changes "
     "(docs/reference/model_language.md)\n"
     "    *.lisp         a plan (docs/reference/plan_language.md)\n"
     "    *.bind         what the plan's designators mean in the model\n"
     "    *.yaml         a scenario, which ties model, plan and world together\n"
     "                   (docs/reference/scenario.md); its world; a suite "
     "(docs/reference/suites.md)\n"
     "    *.dec.cnf      a compiled model (docs/reference/formats.md)\n"
     "    *.itf.json     traces, as are *.jsonl (docs/reference/formats.md)\n"
     "    *.sdf, *.urdf  worlds and robots of other programs, as are files in MJCF (*.xml;\n"
     "                   docs/guide/worlds.md)\n"
     "A run leaves a folder, out/NAME unless --out says otherwise:\n"
     "    journal.ndjson            each simulation, a line (docs/reference/formats.md)\n"
     "    report.txt, report.json   the whole account\n"
     "    recordings/               what moved (docs/reference/formats.md)\n"
     "`replay`, `report`, `draw`, `explain`, `confirm`, `coverage` and `repair` read it.\n"},
    {"output", "What is printed where, colours, and forms for programs",
     "Results are on standard output, messages on standard error. --json prints exactly one "
     "document;\n"
     "--diagnostics=json and =sarif print messages for programs (docs/guide/models.md).\n"
     "--quiet leaves out progress, remarks and warnings.\n"
     "Colours are used on terminals, unless --color or the environment variable NO_COLOR says\n"
     "otherwise.\n"},
    {"seeds", "What is random, and how it is repeated",
     "Starts, and whatever a scenario leaves to chance, are drawn from --seed alone; a draw is "
     "the\n"
     "same for any number of --jobs and on any machine. The same inputs, options and seed give the "
     "same\n"
     "bytes, but for what stands in a field called `timing`.\n"
     "Physics is computed in floating point: on one machine it is the same to the last bit, which\n"
     "`parallax replay` checks; on another machine its last digits may differ "
     "(docs/internals/physics.md).\n"},
    {"trust", "What a stranger's files can do",
     "A file may name files of its own folder, or of the nearest one above that holds a\n"
     "`.parallax-root`, and no others; --allow-outside lifts that.\n"
     "A command that a scenario names as its simulator is a program with your rights. `run`, "
     "`rates`,\n"
     "`learn` and `adapter-check` start it and say so, the first three unless --no-commands is "
     "given;\n"
     "all others only with --allow-commands, if at all. Before you run a stranger's scenario, look "
     "for `command:` in it\n"
     "(docs/reference/trust.md).\n"},
    {"limits", "How a command is kept from taking too long or too much",
     "--time-limit and --memory-limit end any command, with exit code 4 unless it had its answer. "
     "What\n"
     "was found before is printed, and a run folder can be continued (`run --resume`).\n"
     "An interrupt (Ctrl-C) ends it in the same way; a second one at once.\n"},
};

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

}  // namespace parallax::tools
