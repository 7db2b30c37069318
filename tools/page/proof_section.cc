#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/words.h"
#include "harness/confidence/rounding.h"
#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

constexpr double kMapSide = 300.0, kMapLeft = 56.0, kMapBottom = 40.0, kMapPad = 12.0;
constexpr std::size_t kMostActions = 100, kMostAssumed = 100;

/// "42.4 %": rounded so that no more is claimed than is proved.
std::string proved_text(double share) { return harness::percent_down(share); }
std::string open_text(double share) { return harness::percent_up(share); }

std::string bar(const PageProofTest& test) {
  std::string out = fmt::format(
      "<svg class=\"shares\" viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" role=\"img\" "
      "aria-label=\"safe {}, refuted {}, open {}\">",
      proved_text(test.safe), proved_text(test.refuted), open_text(test.open));
  double at = 0.0;
  for (const auto& [name, share] : {std::pair{"safe", test.safe},
                                    {"refuted", test.refuted},
                                    {"open", std::max(0.0, 1.0 - test.safe - test.refuted)}}) {
    out += fmt::format("<rect class=\"{}\" x=\"{:.3f}\" y=\"0\" width=\"{:.3f}\" height=\"10\"/>",
                       name, 100.0 * at, 100.0 * share);
    at += share;
  }
  return out + "</svg>";
}

std::string action_rows(const PageProofAction& action) {
  std::string out;
  for (const auto& test : action.tests) {
    out += fmt::format(
        "<tr><th scope=\"row\"><code>{}</code></th><td data-label=\"Test\">{}<br><code>{}</code> "
        "in <code>{}</code></td><td data-label=\"Share of the starts\">{}</td><td "
        "class=\"num\" data-label=\"Safe\">{}</td><td class=\"num\" "
        "data-label=\"Refuted\">{}</td><td "
        "class=\"num\" data-label=\"Open\">{}</td></tr>\n",
        html_short(action.event), html_short(test.asks), html_short(test.function),
        html_short(test.source), bar(test), proved_text(test.safe), proved_text(test.refuted),
        open_text(test.open));
  }
  if (!action.left_to_simulation.empty() || action.tests.empty()) {
    out += fmt::format(
        "<tr class=\"follows\"><th scope=\"row\"><code>{}</code></th><td colspan=\"5\">left to "
        "simulation: {}</td></tr>\n",
        html_short(action.event), html_short(action.left_to_simulation));
  }
  return out;
}

std::string rect(std::string_view classes, const PlotAxis& x, const PlotAxis& y,
                 const PageProofPart& part, double opacity) {
  const double left = x.at(part.x[0]), top = y.at(part.y[1]);
  return fmt::format(
      "<rect class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"{}/>",
      classes, left, top, x.at(part.x[1]) - left, y.at(part.y[0]) - top,
      opacity < 1.0 ? fmt::format(" fill-opacity=\"{:.2f}\"", opacity) : "");
}

/// Shares to steps of a twentieth, so that cells of a row that look alike become one.
std::vector<PageProofPart> joined_parts(const PageProofMap& map) {
  std::vector<PageProofPart> out;
  for (PageProofPart part : map.parts) {
    const auto coarse = [](double share) {
      return std::round(20.0 * std::clamp(share, 0.0, 1.0)) / 20.0;
    };
    part.safe = coarse(part.safe), part.refuted = coarse(part.refuted);
    if (!map.is_exact && !out.empty()) {
      auto& last = out.back();
      if (last.y == part.y && last.x[1] <= part.x[0] && last.safe == part.safe &&
          last.refuted == part.refuted) {
        last.x[1] = part.x[1];
        continue;
      }
    }
    out.push_back(part);
  }
  return out;
}

