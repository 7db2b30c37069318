#include "harness/draw/shown_text.h"

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/utf8.h"
#include "compiler/base/xml_text.h"

namespace parallax::harness {

std::string shown_text(std::string_view text, std::size_t longest) {
  // No character has more than four bytes: what is cut off here would not be shown.
  const bool is_long = text.size() > 4 * longest;
  auto whole = base::printable(text.substr(0, is_long ? 4 * longest : text.size()));
  std::size_t cut = 0, count = 0;
  while (cut < whole.size()) {
    if (!base::continues_code_point(whole[cut]) && count++ == longest) break;
    ++cut;
  }
  if (cut == whole.size() && !is_long) return whole;
  whole.resize(cut);
  return whole + "\xE2\x80\xA6";
}

std::string shown_in_full(std::string_view text) {
  constexpr std::size_t kLongest = 300;
  return base::xml_escaped(shown_text(text, kLongest));
}

double text_width_px(std::string_view text, double font_px) {
  double width = 0.0;
  for (const char c : text) {
    if (base::continues_code_point(c)) continue;
    if (static_cast<unsigned char>(c) >= 0x80U) {
      width += 1.0;  // whatever it is
    } else if (std::string_view("mwMW@%").find(c) != std::string_view::npos) {
      width += 1.0;
    } else if (std::string_view("ijlI.,:;|'!()[] ").find(c) != std::string_view::npos) {
      width += 0.4;
    } else if ((c >= 'A' && c <= 'Z') || c == '&' || c == '+' || c == '=' || c == '<' || c == '>') {
      width += 0.84;
    } else {
      width += 0.65;
    }
  }
  return width * font_px;
}

}  // namespace parallax::harness
