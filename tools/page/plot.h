#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/page/page_data.h"

namespace parallax::tools {

/// One axis of a plot: values to pixels.
struct PlotAxis {
  double low = 0.0, high = 1.0;  // values
  double from = 0.0, to = 1.0;   // pixels
  double at(double value) const {
    return high > low ? from + (value - low) / (high - low) * (to - from) : 0.5 * (from + to);
  }
};

/// Round values between the ends of an axis, about `count` of them.
std::vector<double> ticks(double low, double high, int count);

/// Points as one path of dots, however many: "M12.3 4.5h0M...".
class DotPath {
 public:
  void add(double x, double y);
  bool empty() const { return d_.empty(); }
  /// An element with these classes; empty without points.
  std::string element(std::string_view classes) const;

 private:
  std::string d_;
};

/// The dots of one kind of simulation. Failures are larger squares, so that the plot does not rely
/// on colour alone; `aside`: no claim is about it.
std::string dot_class(PageVerdict verdict, bool aside);

/// With more simulations than this, a script draws all dots on a canvas.
inline constexpr std::size_t kMostDots = 1000;
/// Simulations whose dots are in the page itself: all, or a selection if there are very many,
/// failures first.
std::vector<const PageSample*> dotted(const std::vector<const PageSample*>& samples);
/// Hint for pages without scripts that not all dots are drawn; empty where all are.
std::string dots_hint(std::size_t samples);

/// "12.3", as coordinates are written.
std::string px(double value);
std::string line(double x1, double y1, double x2, double y2, std::string_view classes);
std::string label(double x, double y, std::string_view classes, std::string_view escaped);

}  // namespace parallax::tools