std::string map_axes(const PageProofMap& map, const PlotAxis& x, const PlotAxis& y) {
  std::string out = "<g class=\"axis\">";
  for (const double value : ticks(x.low, x.high, 4)) {
    out += line(x.at(value), y.from, x.at(value), y.from + 4, "tick") +
           label(x.at(value), y.from + 16, "middle", number(value, 4));
  }
  for (const double value : ticks(y.low, y.high, 4)) {
    out += line(x.from - 4, y.at(value), x.from, y.at(value), "tick") +
           label(x.from - 6, y.at(value) + 4, "end", number(value, 4));
  }
  out += label(0.5 * (x.from + x.to), kMapSide - 6, "middle name", html_short(map.x_name)) +
         label(4, 14, "name", html_short(map.y_name));
  return out + "</g>\n";
}

/// Where simulations of the trace began.
std::string map_dots(const PageData& page, const PageProof& proof, const PageProofMap& map,
                     const PlotAxis& x, const PlotAxis& y) {
  const auto column_of = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(page.variables.begin(), page.variables.end(), name) -
                                    page.variables.begin());
  };
  const auto u = column_of(map.x_name), v = column_of(map.y_name);
  if (std::max(u, v) >= page.variables.size()) return {};
  std::vector<const PageSample*> samples;
  for (const auto& sample : page.samples) {
    const bool is_of = sample.trace == proof.trace && sample.began_in(proof.initial_state);
    if (is_of && sample.origin == SampleOrigin::kDrawn) samples.push_back(&sample);
  }
  std::string out;
  const auto shown = dotted(samples);
  for (const auto verdict : {PageVerdict::kClean, PageVerdict::kNotJudged, PageVerdict::kLost,
                             PageVerdict::kDiscrepancy}) {
    DotPath dots;
    for (const auto* sample : shown) {
      const double a = sample->start[u], b = sample->start[v];
      const bool inside = a >= map.x[0] && a <= map.x[1] && b >= map.y[0] && b <= map.y[1];
      if (sample->verdict == verdict && inside) dots.add(x.at(a), y.at(b));
    }
    out += dots.element(dot_class(verdict, false));
  }
  return out;
}

std::string map_svg(const PageData& page, const PageProof& proof, const PageProofMap& map) {
  const PlotAxis x{map.x[0], map.x[1], kMapLeft, kMapSide - kMapPad};
  const PlotAxis y{map.y[0], map.y[1], kMapSide - kMapBottom, kMapPad + 14};
  const PageProofPart whole{map.x, map.y, 0.0, 0.0};
  auto out = fmt::format(
      "<svg class=\"plot proof-map\" viewBox=\"0 0 {0} {0}\" role=\"img\" aria-label=\"Safe, "
      "refuted and open over {1} and {2}\">\n<g class=\"proved\">{3}\n",
      px(kMapSide), html_short(map.x_name), html_short(map.y_name), rect("open", x, y, whole, 1.0));
  for (const auto& part : joined_parts(map)) {
    // The second colour is drawn over the first one: the opacities are chosen so that both shares
    // show.
    const double rest = 1.0 - part.refuted;
    const char* edge = map.is_exact ? " box" : "";
    if (part.safe > 0.0 && rest > 0.0) {
      out += rect(std::string("safe") + edge, x, y, part, part.safe / rest);
    }
    if (part.refuted > 0.0) out += rect(std::string("refuted") + edge, x, y, part, part.refuted);
  }
  return out + "</g>\n" + map_dots(page, proof, map, x, y) + map_axes(map, x, y) + "</svg>\n";
}

std::string began_text(const PageProofTest& test) {
  std::string out;
  std::int64_t all = 0;
  const char* names[] = {"safe", "refuted", "open"};
  for (std::size_t i = 0; i < test.began.size(); ++i) {
    const auto& began = test.began[i];
    all += began.simulations;
    if (began.simulations == 0) continue;
    out += fmt::format("{}{} from {} boxes, of which {} {} not clean", out.empty() ? "" : "; ",
                       began.simulations, names[i], began.not_clean,
                       base::agreed(began.not_clean, "was", "were"));
  }
  return all == 0 ? "" : fmt::format("Dots are simulations of drawn starts: {}.", out);
}

