#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "compiler/base/file_io.h"
#include "harness/geometry_proof/certificate.h"
#include "harness/report/text_layout.h"
#include "tools/app/recorded_run.h"
#include "tools/page/gather.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using harness::BoxVerdict;

constexpr std::string_view kProofEnding = ".proof.json";
constexpr std::size_t kMostProofs = 20;
constexpr std::size_t kBins = 24;        // of a variable, where boxes are told by shares
constexpr std::size_t kMostParts = 600;  // of a map that are boxes of the proof
/// Limit on simulations times boxes, for counting starts in boxes.
constexpr std::size_t kMostLookUps = 40'000'000;

std::vector<std::string> proof_files(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    auto name = at->path().filename().string();
    if (name.ends_with(kProofEnding)) out.push_back(std::move(name));
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Bins [first, last) of a range that an interval touches, and the share of the interval in each.
struct BinRange {
  BinRange(const harness::Bounds1& part, const harness::Bounds1& whole) {
    const double scale = static_cast<double>(kBins) / (whole.upper - whole.lower);
    low = std::clamp((part.lower - whole.lower) * scale, 0.0, double{kBins});
    high = std::clamp((part.upper - whole.lower) * scale, low, double{kBins});
    first = std::min(kBins - 1, static_cast<std::size_t>(low));
    last = std::max(first + 1, static_cast<std::size_t>(std::ceil(high)));
  }
  /// Share of the interval that lies in the bin.
  double share(std::size_t bin) const {
    const auto begin = static_cast<double>(bin);
    const double both = std::min(high, begin + 1.0) - std::max(low, begin);
    return high > low ? std::max(0.0, both) / (high - low) : 1.0;
  }
  double low = 0.0, high = 0.0;
  std::size_t first = 0, last = 0;
};

double part_of_region(const harness::StartBox& box, const harness::StartBox& region) {
  double share = 1.0;
  for (std::size_t i = 0; i < box.size(); ++i) {
    share *= (box[i].upper - box[i].lower) / (region[i].upper - region[i].lower);
  }
  return share;
}

/// Sum of the differences between the shares along a variable and those of the whole region.
double sway_of(const harness::TestCertificate& test, const harness::StartBox& region,
               std::size_t axis) {
  std::array<double, kBins> safe{}, refuted{};
  for (const auto& box : test.boxes) {
    if (box.verdict == BoxVerdict::kOpen) continue;
    const BinRange bins(box.bounds[axis], region[axis]);
    auto& shares = box.verdict == BoxVerdict::kSafe ? safe : refuted;
    const double all = part_of_region(box.bounds, region);
    for (std::size_t bin = bins.first; bin < bins.last; ++bin) shares[bin] += all * bins.share(bin);
  }
  double sway = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    sway += std::abs(safe[bin] - test.safe / kBins) + std::abs(refuted[bin] - test.refuted / kBins);
  }
  return sway;
}

bool is_uncut(const harness::TestCertificate& test, const harness::StartBox& region,
              std::size_t axis) {
  return std::all_of(test.boxes.begin(), test.boxes.end(), [&](const auto& box) {
    return box.bounds[axis].lower == region[axis].lower &&
           box.bounds[axis].upper == region[axis].upper;
  });
}

std::vector<PageProofPart> grid_of(const harness::TestCertificate& test,
                                   const harness::StartBox& region, std::size_t u, std::size_t v) {
  std::vector<PageProofPart> cells(kBins * kBins);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto edges = [&](std::size_t axis, std::size_t bin) {
      const double width = (region[axis].upper - region[axis].lower) / kBins;
      const double low = region[axis].lower + static_cast<double>(bin) * width;
      return std::array<double, 2>{low, low + width};
    };
    cells[i].x = edges(u, i % kBins);
    cells[i].y = edges(v, i / kBins);
  }
  for (const auto& box : test.boxes) {
    if (box.verdict == BoxVerdict::kOpen) continue;
    const BinRange across(box.bounds[u], region[u]), up(box.bounds[v], region[v]);
    const double all = part_of_region(box.bounds, region) * kBins * kBins;
    for (std::size_t b = up.first; b < up.last; ++b) {
      for (std::size_t a = across.first; a < across.last; ++a) {
        auto& cell = cells[b * kBins + a];
        (box.verdict == BoxVerdict::kSafe ? cell.safe : cell.refuted) +=
            all * across.share(a) * up.share(b);
      }
    }
  }
  return cells;
}

