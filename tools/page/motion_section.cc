#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/json.h"
#include "harness/recording/marks.h"
#include "harness/recording/recording.h"
#include "harness/report/text_layout.h"
#include "tools/page/markup.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(bytes.size() * 4 / 3 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const auto count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= count ? kDigits[bits >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return out;
}

/// A name of the recording as the page shows names.
std::string word(const std::string& text) { return base::printable(text.substr(0, 200)); }

Json pose_json(const harness::Pose& pose) {
  Json out = Json::array();
  for (const double value : pose.p) out.push_back(value);
  for (const double value : pose.q) out.push_back(value);
  return out;
}

Json scene_json(const harness::RecordedScene& scene) {
  Json bodies = Json::array();
  for (const auto& body : scene.bodies) {
    Json shapes = Json::array();
    for (const auto& shape : body.shapes) {
      shapes.push_back({{"kind", static_cast<int>(shape.kind)},
                        {"size", shape.size},
                        {"pose", pose_json(shape.pose)}});
      if (shape.kind != harness::ShapeKind::kHull) continue;
      shapes.back()["corners"] = shape.corners;
      shapes.back()["faces"] = shape.faces;
    }
    Json out = {{"name", word(body.name)},
                {"kind", static_cast<int>(body.kind)},
                {"moves", body.moves},
                {"pose", pose_json(body.pose)},
                {"shapes", std::move(shapes)}};
    if (body.on) out["on"] = *body.on;
    bodies.push_back(std::move(out));
  }
  Json arms = Json::array();
  for (const auto& arm : scene.arms) {
    arms.push_back({{"name", word(arm.name)},
                    {"from", arm.from},
                    {"to", arm.to},
                    {"shoulder", arm.shoulder},
                    {"reach", {arm.min_reach_m, arm.max_reach_m}}});
  }
  Json grippers = Json::array();
  for (const auto& name : scene.grippers) grippers.push_back(word(name));
  Json out = {
      {"bodies", std::move(bodies)}, {"arms", std::move(arms)}, {"grippers", std::move(grippers)}};
  if (scene.camera) {
    out["camera"] = {scene.camera->half_angle_rad, scene.camera->min_range_m,
                     scene.camera->max_range_m};
  }
  return out;
}

/// "clearance 0.012", ...
Json margins_json(const harness::RecordedValues& margins) {
  Json out = Json::array();
  for (const auto& [name, value] : margins) {
    const auto* number_value = std::get_if<double>(&value);
    if (number_value == nullptr) continue;
    out.push_back({word(name), *number_value});
  }
  return out;
}

Json run_json(const PageMotion& run, std::size_t scene, std::optional<std::size_t> beside) {
  const auto& recording = *run.recording;
  Json events = Json::array();
  for (const auto& event : recording.events) {
    events.push_back({{"name", word(event.name)},
                      {"begin", event.begin_s},
                      {"end", event.end_s},
                      {"status", word(event.status)},
                      {"reason", word(event.reason)},
                      {"margins", margins_json(event.margins)}});
  }
  Json marks = Json::array();
  for (const auto& mark : harness::marks_of(recording))
    marks.push_back({mark.time_s, word(mark.text)});
  Json out = {{"name", sample_name(run.trace, run.sample)},
              {"verdict", to_string(run.verdict)},
              {"cause", word(run.cause)},
              {"missing", word(recording.missing)},
              {"scene", scene},
              {"interval", recording.interval_s},
              {"events", std::move(events)},
              {"marks", std::move(marks)},
              {"frames", base64(recording.frames)}};
  if (run.parting && *run.parting > 0) out["parting"] = *run.parting - 1;
  if (beside) out["beside"] = *beside;
  return out;
}

/// The clean run of the same trace that one is shown beside.
std::optional<std::size_t> partner_of(const std::vector<PageMotion>& runs, std::size_t i) {
  if (runs[i].verdict == PageVerdict::kClean) return std::nullopt;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (runs[k].trace == runs[i].trace && runs[k].verdict == PageVerdict::kClean) return k;
  }
  return std::nullopt;
}

Json regions_json(const PageData& page) {
  Json out = Json::array();
  const auto bounds = [](const std::optional<std::array<double, 2>>& on) {
    return on ? Json(*on) : Json(nullptr);
  };
  for (const auto& region : page.regions) {
    out.push_back({{"name", word(region.name)},
                   {"x", bounds(region.x)},
                   {"y", bounds(region.y)},
                   {"z", bounds(region.z)},
                   {"body", word(region.frame)},
                   {"start", region.frame_start}});
  }
  return out;
}

