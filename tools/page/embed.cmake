# Writes C++ that holds the files as raw string literals, in pieces short enough for every compiler.
cmake_policy(SET CMP0053 NEW)  # @names@ are replaced by file(CONFIGURE) alone

function(literal name out)
  set(text "")
  foreach(file ${ARGN})
    file(READ ${file} part)
    string(APPEND text "${part}")
  endforeach()
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

literal(kPageStyle style ${STYLE})
literal(kPageScript script ${SCRIPT})
literal(kDotsScript dots ${DOTS})
literal(kReplayScript replay ${REPLAY})
literal(kThreeScript three ${THREE_LICENCE} ${THREE})
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Made by tools/page/embed.cmake.
#include \"tools/page/assets.h\"

// three.js is longer than what the standard asks compilers to take.
#pragma GCC diagnostic ignored \"-Woverlength-strings\"

namespace parallax::tools {

@style@
@script@
@dots@
@replay@
@three@
}  // namespace parallax::tools
" @ONLY)
