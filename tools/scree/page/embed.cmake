# Writes the page's files as texts of a C++ header: cmake -DOUT=FILE.hpp -DFOLDER=DIR -P embed.cmake
# The scripts become one, in the order of SCRIPTS.
function(text_of NAME)
  set(TEXT "")
  foreach(FILE ${ARGN})
    file(READ ${FOLDER}/${FILE} PART HEX)
    string(APPEND TEXT ${PART})
  endforeach()
  # A literal holds 64 kB at most, an array any number.
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," BYTES "${TEXT}")
  file(APPEND ${OUT}.new "inline constexpr char ${NAME}_bytes[] = {\n${BYTES}};\n"
    "inline constexpr std::string_view ${NAME}{${NAME}_bytes, sizeof ${NAME}_bytes};\n")
endfunction()

file(WRITE ${OUT}.new "#pragma once\n\n#include <string_view>\n\nnamespace scree::cli::page_files {\n")
text_of(page_html page.html)
text_of(page_css page.css)
text_of(page_js ${SCRIPTS})
file(APPEND ${OUT}.new "}  // namespace scree::cli::page_files\n")
file(RENAME ${OUT}.new ${OUT})
