// Compiles a scenario with its plan, and simulates and judges one sample of each of its traces.

#include <cstdio>
#include <memory>

#include "parallax/judge.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: example SCENARIO.yaml\n", stderr), 2;
  parallax::Context context;
  const auto fail = [&] { return std::fputs(parallax::reports(context).c_str(), stderr), 3; };

  const auto loaded = parallax::load_scenario_model(argv[1], context);
  if (!loaded) return fail();
  const auto& model = loaded->compilation.model;
  std::printf("%d variables, horizon %d\n", model.variable_count(), model.horizon);

  parallax::EnumeratedTraces traces(model, context);
  const auto engine = [&] {
    return std::make_unique<parallax::OdeSimulator>(loaded->scenario.world);
  };
  parallax::TrialBench bench(
      loaded->scenario, traces, engine, {.seed = 1}, [](const auto&) {}, context.sink());
  if (!bench.start()) return fail();
  while (true) {
    const auto trace = traces.next();
    if (!trace) return fail();
    if (!*trace) break;
    std::printf("trace %d:", static_cast<int>((*trace)->number));
    for (std::size_t t = 0; t < (*trace)->event_count(); ++t) {
      std::printf(" %s", (*trace)->event(t).c_str());
    }

    auto trial = parallax::Trial::prepare(bench, **trace);
    if (!trial) return fail();
    const auto sample = trial->next();
    if (!sample || !*sample) return fail();
    const bool met = (*sample)->verdict == parallax::SampleVerdict::kAsPredicted;
    std::printf("\n  %s\n", met ? "ends as predicted" : "does not end as predicted");
    for (const auto& fluent : (*sample)->judgement.last) {
      std::printf("  %s: predicted %s\n", fluent.fluent.c_str(), fluent.predicted ? "yes" : "no");
    }
    trial->end();
  }
  std::printf("%s\n", traces.exploration().c_str());
  return 0;
}
