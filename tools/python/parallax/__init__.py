"""Ask `parallax` from Python: traces, properties, runs in a simulator, rates of discrepancies.

    from parallax import Model, Scenario

    for trace in Model("domain.e", "start.e", horizon=4).traces():
        print(trace.events)
    run = Scenario("edge.yaml").run()
    print(run.verdict, run.explain().words)

The package starts the program `parallax` and reads what it prints as JSON (`parallax schema
--list`). It needs Python 3.8 and nothing else; frames need pandas. docs/guide/python.md is its guide.
"""

from ._adapter import AdapterCheck, adapter_check
from ._errors import (
    Diagnostic,
    Inconclusive,
    InputRejected,
    Interrupted,
    Note,
    ParallaxError,
    ProgramCrashed,
    ProgramNotFound,
    UsageError,
    WrongVersion,
)
from ._explanations import Axiom, Conflict, Explanation, Step, Why
from ._model import Model
from ._process import program, use_program
from ._runs import Claim, Discrepancy, DivergingFluent, Rate, Rates, Run, Sample, TraceRates, TraceRun
from ._scenario import Scenario, rates, report, run
from ._simulator import (
    Adapter,
    Failed,
    InvalidStart,
    Lost,
    action,
    observed,
    param,
    poses,
    serve,
    simulator,
)
from ._stream import TraceStream
from ._traces import Answer, Check, Count, Summary, Timepoint, Trace
from ._version import __version__

__all__ = [
    "Adapter", "AdapterCheck", "Answer", "Axiom", "Check", "Claim", "Conflict", "Count", "Diagnostic",
    "Discrepancy", "DivergingFluent", "Explanation", "Failed", "Inconclusive", "InputRejected",
    "Interrupted", "InvalidStart", "Lost", "Model", "Note", "ParallaxError", "ProgramCrashed",
    "ProgramNotFound", "Rate", "Rates", "Run", "Sample", "Scenario", "Step", "Summary",
    "Timepoint", "Trace", "TraceRates", "TraceRun", "TraceStream", "UsageError", "Why",
    "WrongVersion", "__version__", "action", "adapter_check", "observed", "param", "poses",
    "program", "rates", "report", "run", "serve", "simulator", "use_program",
]