/// JSON in a script element: no text in it ends that, or turns the direction of writing.
std::string in_script(const Json& document) {
  std::string out;
  for (const char c : document.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<' || c == '>' || c == '&') {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out;
}

std::string missing_words(const PageData& page) {
  if (!page.not_recorded) return {};
  const auto [trace, sample] = *page.not_recorded;
  return fmt::format(
             "<p>The motion of simulation {} is not on record. This command makes it, and a report "
             "made afterwards shows it:</p>\n",
             sample_name(trace, sample)) +
         command_box(replay_words(page, trace, sample) + " --record");
}

}  // namespace

std::string motion_section(const PageData& page) {
  if (page.motion.empty()) {
    const auto missing = missing_words(page);
    return missing.empty() ? missing : section_of("motion", "Motion", missing);
  }
  std::string runs, rows;
  for (std::size_t i = 0; i < page.motion.size(); ++i) {
    const auto& run = page.motion[i];
    runs += fmt::format("<option value=\"{}\">{}, {}{}{}</option>", i,
                        sample_name(run.trace, run.sample), to_string(run.verdict),
                        run.cause.empty() ? "" : ": ", html_short(run.cause));
  }
  // The script fills what is empty here.
  auto out = fmt::format(
      "<p id=\"motion-needs\">Recorded motion of {} simulations is in this page. It is shown where "
      "scripts "
      "may run and WebGL is at hand.</p>\n"
      "<div id=\"motion-box\" hidden>\n<div class=\"controls\" hidden><label>Simulation <select "
      "id=\"motion-run\">{}</select></label> <label>beside <select id=\"motion-beside\"><option "
      "value=\"\">nothing</option>{}</select></label> <label>Follow <select "
      "id=\"motion-follow\"><option "
      "value=\"\">nothing</option></select></label> <span role=\"group\" aria-label=\"Views\" "
      "class=\"views\"><button type=\"button\" data-view=\"world\">Whole</button> <button "
      "type=\"button\" "
      "data-view=\"top\">Top</button> <button type=\"button\" data-view=\"front\">Front</button> "
      "<button "
      "type=\"button\" data-view=\"robot\">Robot</button></span> <label><input type=\"checkbox\" "
      "id=\"motion-regions\" checked> Regions</label> <label><input type=\"checkbox\" "
      "id=\"motion-reach\"> "
      "Reach</label> <label><input type=\"checkbox\" id=\"motion-sight\"> Sight</label></div>\n"
      "<div id=\"motion-stage\" tabindex=\"0\" role=\"application\" aria-label=\"Motion in three "
      "dimensions. "
      "Space plays and pauses, left and right go from event to event, comma and point step, up and "
      "down turn "
      "the view, plus and minus move it nearer and farther.\"></div>\n"
      "<div class=\"controls transport\" hidden><button type=\"button\" "
      "id=\"motion-play\">Play</button> "
      "<input type=\"range\" id=\"motion-time\" min=\"0\" max=\"1\" step=\"any\" value=\"0\" "
      "aria-label=\"Time\"> <output id=\"motion-clock\"></output> <label>Speed <select "
      "id=\"motion-speed\"><option>0.25</option><option>0.5</option><option selected>1</option>"
      "<option>2</option><option>4</option><option>8</option></select></label></div>\n"
      "<ol id=\"motion-events\"></ol>\n<p id=\"motion-says\" class=\"says\"></p>\n<p "
      "class=\"hint\">Drag turns "
      "the view, with the shift key it moves it; the wheel with the control key zooms. On the "
      "stage: space, "
      "arrows, + and -.</p>\n</div>\n",
      page.motion.size(), runs, runs);
  if (page.motion_left_out > 0) {
    out += fmt::format(
        "<p class=\"hint\">The motion of {} further simulations is in the run folder.</p>\n",
        page.motion_left_out);
  }
  out += missing_words(page);
  Json document = {
      {"scenes", Json::array()}, {"runs", Json::array()}, {"regions", regions_json(page)}};
  std::vector<const harness::RecordedScene*> scenes;
  for (std::size_t i = 0; i < page.motion.size(); ++i) {
    const auto& scene = page.motion[i].recording->scene;
    const auto same =
        std::find_if(scenes.begin(), scenes.end(), [&](const auto* one) { return *one == scene; });
    const auto number = static_cast<std::size_t>(same - scenes.begin());
    if (same == scenes.end()) {
      scenes.push_back(&scene);
      document["scenes"].push_back(scene_json(scene));
    }
    document["runs"].push_back(run_json(page.motion[i], number, partner_of(page.motion, i)));
  }
  out +=
      "<script type=\"application/json\" id=\"motion-data\">" + in_script(document) + "</script>\n";
  return section_of("motion", "Motion", out);
}

}  // namespace parallax::tools
