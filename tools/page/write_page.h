#pragma once

#include <string>
#include <vector>

#include "tools/page/page_data.h"

namespace parallax::tools {

/// Marks a page, so that an earlier one is recognized.
inline constexpr const char* kPageMark = "<meta name=\"generator\" content=\"parallax report\">";

struct DocumentOptions {
  int reload_s = 0;            // the page reloads itself after this time; 0: never
  bool has_many_dots = false;  // plots need the script that draws on a canvas
  bool has_motion = false;     // there is something to be drawn with WebGL
  std::string style = {};      // beside that of all pages; not from a run folder
};

/// The page of one run folder, as one HTML file: no network, readable without scripts, and no text
/// of a run folder is taken as markup.
std::string run_page(const PageData& page, const DocumentOptions& options = {});

/// Comparison of several runs: verdicts, rates with intervals, traces that only some of them have.
/// The others are compared with the first one. `changes`: for each but the first the lines that say
/// what changed in its scenario; empty: nothing, or not known.
std::string comparison_page(const std::vector<PageData>& pages,
                            const std::vector<std::string>& changes = {});

/// The document around a body: style and script inline, allowed by their hashes alone.
std::string html_document(const std::string& title, const std::string& body,
                          const DocumentOptions& options = {});

}  // namespace parallax::tools