/// The map of a test with the starts of simulations; empty for a test that is the same everywhere.
std::string test_figure(const PageData& page, const PageProof& proof, const PageProofAction& action,
                        const PageProofTest& test) {
  if (!test.map) return {};
  const auto words = test.map->is_exact
                         ? "The boxes of the proof"
                         : "Over the two variables that it depends on most; what is pale or mixed "
                           "depends on others, too";
  return fmt::format("<figure><figcaption><code>{}</code>, {}. {}. {}</figcaption>{}</figure>\n",
                     html_short(action.event), html_short(test.function), words, began_text(test),
                     map_svg(page, proof, *test.map));
}

/// The assumptions of all tests, each once.
std::string assumed_list(const PageProof& proof) {
  std::vector<std::string_view> all;
  for (const auto& action : proof.actions) {
    for (const auto& test : action.tests) {
      for (const std::string_view what : test.assumed) {
        if (all.size() < kMostAssumed && std::find(all.begin(), all.end(), what) == all.end()) {
          all.push_back(what);
        }
      }
    }
  }
  std::string out;
  for (const auto what : all) out += "<li>" + html_words(what) + "</li>\n";
  return out.empty() ? out
                     : "<details><summary>What is taken for granted of the actions before a "
                       "test</summary><ul>\n" +
                           out + "</ul></details>\n";
}

std::string proof_html(const PageData& page, const PageProof& proof) {
  std::string rows, figures;
  for (std::size_t i = 0; i < proof.actions.size() && i < kMostActions; ++i) {
    rows += action_rows(proof.actions[i]);
    for (const auto& test : proof.actions[i].tests) {
      figures += test_figure(page, proof, proof.actions[i], test);
    }
  }
  const auto from =
      proof.initial_state == 0
          ? std::string()
          : fmt::format(", initial state {}: {}", proof.initial_state, html_words(proof.holds));
  auto out = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Proofs of trace {0}\">"
      "<table class=\"flow\"><caption>Trace {0}{3}{1}</caption><thead><tr><th "
      "scope=\"col\">Action</th><th scope=\"col\">Test of its controller</th><th "
      "scope=\"col\">Share of the starts</th><th "
      "scope=\"col\">Safe</th><th scope=\"col\">Refuted</th><th scope=\"col\">Open</th></tr>"
      "</thead><tbody>\n{2}</tbody></table></div>\n",
      proof.trace, proof.stopped ? " (the search was stopped early)" : "", rows, from);
  if (proof.actions.size() > kMostActions) {
    out += fmt::format("<p>{} further actions are left out.</p>\n",
                       proof.actions.size() - kMostActions);
  }
  if (!figures.empty()) out += "<div class=\"panels proofs\">\n" + figures + "</div>\n";
  return out + assumed_list(proof) + "<p>Shares are those of the boxes in <code>" +
         html_short(proof.file) + "</code>, which this page has not confirmed; this does:</p>\n" +
         command_box(proof.check);
}

}  // namespace

std::string proof_section(const PageData& page) {
  if (page.proofs.empty()) return {};
  std::string out =
      "<p>Tests of controllers that are geometry and nothing else, decided for whole boxes of "
      "starts: where such a test passes throughout <span class=\"legend\">(<span class=\"mark "
      "safe\"></span>safe)</span>, where the controller refuses throughout <span "
      "class=\"legend\">(<span class=\"mark "
      "refuted\"></span>refuted)</span>, and what is left to simulation <span "
      "class=\"legend\">(<span class=\"mark undecided\"></span>open)</span>. From a safe start "
      "another part of the action may still fail.</p>\n";
  for (const auto& proof : page.proofs) out += proof_html(page, proof);
  return section_of("proof", "Proofs about starts", out);
}

}  // namespace parallax::tools
