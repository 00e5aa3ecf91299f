# SPDX-License-Identifier: MIT
# The programs, their worker, its modules and the window library lie in one folder, where they look for each other; bin has a link to fragtrace.
include(GNUInstallDirs)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(FRAGTRACE_FOLDER ${CMAKE_INSTALL_LIBDIR}/fragtrace)
install(TARGETS fragtrace fragtrace-bench fragtrace_worker RUNTIME DESTINATION ${FRAGTRACE_FOLDER})
install(TARGETS fragtrace_pictures fragtrace_geometry fragtrace_window fragtrace_letters LIBRARY DESTINATION ${FRAGTRACE_FOLDER})
if(TARGET fragtrace_volumes)
  install(TARGETS fragtrace_volumes LIBRARY DESTINATION ${FRAGTRACE_FOLDER})
endif()
if(TARGET fragtrace_ktx2)
  install(TARGETS fragtrace_ktx2 LIBRARY DESTINATION ${FRAGTRACE_FOLDER})
endif()
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
file(RELATIVE_PATH link /${CMAKE_INSTALL_BINDIR} /${FRAGTRACE_FOLDER}/fragtrace)
install(CODE "
  set(bin \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
  file(MAKE_DIRECTORY \"\${bin}\")
  message(STATUS \"Installing: \${bin}/fragtrace\")
  file(CREATE_LINK ${link} \"\${bin}/fragtrace\" SYMBOLIC)
")

# What a desktop and a shell show of it. Man pages and completion are what the program that is installed says of itself.
set(package ${CMAKE_SOURCE_DIR}/cmake/package)
set(written ${CMAKE_BINARY_DIR}/generated/installed)
install(CODE "execute_process(COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/scripts/help_files
                                      $<TARGET_FILE:fragtrace> ${written} COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY ${written}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${written}/completions/fragtrace DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${written}/completions/_fragtrace DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${written}/completions/fragtrace.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES ${written}/config.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/fragtrace)
install(FILES ${package}/fragtrace.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES ${package}/fragtrace.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
install(FILES ${package}/fragtrace.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo)
install(FILES ${package}/fragtrace.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers)

# Debian has its own form of these two.
install(FILES CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT plain)

include(cmake/package/debian.cmake)