std::optional<PageProofMap> map_of(const harness::GeometryCertificate& certificate,
                                   const harness::TestCertificate& test) {
  const auto& region = certificate.region;
  if (region.size() < 2 || std::max({test.safe, test.refuted, test.open}) > 1.0 - 1e-9) {
    return std::nullopt;
  }
  std::vector<std::pair<double, std::size_t>> sways;
  for (std::size_t i = 0; i < region.size(); ++i) {
    sways.emplace_back(-sway_of(test, region, i), i);
  }
  std::sort(sways.begin(), sways.end());
  if (sways.front().first == 0.0) return std::nullopt;  // it is open from everywhere alike
  const std::size_t u = std::min(sways[0].second, sways[1].second);
  const std::size_t v = std::max(sways[0].second, sways[1].second);
  PageProofMap map;
  map.x_name = certificate.variables[u];
  map.y_name = certificate.variables[v];
  map.x = {region[u].lower, region[u].upper};
  map.y = {region[v].lower, region[v].upper};
  map.is_exact = test.boxes.size() <= kMostParts;
  for (std::size_t i = 0; i < region.size() && map.is_exact; ++i) {
    map.is_exact = i == u || i == v || is_uncut(test, region, i);
  }
  if (!map.is_exact) {
    map.parts = grid_of(test, region, u, v);
    return map;
  }
  for (const auto& box : test.boxes) {
    map.parts.push_back({{box.bounds[u].lower, box.bounds[u].upper},
                         {box.bounds[v].lower, box.bounds[v].upper},
                         box.verdict == BoxVerdict::kSafe ? 1.0 : 0.0,
                         box.verdict == BoxVerdict::kRefuted ? 1.0 : 0.0});
  }
  return map;
}

/// Counts starts by verdict of their box; none where a variable of the proof is not on record.
void count_starts(const harness::GeometryCertificate& certificate,
                  const harness::TestCertificate& test, const PageData& page, PageProofTest& out) {
  std::vector<std::size_t> columns;
  for (const auto& name : certificate.variables) {
    const auto found = std::find(page.variables.begin(), page.variables.end(), name);
    if (found == page.variables.end()) return;
    columns.push_back(static_cast<std::size_t>(found - page.variables.begin()));
  }
  if (page.closed_loop || page.samples.size() * test.boxes.size() > kMostLookUps) return;
  for (const auto& sample : page.samples) {
    if (sample.trace != certificate.trace || !sample.began_in(certificate.initial_state) ||
        sample.origin != SampleOrigin::kDrawn || sample.verdict == PageVerdict::kNotJudged) {
      continue;
    }
    std::vector<double> start;
    for (const auto column : columns) start.push_back(sample.start[column]);
    const auto* box = harness::box_of(test.boxes, start);
    if (box == nullptr) continue;
    auto& began = out.began[static_cast<std::size_t>(box->verdict)];
    ++began.simulations;
    began.not_clean += sample.verdict == PageVerdict::kClean ? 0 : 1;
  }
}

/// Why the certificate is not about this run; empty: it is.
std::string misfit_of(const harness::GeometryCertificate& certificate,
                      const harness::JournalHeader& header, const PageData& page) {
  if (certificate.scenario_hash != header.scenario_hash) {
    return "it is of another scenario, or of one that was changed since";
  }
  for (const auto& trace : page.traces) {
    if (page.closed_loop || trace.number != certificate.trace) continue;
    for (const auto& action : certificate.actions) {
      if (action.number >= trace.steps.size() || trace.steps[action.number].event != action.event) {
        return fmt::format("its trace {} is not that of the run", certificate.trace);
      }
    }
  }
  for (const auto& action : certificate.actions) {
    for (const auto& test : action.tests) {
      if (!harness::fill(test.boxes, certificate.region)) {
        return fmt::format("the boxes of {} do not fill the start region", action.event);
      }
    }
  }
  return {};
}

PageProof proof_of(const harness::GeometryCertificate& certificate, const PageData& page) {
  PageProof out;
  out.trace = certificate.trace;
  out.initial_state = certificate.initial_state;
  out.holds = certificate.holds;
  out.stopped = certificate.stopped;
  for (const auto& action : certificate.actions) {
    auto& shown = out.actions.emplace_back();
    shown.event = action.event;
    shown.left_to_simulation = action.left_to_simulation;
    for (const auto& test : action.tests) {
      PageProofTest one{test.test.function,
                        test.test.source,
                        test.test.statement,
                        test.assumed,
                        test.safe,
                        test.refuted,
                        test.open,
                        {},
                        {}};
      one.map = map_of(certificate, test);
      count_starts(certificate, test, page, one);
      shown.tests.push_back(std::move(one));
    }
  }
  return out;
}

}  // namespace

void add_proofs(const PageOptions& options, const harness::JournalHeader& header, PageData& page) {
  auto files = proof_files(page.folder);
  if (files.size() > kMostProofs) {
    page.banners.push_back(fmt::format("Of {} proofs in the folder the first {} are shown.",
                                       files.size(), kMostProofs));
    files.resize(kMostProofs);
  }
  for (const auto& name : files) {
    const auto refuse = [&](const std::string& why) {
      page.banners.push_back(fmt::format("The proof {} is not shown: {}.", name, why));
    };
    Context own;
    const auto text = base::read_file_of(page.folder, name, own.sink());
    if (!text) {
      refuse("it cannot be read; " + messages_of(own));
      continue;
    }
    harness::GeometryCertificate certificate;
    if (const auto fault = harness::read_certificate(*text, certificate)) {
      refuse(*fault);
      continue;
    }
    if (const auto misfit = misfit_of(certificate, header, page); !misfit.empty()) {
      refuse(misfit);
      continue;
    }
    auto proof = proof_of(certificate, page);
    proof.file = name;
    const auto scenario =
        options.scenario.empty() ? scenario_path(header).string() : options.scenario;
    proof.check = fmt::format("parallax prove {} --check {}", harness::shell_word(scenario),
                              harness::shell_word((fs::path(page.folder) / name).string()));
    page.proofs.push_back(std::move(proof));
  }
}

}  // namespace parallax::tools
