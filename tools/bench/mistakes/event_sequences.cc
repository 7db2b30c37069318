#include "tools/bench/mistakes/event_sequences.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>

namespace parallax::tools {
namespace {

constexpr int kTries = 4;  // events that are tried before a walk waits

/// Ground events that no axiom demands, by name.
std::map<std::string, std::vector<std::string>> performed_events(const ModelText& model) {
  const auto declared = read_declarations(model.declarations);
  const auto demanded = demanded_events(model);
  std::map<std::string, std::vector<std::string>> out;
  for (const auto& [name, sorts] : declared.events) {
    if (demanded.count(name) != 0) continue;
    std::vector<TermText> terms = {{name, {}}};
    for (const auto& sort : sorts) {
      std::vector<TermText> longer;
      for (const auto& term : terms) {
        for (const auto& constant : declared.constants.at(sort)) {
          longer.push_back(term);
          longer.back().arguments.push_back(constant);
        }
      }
      terms = std::move(longer);
    }
    for (const auto& term : terms) out[name].push_back(term.to_text());
  }
  return out;
}

}  // namespace

std::string sequences_model(const std::vector<std::string>& files,
                            const std::vector<EventSequence>& sequences) {
  std::string text, names;
  for (const auto& file : files) text += "load " + file + "\n";
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    names += (i == 0 ? "q" : ", q") + std::to_string(i);
  }
  text += "sort sequence\nsequence " + names + "\nfluent Sequence(sequence)\n";
  text += "{sequence} HoldsAt(Sequence(sequence),0).\n";
  text += "[sequence1,sequence2] HoldsAt(Sequence(sequence1),0) & HoldsAt(Sequence(sequence2),0) ";
  text += "-> sequence1=sequence2.\n";
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    for (std::size_t t = 0; t < sequences[i].size(); ++t) {
      text += "HoldsAt(Sequence(q" + std::to_string(i) + "),0) -> Happens(" + sequences[i][t] +
              "," + std::to_string(t) + ").\n";
    }
  }
  return text + "completion Happens\n";
}

int horizon_of(const std::vector<EventSequence>& sequences) {
  std::size_t longest = 1;
  for (const auto& sequence : sequences) longest = std::max(longest, sequence.size());
  return static_cast<int>(longest);
}

std::vector<EventSequence> random_sequences(const ModelText& model, std::size_t walks,
                                            std::size_t length, std::uint64_t seed,
                                            const AreExecutable& are_executable) {
  const auto events = performed_events(model);
  std::mt19937_64 generator(seed);
  const auto drawn = [&](std::size_t count) { return generator() % count; };
  std::vector<EventSequence> going(walks), refused;
  for (std::size_t step = 0; step < length; ++step) {
    std::vector<bool> done(walks, false);
    for (int attempt = 0; attempt < kTries; ++attempt) {
      auto tried = going;
      for (std::size_t i = 0; i < walks; ++i) {
        auto name = events.begin();
        std::advance(name, static_cast<std::ptrdiff_t>(drawn(events.size())));
        const auto& event = name->second[drawn(name->second.size())];
        if (!done[i]) tried[i].push_back(event);
      }
      const auto executable = are_executable(tried);
      for (std::size_t i = 0; i < walks; ++i) {
        if (done[i]) continue;
        done[i] = executable[i];
        if (executable[i]) {
          going[i] = tried[i];
        } else if (refused.size() < walks) {
          refused.push_back(tried[i]);
        }
      }
    }
  }
  going.insert(going.end(), refused.begin(), refused.end());
  return going;
}

}  // namespace parallax::tools
