# Writes C++ that holds the files of FOLDER as string literals, in pieces short enough for every compiler: FUNCTION
# returns them as a span of TYPE, as HEADER declares it.
cmake_policy(SET CMP0053 NEW)  # @names@ are replaced by file(CONFIGURE) alone
file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT files)
set(rows "")
foreach(name ${files})
  file(READ ${FOLDER}/${name} text HEX)  # as text, semicolons and brackets would be lists
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" text "${text}")
  string(REGEX REPLACE "\\\\x0a" "\\\\n\"\n     \"" text "${text}")
  string(APPEND rows "    {\"${name}\",\n     \"${text}\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by tools/scaffold/embed.cmake.
#include \"${HEADER}\"

namespace parallax::tools {
namespace {

const ${TYPE} kFiles[] = {
${rows}};

}  // namespace

std::span<const ${TYPE}> ${FUNCTION}() { return kFiles; }

}  // namespace parallax::tools
")
