# SPDX-License-Identifier: MIT
# The tests that look at the shaders' floats, compiled once more with what GLSL leaves to GPUs: numbers below 1.2e-38 are
# flushed to zero, and a product and a sum are fused (docs/design/numerics.md, Arithmetic of GPUs).
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-mfma HAS_FMA)
if(NOT HAS_FMA OR NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  message(STATUS "gpu_arithmetic is skipped: it needs GCC and fused multiply-adds of x86")
  add_test(NAME gpu_arithmetic COMMAND sh -c "echo 'skipped: needs GCC and fused multiply-adds of x86'; exit 77")
else()
  set(float_tests ${pure_tests} ${plain_tests})
  foreach(file ${float_tests})
    file(STRINGS ${file} float_lines REGEX "glsl_float|\"(climb_folds|shader_scenes|shader_one_triangle).h\"" LIMIT_COUNT 1)
    if(NOT float_lines)
      list(REMOVE_ITEM float_tests ${file})
    endif()
  endforeach()
  # Shaders with precise statements, in which nothing is fused.
  set(exact_shaders)
  set(exact_folder ${CMAKE_CURRENT_BINARY_DIR}/exact_shaders)
  file(GLOB_RECURSE shaders CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*.glsl)
  foreach(file ${shaders})
    file(STRINGS ${file} precise_lines REGEX "^ *precise " LIMIT_COUNT 1)
    if(precise_lines)
      file(RELATIVE_PATH name ${CMAKE_SOURCE_DIR}/shaders ${file})
      add_custom_command(OUTPUT ${exact_folder}/${name}
                         COMMAND ${CMAKE_COMMAND} -DSOURCE=${file} -DOUTPUT=${exact_folder}/${name}
                                 -P ${CMAKE_CURRENT_LIST_DIR}/exact_statements.cmake
                         DEPENDS ${file} ${CMAKE_CURRENT_LIST_DIR}/exact_statements.cmake VERBATIM)
      list(APPEND exact_shaders ${exact_folder}/${name})
    endif()
  endforeach()
  add_executable(gpu_arithmetic_tests ${CMAKE_CURRENT_LIST_DIR}/arithmetic_test.cpp ${float_tests} ${exact_shaders})
  # clang-tidy reads these tests as pure_tests compiles them.
  set_target_properties(gpu_arithmetic_tests PROPERTIES UNITY_BUILD_MODE GROUP EXPORT_COMPILE_COMMANDS OFF)
  target_compile_options(gpu_arithmetic_tests PRIVATE -O1 -fexpensive-optimizations -mfma -ffp-contract=fast)
  target_compile_definitions(gpu_arithmetic_tests PRIVATE FRAGTRACE_GPU_ARITHMETIC)
  target_include_directories(gpu_arithmetic_tests PRIVATE ${exact_folder})
  link_tests(gpu_arithmetic_tests)
  # Left out are long tests of doubles, which no shader has, and the second to fourth count of the samples of lobes.
  set(left_out ShaderBsdf.Compensated* ShaderBsdf.*LosesNothing* ShaderBsdf.*WithSchlick ShaderBsdf.DensitiesIntegrate*
      ShaderInstances.TheExactTracer* ShaderLayers.DirectionsFollow* ShaderLayers.NoLayerOver*
      ShaderLayers.StretchedMetal* ShaderTraverse.Double* LightCandidates.OneOfSeveral*)
  list(JOIN left_out ":" left_out)
  add_test(NAME gpu_arithmetic COMMAND gpu_arithmetic_tests --gtest_brief=1 --gtest_filter=-${left_out})
  add_test(NAME extended.gpu_arithmetic COMMAND gpu_arithmetic_tests --gtest_brief=1)
  set_tests_properties(extended.gpu_arithmetic PROPERTIES LABELS extended SKIP_RETURN_CODE 77)
endif()
set_tests_properties(gpu_arithmetic PROPERTIES SKIP_RETURN_CODE 77)
