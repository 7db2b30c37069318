# Manual pages and completions, which the program makes of its own option tables, where Debian's
# `man` and shells look for them; pages, examples and files for editors beside them.
set(manual ${PROJECT_BINARY_DIR}/generated/manual)
file(MAKE_DIRECTORY ${manual})
add_custom_command(TARGET parallax POST_BUILD
  COMMAND parallax man --out ${manual}
  COMMAND parallax completion bash -o ${manual}/parallax.bash
  COMMAND parallax completion zsh -o ${manual}/_parallax
  COMMAND parallax completion fish -o ${manual}/parallax.fish
  COMMENT "Writing manual pages and completions" VERBATIM)

# `man` reads compressed pages; -n leaves out the time, so that the bytes are the same each time.
install(CODE "
  file(GLOB pages \"${manual}/*.1\")
  set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
  file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\"
    TYPE FILE FILES \${pages})
  foreach(page \${pages})
    cmake_path(GET page FILENAME name)
    execute_process(COMMAND gzip -9nf \"\${folder}/\${name}\" COMMAND_ERROR_IS_FATAL ANY)
  endforeach()" COMPONENT program)
install(FILES ${manual}/parallax.bash RENAME parallax COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${manual}/_parallax COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${manual}/parallax.fish COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

# The README names pages as docs/NAME.md, and so do messages.
install(FILES ${PROJECT_SOURCE_DIR}/README.md COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/parallax)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/parallax
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" PATTERN "library" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/library COMPONENT development
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libparallax-dev/examples)
# Not with the documentation: small installations leave that out.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenarios ${PROJECT_SOURCE_DIR}/tools/editor
  DESTINATION ${CMAKE_INSTALL_DATADIR}/parallax COMPONENT program)
