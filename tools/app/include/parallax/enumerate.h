#pragma once

// The traces of a compiled model, in canonical order.
//
//     parallax::ModelTraces traces(model, {});            // of a model without a plan
//     while (const auto trace = traces.next()) std::puts(parallax::to_text(*trace).c_str());
//
//     parallax::EnumeratedTraces traces(model, context);  // of one with a plan or constraints, in
//     auto trace = traces.next();                         // the form that a simulation takes

#include "parallax/compile.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/model_traces.h"
#include "runtime/graph/trace_count.h"
#include "runtime/trace/trace.h"
#include "tools/app/trace_feed.h"

namespace parallax {

using runtime::count_traces;
using runtime::ModelTraces;
using runtime::to_jsonl;
using runtime::to_text;
using runtime::Trace;
using runtime::TraceQuery;

using harness::CampaignTrace;
using harness::TraceFeed;

using tools::EnumeratedTraces;

}  // namespace parallax
