# SPDX-License-Identifier: MIT
# The instruments: what measures (bench) and attacks (tests/instruments) the tracer, a library that tests link, too, and
# the program fragtrace-bench. Nothing in src sees them.
file(GLOB instrument_sources CONFIGURE_DEPENDS bench/report/*.cpp tests/instruments/rays/*.cpp tests/instruments/stress/*.cpp)
add_library(fragtrace_instruments STATIC ${instrument_sources})
target_include_directories(fragtrace_instruments PUBLIC ${CMAKE_SOURCE_DIR})
target_compile_definitions(fragtrace_instruments PRIVATE FRAGTRACE_VERSION="${PROJECT_VERSION}")
target_link_libraries(fragtrace_instruments PUBLIC fragtrace_gl PRIVATE nlohmann_json::nlohmann_json)

file(GLOB bench_sources CONFIGURE_DEPENDS bench/command/*.cpp)
add_executable(fragtrace-bench ${bench_sources})
target_link_libraries(fragtrace-bench PRIVATE fragtrace_instruments fragtrace_live fragtrace_program nlohmann_json::nlohmann_json)
