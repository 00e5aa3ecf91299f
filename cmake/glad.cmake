# SPDX-License-Identifier: MIT
# Generates the OpenGL loader offline with Debian's python3-glad.
set(glad_dir ${CMAKE_BINARY_DIR}/glad)
find_program(GLAD glad REQUIRED)
add_custom_command(
  OUTPUT ${glad_dir}/src/gl.c ${glad_dir}/include/glad/gl.h
  COMMAND ${GLAD} --quiet --api gl:core=4.5 --extensions GL_KHR_debug,GL_ARB_shading_language_include,GL_KHR_parallel_shader_compile
          --reproducible --out-path ${glad_dir} c
  COMMENT "Generating the OpenGL loader"
  VERBATIM)
add_library(glad STATIC ${glad_dir}/src/gl.c ${glad_dir}/include/glad/gl.h)
# As C++, so that a lack of memory can be thrown.
set_source_files_properties(${glad_dir}/src/gl.c PROPERTIES LANGUAGE CXX COMPILE_OPTIONS "-include;${CMAKE_CURRENT_LIST_DIR}/glad_memory.h")
target_include_directories(glad SYSTEM PUBLIC ${glad_dir}/include)
