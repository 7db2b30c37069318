#include "runtime/graph/trace_sampler.h"

#include <algorithm>
#include <map>
#include <random>

namespace parallax::runtime {
namespace {

/// A number below `bound`, which is positive: bits are drawn until they are below it.
mpz_class draw_below(const mpz_class& bound, std::mt19937_64& random) {
  const auto bits = mpz_sizeinbase(bound.get_mpz_t(), 2);
  while (true) {
    mpz_class number = 0;
    for (std::size_t have = 0; have < bits; have += 32) {
      number <<= 32;
      number += static_cast<unsigned long>(random() >> 32U);
    }
    number >>= (32 - bits % 32) % 32;
    if (number < bound) return number;
  }
}

}  // namespace

TraceSample sample_traces(const CompiledModel& model, const TraceQuery& query, std::size_t size,
                          std::uint64_t seed) {
  TraceSample sample;
  const auto counted = count_traces(model, query);
  sample.population = counted.count;
  sample.complete = counted.complete;
  sample.stats = counted.stats;
  sample.refusal = counted.refusal;
  if (!counted.complete || counted.count == 0) return sample;
  std::mt19937_64 random(seed);
  std::multimap<mpz_class, std::size_t> draws;  // by the number of traces before
  for (std::size_t i = 0; i < size; ++i) draws.emplace(draw_below(counted.count, random), i);
  sample.traces.resize(size);
  ModelTraces traces(model, query);
  std::optional<Trace> last;
  mpz_class next = 0;  // how many traces come before the one that is next
  for (const auto& [before, place] : draws) {
    if (!last || before >= next) {
      traces.seek(before);
      last = traces.next();
      next = before + 1;
    }
    if (!last) {
      sample.complete = false;
      sample.traces.clear();
      return sample;
    }
    sample.traces[place] = *last;
    sample.traces[place].number = static_cast<std::int64_t>(place) + 1;
  }
  return sample;
}

}  // namespace parallax::runtime
