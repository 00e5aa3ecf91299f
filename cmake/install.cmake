# SPDX-License-Identifier: MIT
# The program, its worker processes and its window library lie in one folder, where it looks for them; bin has a link to it.
include(GNUInstallDirs)
set(FRAGTRACE_FOLDER ${CMAKE_INSTALL_LIBDIR}/fragtrace)
install(TARGETS fragtrace fragtrace_imageio fragtrace_codecs RUNTIME DESTINATION ${FRAGTRACE_FOLDER})
install(TARGETS fragtrace_window LIBRARY DESTINATION ${FRAGTRACE_FOLDER})
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
file(RELATIVE_PATH link /${CMAKE_INSTALL_BINDIR} /${FRAGTRACE_FOLDER}/fragtrace)
install(CODE "
  set(bin \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
  file(MAKE_DIRECTORY \"\${bin}\")
  message(STATUS \"Installing: \${bin}/fragtrace\")
  file(CREATE_LINK ${link} \"\${bin}/fragtrace\" SYMBOLIC)
")
