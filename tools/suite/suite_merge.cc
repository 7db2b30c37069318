#include "tools/suite/suite_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "compiler/base/codes/files.h"

namespace parallax::tools {
namespace {

struct Part {
  std::string folder;
  StoredResults results;
};

struct Parts {
  std::map<std::uint32_t, Part> by_index;  // of the shard
  std::vector<std::string> lost;           // folders without results
  std::set<std::string> removed;           // cases that a shard knows to be gone
};

base::Reported refused(const std::string& folder, const std::string& why,
                       base::DiagnosticSink& sink) {
  return sink.error_about(codes::kUsage, folder, "--merge: " + why);
}

/// The first name in one list of cases that the other lacks.
std::string only_in_one(const StoredCases& a, const StoredCases& b) {
  for (const auto& [name, one] : a) {
    if (!b.contains(name)) return name;
  }
  for (const auto& [name, one] : b) {
    if (!a.contains(name)) return name;
  }
  return {};
}

/// Finds shards that were run on different states of the cases and their files.
class RevisionCheck {
 public:
  /// Why the part has another revision than an earlier one; empty: it has not.
  std::string add(const Part& part) {
    for (const auto& [name, stored] : part.results.cases) {
      if (auto why = differs("the case " + name, stored.one.revision, part.folder); !why.empty()) {
        return why;
      }
      for (const auto& input : stored.result.inputs) {
        if (auto why = differs(input.path, input.sha256, part.folder); !why.empty()) return why;
      }
    }
    return {};
  }

 private:
  struct Seen {
    std::string content, folder;
  };

  std::string differs(const std::string& what, const std::string& content,
                      const std::string& folder) {
    const auto [at, is_new] = seen_.try_emplace(what, Seen{content, folder});
    if (is_new || at->second.content == content) return {};
    if (at->second.folder == folder) {
      return fmt::format("{} was changed while this shard ran", what);
    }
    return fmt::format("this and {} are of different revisions: {} is not the same",
                       at->second.folder, what);
  }

  std::map<std::string, Seen> seen_;
};

base::Result<Parts> read_parts(const std::vector<std::string>& folders,
                               base::DiagnosticSink& sink) {
  Parts out;
  auto& parts = out.by_index;
  RevisionCheck revisions;
  for (const auto& folder : folders) {
    base::DiagnosticSink unread;
    auto results = read_results(folder, unread);
    if (!results) {
      out.lost.push_back(folder);
      continue;
    }
    for (const auto& [name, stored] : results->cases) {
      // A shard that was killed has not told it.
      if (stored.result.outcome == Outcome::kRemoved) out.removed.insert(name);
    }
    out.removed.insert(results->removed.begin(), results->removed.end());
    std::erase_if(results->cases,
                  [](const auto& item) { return item.second.result.outcome == Outcome::kRemoved; });
    if (results->identity.program.empty()) {
      return refused(folder, "these results are of an older version; run the shard again", sink);
    }
    if (!parts.empty()) {
      const auto& first = parts.begin()->second;
      const auto other = difference(first.results.identity, results->identity);
      if (!other.empty()) {
        return refused(folder,
                       fmt::format("this and {} are of different suites: {}", first.folder, other),
                       sink);
      }
      if (first.results.identity.ledger != results->identity.ledger) {
        const bool is_other =
            !first.results.identity.ledger.empty() && !results->identity.ledger.empty();
        return refused(
            folder,
            fmt::format("this and {} are judged differently: {}", first.folder,
                        is_other ? "by other ledgers" : "one with --ledger and one without"),
            sink);
      }
      const auto name = only_in_one(first.results.cases, results->cases);
      if (!name.empty()) {
        return refused(folder,
                       fmt::format("this and {} are of different revisions: only one has the case "
                                   "{}",
                                   first.folder, name),
                       sink);
      }
    }
    const auto shard = results->identity.shard;
    Part part{folder, *std::move(results)};
    const auto why = revisions.add(part);
    const auto [at, is_new] = parts.try_emplace(shard.index, std::move(part));
    if (!is_new) {
      return refused(
          folder, fmt::format("this and {} both are shard {}", at->second.folder, to_string(shard)),
          sink);
    }
    if (!why.empty()) return refused(folder, why, sink);
  }
  if (!parts.empty()) return out;
  for (const auto& folder : folders) (void)read_results(folder, sink);
  return sink.already_reported();
}

/// The result of a case, of the shard it belongs to.
base::Result<CaseResult> result_of(const std::string& name, const SuiteCase& one,
                                   const Parts& parts, base::DiagnosticSink& sink) {
  CaseResult out;
  for (const auto& [index, part] : parts.by_index) {
    const auto& shard = part.results.identity.shard;
    const auto& result = part.results.cases.at(name).result;
    const bool has_it = result.outcome != Outcome::kSkipped;
    if (has_it == in_shard(one.id, shard)) {
      if (has_it) out = result;
      continue;
    }
    return refused(part.folder,
                   fmt::format("the case {} {} shard {}, but the results say it {}", name,
                               has_it ? "is not in" : "is in", to_string(shard),
                               has_it ? "was run there" : "was not"),
                   sink);
  }
  return out;
}

}  // namespace

base::Result<MergedSuite> merge_suites(const std::vector<std::string>& folders,
                                       base::DiagnosticSink& sink) {
  auto parts = read_parts(folders, sink);
  if (!parts) return sink.already_reported();
  const auto& first = parts->by_index.begin()->second.results;
  MergedSuite out;
  out.identity = first.identity;
  const auto count = first.identity.shard.count;
  out.identity.shard = {};
  out.lost = std::move(parts->lost);
  out.removed = std::move(parts->removed);
  for (std::uint32_t i = 1; i <= count; ++i) {
    if (!parts->by_index.contains(i)) out.missing.push_back({i, count});
  }
  for (const auto& [name, stored] : first.cases) out.cases.push_back(stored.one);
  std::sort(out.cases.begin(), out.cases.end(), [](const SuiteCase& a, const SuiteCase& b) {
    return std::tie(a.group, a.id) < std::tie(b.group, b.id);
  });
  for (const auto& one : out.cases) {
    auto result = result_of(one.name(), one, *parts, sink);
    if (!result) return sink.already_reported();
    for (const auto& shard : out.missing) {
      if (!in_shard(one.id, shard)) continue;
      result->problems = {fmt::format("not finished: shard {} is missing", to_string(shard))};
    }
    out.results.push_back(*std::move(result));
  }
  return out;
}

}  // namespace parallax::tools
