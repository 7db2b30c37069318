# cmake -DOUTPUT=assets.cc -DSTYLE=page.css -DSCRIPT=page.js -DDOTS=dots.js -P embed.cmake
# Writes C++ that holds the files as raw string literals, in pieces that every compiler takes.
function(literal name file out)
  file(READ ${file} text)
  string(LENGTH "${text}" length)
  set(code "const std::string_view ${name} =\n")
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 piece)
    string(APPEND code "    R\"~page~(${piece})~page~\"\n")
    math(EXPR at "${at} + 8000")
  endwhile()
  set(${out} "${code};\n" PARENT_SCOPE)
endfunction()

literal(kPageStyle ${STYLE} style)
literal(kPageScript ${SCRIPT} script)
literal(kDotsScript ${DOTS} dots)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Made by tools/page/embed.cmake.
#include \"tools/page/assets.h\"

namespace parallax::tools {

@style@
@script@
@dots@
}  // namespace parallax::tools
" @ONLY)
