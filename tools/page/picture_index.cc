#include "tools/page/picture_index.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/page/markup.h"
#include "tools/page/sections.h"
#include "tools/page/write_page.h"

namespace parallax::tools {
namespace {

std::string picture_figure(const PictureStep& step, bool with_link) {
  return fmt::format(
      "<figure class=\"picture\"><div class=\"view\" tabindex=\"0\" role=\"group\" "
      "aria-label=\"{}\">{}</div><figcaption>{}</figcaption></figure>\n",
      html_short(step.title), step.svg,
      with_link ? fmt::format("<a href=\"{0}\">{0}</a>", html_short(step.file))
                : html_short(step.title));
}

std::string event_rows(const PictureIndex& index) {
  std::string out =
      "<div class=\"scroll\"><table><thead><tr><th>picture</th><th>what was done</th><th>line of "
      "the plan</th><th>how it ended</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < index.steps.size(); ++i) {
    const auto& step = index.steps[i];
    const auto how = step.warns
                         ? fmt::format("<span class=\"bad\">{}</span>", html_short(step.outcome))
                         : html_short(step.outcome);
    out += fmt::format(
        "<tr{}><th scope=\"row\"><a href=\"#p{}\">{}</a></th><td>{}</td><td>{}</td><td>{}</td>"
        "</tr>\n",
        step.parts ? " class=\"parts\"" : "", i, html_short(step.file), html_short(step.title),
        html_short(step.place), how);
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string picture_index(const PictureIndex& index) {
  const auto parting = std::find_if(index.steps.begin(), index.steps.end(),
                                    [](const PictureStep& step) { return step.parts; });
  const bool parts = parting != index.steps.end();
  auto body = fmt::format(
      "<header class=\"top {}\"><p class=\"kicker\">parallax draw: simulation {} of "
      "{}</p><h1>{}</h1>{}</header>\n<main id=\"main\">\n",
      parts            ? "bad"
      : index.is_clean ? "clean"
                       : "open",
      html_short(index.simulation), html_short(index.scenario),
      parts            ? "Model and simulation part"
      : index.is_clean ? "The simulation goes as the model says"
                       : "The simulation, action by action",
      index.words.empty() ? std::string()
                          : "<p class=\"lead\">" + html_words(index.words) + "</p>");
  if (parts) {
    body += section_of("parting", "Where they part", picture_figure(*parting, false));
  }
  body += section_of("events", "Events", event_rows(index));
  std::string all;
  for (std::size_t i = 0; i < index.steps.size(); ++i) {
    const auto& step = index.steps[i];
    all += fmt::format("<h3 id=\"p{}\">{}</h3>\n", i, html_short(step.title)) +
           picture_figure(step, true);
  }
  body += section_of("pictures", "All pictures", all);
  DocumentOptions options;
  options.style =
      ".picture { margin: .6rem 0; }\n.scene { max-width: 100%; height: auto; }\n"
      // A narrow screen shows a part of each picture at its own size.
      "@media screen and (max-width: 700px) { .view { overflow-x: auto; } .scene { max-width: "
      "none; } "
      "}\n" +
      index.style;
  return html_document("parallax pictures: " + index.scenario, body + "</main>\n", options);
}

}  // namespace parallax::tools
