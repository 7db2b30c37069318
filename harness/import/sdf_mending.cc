// libsdformat refuses a file for faults in parts that are not taken over, and for inertias that no
// body has. Such a file is read a second time without these parts, and with harmless inertias,
// whose real ones are mended later like those of other formats (fitting.h).

#include "harness/import/sdf_mending.h"

#include <Eigen/Eigenvalues>
#include <charconv>
#include <vector>

namespace parallax::harness {
namespace {

std::optional<double> number_in_text(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\n' || text.front() == '\t' ||
                           text.front() == '\r' || text.front() == '+')) {
    text.remove_prefix(1);
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end == text.data()) return std::nullopt;
  return value;
}

/// Is it what a body can have, as the library asks?
bool is_of_body(const Eigen::Matrix3d& I) {
  if (!I.allFinite()) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(I);
  const Eigen::Vector3d moments = axes.eigenvalues();
  return moments.minCoeff() > 0.0 && 2.0 * moments.maxCoeff() < moments.sum();
}

}  // namespace

MendedSdf mended_sdf(const std::string& text, const XmlOutline& outline) {
  MendedSdf out;
  const auto& elements = outline.elements;
  std::map<std::size_t, Eigen::Matrix3d> inertias;  // by number of the element
  for (const XmlElement& element : elements) {
    if (!element.parent || elements[*element.parent].tag != "inertia") continue;
    auto [found, added] = inertias.try_emplace(*element.parent, Eigen::Matrix3d::Identity());
    const auto value = number_in_text(element.text);
    if (!value || element.tag.size() != 3 || element.tag[0] != 'i') continue;
    const int row = element.tag[1] - 'x', column = element.tag[2] - 'x';
    if (row < 0 || row > 2 || column < 0 || column > 2) continue;
    found->second(row, column) = found->second(column, row) = *value;
  }
  const auto parent = [&](std::size_t i) { return elements[i].parent; };
  std::size_t at = 0;
  const auto cut = [&](const XmlElement& element) {
    out.text.append(text, at, element.offset - at);
    at = element.end;
  };
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const XmlElement& element = elements[i];
    if (element.offset < at) continue;  // in what was cut out
    const bool in_link = element.parent && elements[*element.parent].tag == "link";
    if (in_link && (element.tag == "visual" || element.tag == "sensor")) {
      ++(element.tag == "visual" ? out.visuals : out.sensors);
      cut(element);
      continue;
    }
    const auto inertia = inertias.find(i);
    if (inertia == inertias.end() || is_of_body(inertia->second)) continue;
    const auto inertial = parent(i);
    const auto link = inertial ? parent(*inertial) : std::nullopt;
    const auto model = link ? parent(*link) : std::nullopt;
    if (!model) continue;
    out.inertias.emplace(
        std::pair(std::string(elements[*model].name), std::string(elements[*link].name)),
        inertia->second);
    cut(element);
  }
  out.text.append(text, at);
  return out;
}

}  // namespace parallax::harness
