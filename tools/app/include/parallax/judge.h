#pragma once

// Predictions held against simulations: one sample at a time, or the whole loop.
//
//     parallax::TrialBench bench(scenario, traces, make_simulator, {.seed = 1}, {},
//     context.sink()); if (!bench.start()) ... auto trial = parallax::Trial::prepare(bench, trace);
//     const auto sample = trial->next();  // simulated and judged
//     trial->end();

#include "harness/campaign/campaign.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/rates.h"
#include "harness/campaign/trial.h"
#include "parallax/enumerate.h"
#include "parallax/simulate.h"

namespace parallax {

using harness::estimate_rates;
using harness::judge;
using harness::Judgement;
using harness::run_campaign;
using harness::SampleVerdict;
using harness::Trial;
using harness::TrialBench;
using harness::TrialOptions;
using harness::TrialSample;

}  // namespace parallax
