#pragma once

#include <filesystem>
#include <string>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/campaign_result.h"
#include "harness/campaign/rare_rates.h"
#include "harness/campaign/rates.h"
#include "harness/campaign/replay.h"

namespace parallax::harness {

struct ReportStyle {
  bool color = false;
  bool figures = false;  // of the paper's rule: b, sigma and interval of each final parameter
};

/// The account for people: per trace the events with their places, simulations, verdict, both
/// confidence figures and what exactly is claimed; then the verdict. 100 columns.
std::string campaign_text(const CampaignResult& result, const ReportStyle& style);

/// The same on one screen, under 40 lines: the verdict with its cause or claim first, what happened
/// at the discrepancy, what is claimed of each trace, and which command looks further.
std::string campaign_summary(const CampaignResult& result, const ReportStyle& style);

/// The document of `parallax run --json`, one line with a newline; `timing`, and the figures of the
/// paper's rule, only if asked for.
std::string campaign_json(const CampaignResult& result, bool with_timing,
                          bool with_figures = false);

/// The command that repeats the simulation, for the folder where the run was started. The run
/// folder is quoted where a shell needs it.
std::string replay_command(const std::string& run_dir, const Discrepancy& found);

/// Writes report.txt and report.json, without timing and colour, into the run folder, which exists.
base::Status write_report(const CampaignResult& result, const std::filesystem::path& run_dir,
                          base::DiagnosticSink& sink);

std::string replay_text(const ReplayResult& result, const ReportStyle& style);
std::string replay_json(const ReplayResult& result);

/// A table: per trace the causes with counts, rates and intervals.
std::string rates_text(const RatesResult& result);
/// "Clopper-Pearson", "valid whenever one looks"
std::string_view interval_name(const RatesResult& result);
std::string rates_json(const RatesResult& result);
std::string rates_text(const RareRatesResult& result);
std::string rates_json(const RareRatesResult& result);

/// 0 no discrepancy, 1 discrepancy, 4 inconclusive, also without a trace; an interruption's 130 or
/// 143 is the caller's.
int exit_code(const CampaignResult& result);

}  // namespace parallax::harness
