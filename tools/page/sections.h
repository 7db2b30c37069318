#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/page/page_data.h"

namespace parallax::tools {

// The parts of a page, each as HTML; empty where there is nothing to show. Everything that comes
// from a run folder is escaped here. Colours and sizes are those of assets/page.css: the page's
// Content-Security-Policy allows no style attributes.

/// Where lines of the embedded sources are in the page.
class SourceLinks {
 public:
  explicit SourceLinks(const PageData& page);
  /// "fetch.lisp:4" as a link to that line, or as plain text.
  std::string link(const std::string& place) const;
  /// The line with `around` ones before and behind it, coloured; empty if it is not embedded.
  std::string excerpt(const std::string& place, std::size_t around) const;
  /// The axioms that speak of the event "Go(r2)".
  const std::vector<PagePlace>& axioms_of(const std::string& event) const;
  /// All embedded texts.
  std::string section() const;

 private:
  struct Line {
    std::size_t file = 0, number = 0;
  };
  bool find(const std::string& place, Line& line) const;
  std::string line_html(const Line& line, bool with_id) const;

  const PageData& page_;
  std::vector<std::vector<std::string_view>> lines_;  // by file
  std::map<std::string, std::vector<PagePlace>> axioms_;
};

std::string verdict_section(const PageData& page);
/// The discrepancy of the headline: the first one that is not in doubt, or else the first. Null
/// where there is none.
const harness::ReportedDiscrepancy* told_discrepancy(const PageData& page);
/// Whether the discrepancy of the headline is in doubt.
bool is_in_doubt(const PageData& page);
/// The claims, each with its subject, those about the traces that decided the verdict first;
/// escaped.
std::vector<std::string> claims_of(const PageData& page);
/// "Trace 2", or "Executions" of a plan that was executed.
std::string stream_name(const PageData& page, const PageTrace& trace);
/// "`box.x` > 1.7 and ...", escaped.
std::string rule_html(const PageRule& rule);
std::string discrepancy_section(const PageData& page, const SourceLinks& links);
std::string timeline_section(const PageData& page);
std::string map_section(const PageData& page);
std::string scatter_section(const PageData& page);
/// Recorded motion, or how it is made; with what assets/replay.js reads.
std::string motion_section(const PageData& page);
/// The runs from each initial state and their results, where a trace has several.
std::string start_section(const PageData& page);
std::string confidence_section(const PageData& page);
std::string ledger_section(const PageData& page);
/// Results of the same run with another simulator.
std::string opinion_section(const PageData& page);
/// Proofs about starts.
std::string proof_section(const PageData& page);
std::string blame_section(const PageData& page, const SourceLinks& links);
std::string samples_section(const PageData& page);
std::string coverage_section(const PageData& page);
std::string traces_section(const PageData& page, const SourceLinks& links);
/// Data for the scripts: starts and ways of the simulations.
std::string data_block(const PageData& page);

/// The variables of the start that are plotted, by index, the decisive ones first.
struct PlottedVariables {
  std::vector<std::size_t> chosen;
  std::size_t left_out = 0;
  std::optional<std::int64_t> trace;  // of which the simulations are; none: of all
  std::vector<const PageSample*> samples;
};
PlottedVariables plotted_variables(const PageData& page);

/// `<section id="..">` with a heading around `body`.
std::string section_of(std::string_view id, std::string_view heading, std::string_view body);
/// A command in a box of its own.
std::string command_box(std::string_view command);
/// "clean" of "no-discrepancy", ...: the class of a word that says how something ended.
const char* verdict_class(std::string_view verdict);
/// "parallax replay DIR --sample 1.4"
std::string replay_words(const PageData& page, std::int64_t trace, std::int64_t sample);

}  // namespace parallax::tools
