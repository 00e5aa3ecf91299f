# SPDX-License-Identifier: MIT
# The worker's module for KTX2 textures, where `scripts/setup ktx2` has fetched Binomial's transcoder; elsewhere the program is
# built without it.
set(cache $ENV{XDG_CACHE_HOME})
if(NOT cache)
  set(cache $ENV{HOME}/.cache)
endif()
set(FRAGTRACE_KTX2_SOURCES ${cache}/fragtrace/ktx2 CACHE PATH "The folder that `scripts/setup ktx2` fills")
set(basisu ${FRAGTRACE_KTX2_SOURCES}/vendor/basis_universal)
if(NOT EXISTS ${basisu}/transcoder/basisu_transcoder.cpp)
  return()
endif()
# Where the sources are removed, the build is configured once more.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${basisu}/transcoder/basisu_transcoder.cpp)
# Both children of a node of a Huffman tree get a place: with a code of one long symbol, the transcoder reads beyond its tree.
set(mended ${CMAKE_BINARY_DIR}/basisu)
set(huffman transcoder/basisu_transcoder_internal.h)
file(COPY ${basisu}/transcoder ${basisu}/zstd DESTINATION ${mended} PATTERN basisu_transcoder_internal.h EXCLUDE)
file(READ ${basisu}/${huffman} text)
string(REPLACE "m_tree.resize(idx + 1);" "m_tree.resize(idx + 2);  // changed by fragtrace: both children" text "${text}")
file(GENERATE OUTPUT ${mended}/${huffman} CONTENT "${text}")
add_library(basisu STATIC EXCLUDE_FROM_ALL ${mended}/transcoder/basisu_transcoder.cpp ${mended}/zstd/zstddeclib.c)
set_target_properties(basisu PROPERTIES UNITY_BUILD OFF)
target_include_directories(basisu SYSTEM INTERFACE ${mended}/transcoder)
# Its headers ask for no strict aliasing. Its assertions stop at broken files, which it refuses without them. Texels alone are wanted, and few formats of GPUs may be left out.
target_compile_options(basisu PRIVATE -w -fvisibility=hidden PUBLIC -fno-strict-aliasing)
if(FRAGTRACE_SANITIZE)
  target_compile_options(basisu PRIVATE -fno-sanitize=undefined)
endif()
set(left_out DXT1 DXT5A ETC2_EAC_A8 ETC2_EAC_RG11 ATC FXT1 PVRTC1 PVRTC2)
list(TRANSFORM left_out APPEND =0)
list(TRANSFORM left_out PREPEND BASISD_SUPPORT_)
target_compile_definitions(basisu PRIVATE NDEBUG PUBLIC BASISD_SUPPORT_KTX2=1 BASISD_SUPPORT_KTX2_ZSTD=1 ${left_out})

add_library(fragtrace_ktx2 MODULE src/image/worker/ktx2.cpp)
target_link_libraries(fragtrace_ktx2 PRIVATE basisu)
set(FRAGTRACE_KTX2_NOTICES ${basisu}/LICENSE ${basisu}/NOTICE ${basisu}/zstd/LICENSE)
list(APPEND worker_targets fragtrace_ktx2)
