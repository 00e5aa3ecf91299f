# SPDX-License-Identifier: MIT
# Writes every file of shaders/ into one .cpp as a table of (name, text).
file(GLOB_RECURSE shader_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*)
set(FRAGTRACE_EMBEDDED_SHADERS ${CMAKE_BINARY_DIR}/embedded_shaders.cpp)
add_custom_command(
  OUTPUT ${FRAGTRACE_EMBEDDED_SHADERS}
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=${FRAGTRACE_EMBEDDED_SHADERS} -DFOLDER=${CMAKE_SOURCE_DIR}/shaders
          -P ${CMAKE_SOURCE_DIR}/cmake/write_embedded_shaders.cmake
  DEPENDS ${shader_files} ${CMAKE_SOURCE_DIR}/cmake/write_embedded_shaders.cmake
  COMMENT "Embedding shaders"
  VERBATIM)
