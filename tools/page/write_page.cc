#include "tools/page/write_page.h"

#include <fmt/format.h>

#include "tools/page/assets.h"
#include "tools/page/csp_hash.h"
#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

struct Part {
  const char* id;
  const char* name;
  std::string html;
};

std::string navigation(const std::vector<Part>& parts) {
  std::string out = "<nav aria-label=\"Parts of the report\"><ul>\n";
  for (const auto& part : parts) {
    if (part.html.empty()) continue;
    out += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", part.id, part.name);
  }
  return out + "</ul></nav>\n\n";
}

}  // namespace

std::string html_document(const std::string& title, const std::string& body,
                          const DocumentOptions& options) {
  // A data block is no script to the policy: browsers never run it.
  std::vector<std::string_view> scripts = {kPageScript};
  if (options.has_many_dots) scripts.insert(scripts.begin(), kDotsScript);
  if (options.has_motion) {
    scripts.push_back(kThreeScript);
    scripts.push_back(kReplayScript);
  }
  std::string hashes, elements;
  for (const auto& script : scripts) {
    hashes += fmt::format("{}'{}'", hashes.empty() ? "" : " ", csp_hash(script));
    elements += "<script>" + std::string(script) + "</script>\n";
  }
  const auto policy = fmt::format(
      "default-src 'none'; style-src '{}'{}; script-src {}; base-uri 'none'; form-action 'none'",
      csp_hash(kPageStyle), options.style.empty() ? "" : " '" + csp_hash(options.style) + "'",
      hashes);
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  out += kPageMark;
  out += '\n';
  out += "<meta http-equiv=\"Content-Security-Policy\" content=\"" + policy + "\">\n";
  out +=
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<meta name=\"referrer\" content=\"no-referrer\">\n";
  if (options.reload_s > 0) {
    out += fmt::format("<meta http-equiv=\"refresh\" content=\"{}\">\n", options.reload_s);
  }
  out += "<title>" + html_short(title) + "</title>\n<style>" + std::string(kPageStyle) +
         "</style>\n" + (options.style.empty() ? "" : "<style>" + options.style + "</style>\n") +
         "</head>\n<body>\n<a class=\"skip\" href=\"#main\">Skip to the report</a>\n";
  return out + body + elements + "</body>\n</html>\n";
}

std::string run_page(const PageData& page, const DocumentOptions& options) {
  const SourceLinks links(page);
  // In the order of a reader's questions: what, where, how it looked, from which starts, how sure,
  // why.
  const std::vector<Part> parts = {
      {"discrepancy", "Where they part", discrepancy_section(page, links)},
      {"opinion", "Second opinion", opinion_section(page)},
      {"ledger", "Ledger", ledger_section(page)},
      {"timeline", "Timeline", timeline_section(page)},
      {"motion", "Motion", motion_section(page)},
      {"map", "Map of starts", map_section(page)},
      {"starts", "Start variables", scatter_section(page)},
      {"states", "Initial states", start_section(page)},
      {"confidence", "Confidence", confidence_section(page)},
      {"proof", "Proofs about starts", proof_section(page)},
      {"blame", "Why, and repairs", blame_section(page, links)},
      {"samples", "Simulations", samples_section(page)},
      {"coverage", "Coverage", coverage_section(page)},
      {"traces", "Traces", traces_section(page, links)},
      {"sources", "Sources", links.section()},
  };
  auto body = verdict_section(page) + navigation(parts) + "<main id=\"main\">\n";
  for (const auto& part : parts) body += part.html;
  body +=
      "</main>\n<footer><p>Made by parallax " + html_short(page.tool_version) +
      " from what the run recorded; nothing was simulated again." +
      (page.motion.empty() ? "" : " Motion is drawn with three.js (MIT licence, in the page).") +
      "</p></footer>\n";
  body += data_block(page);
  const auto& name = page.scenario.empty() ? page.folder : page.scenario;
  auto own = options;
  own.has_many_dots = page.samples.size() > kMostDots;
  own.has_motion = !page.motion.empty();
  return html_document("parallax: " + name, body, own);
}

}  // namespace parallax::tools
