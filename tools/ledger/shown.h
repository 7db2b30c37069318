#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools {

/// A discrepancy without the properties that depend on seeds, samples and line numbers.
struct ShownDiscrepancy {
  std::string sample;   // "1.3"; empty where it was counted only
  std::string event;    // the last one before model and world part; "start": they never agreed
  std::string outcome;  // outcome of the event; empty: it went well, and fluents differ
  std::vector<std::string> fluents;  // those, sorted: "F(a)" that was seen, "not F(a)"
  std::vector<std::string> trace;    // the events before it: "Detect(cup) = cup1", "Go(r2)"
  std::string words;                 // for people
  /// It was counted by its cause: `fluents` has one of them, and `trace` is the whole trace.
  bool counted = false;
};

/// The discrepancies of a run, and those that it would have shown had they been there.
struct ShownRun {
  std::string scenario;  // as the run names it
  std::vector<ShownDiscrepancy> discrepancies;
  struct Trace {
    std::vector<std::string> events;
    bool is_clean = false;  // its verdict is no-discrepancy
  };
  std::vector<Trace> traces;
  bool is_executed = false;  // in closed loop: one entry in `traces`, without events
  /// Every trace was explored to its verdict.
  bool is_complete = false;
};

/// Reads the document of `parallax run --json`, or a report.json. None if it is neither.
std::optional<ShownRun> shown_run(std::string_view document);

/// Reads the document of `parallax rates --json`: each cause that was counted.
std::optional<ShownRun> shown_rates(std::string_view document);

/// "after Go(r2), PickUp(): Go(r1) path-blocked": for messages.
std::string identity_text(const ShownDiscrepancy& shown);

}  // namespace parallax::tools
