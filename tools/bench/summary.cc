// Summary of a section: geometric means over its rows.

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "tools/bench/measure.h"

namespace parallax::tools {
namespace {

/// One program against ours.
struct Peer {
  double sum_of_logs = 0.0;
  int rows = 0;
  int without_end = 0;  // rows that ours ended and it did not
  double least = 0.0;
  std::string least_row;

  void add(double ratio, const std::string& row) {
    sum_of_logs += std::log(ratio);
    if (rows++ == 0 || ratio < least) {
      least = ratio;
      least_row = row;
    }
  }
};

constexpr std::string_view kConfigured = "clingo, ";

void add_row(const Row& row, std::map<std::string, Peer>& peers) {
  std::optional<double> best;
  int configurations = 0;
  for (std::size_t i = 1; i < row.sides.size(); ++i) {
    const auto& side = row.sides[i];
    const auto ratio = row.ratio(i);
    auto& peer = peers[side.program];
    if (ratio) {
      peer.add(*ratio, row.name);
    } else if (row.sides[0].cost && side.remark.starts_with("no end")) {
      ++peer.without_end;
    }
    if (!side.program.starts_with(kConfigured)) continue;
    ++configurations;
    if (ratio && (!best || *ratio < *best)) best = ratio;
  }
  if (configurations < 2) return;
  auto& peer = peers["best of clingo's"];
  if (best) {
    peer.add(*best, row.name);
  } else if (row.sides[0].cost) {
    ++peer.without_end;
  }
}

}  // namespace

std::string summary_text(const std::vector<Row>& rows) {
  std::map<std::string, Peer> peers;
  for (const auto& row : rows) add_row(row, peers);
  std::string text;
  for (const auto& [program, peer] : peers) {
    if (peer.rows + peer.without_end < 2) continue;
    text += fmt::format("  {:<26}{:<17}", text.empty() ? "geometric mean" : "", program);
    if (peer.rows > 0) {
      text += fmt::format("{:.2f} x ours in {} rows, least {:.2f}: {}",
                          std::exp(peer.sum_of_logs / peer.rows), peer.rows, peer.least,
                          peer.least_row);
    }
    if (peer.without_end > 0) {
      text += fmt::format("{}no end in {}", peer.rows > 0 ? "; " : "", peer.without_end);
    }
    text += '\n';
  }
  return text;
}

}  // namespace parallax::tools
