# SPDX-License-Identifier: MIT
# What the wheel holds (pyproject.toml): the module, the programs and their worker with the module for compressed geometry, all in the
# package's folder. For pictures the worker becomes a program in Python, with the package OpenImageIO.
# From Python 3.12 on it keeps to the stable ABI, so one wheel serves all later ones; scikit-build-core names the component then.
find_package(Python 3.9 REQUIRED COMPONENTS Interpreter Development.Module ${SKBUILD_SABI_COMPONENT})
find_package(nanobind CONFIG REQUIRED)
file(GLOB python_sources CONFIGURE_DEPENDS src/python/*.cpp)
nanobind_add_module(_core NB_STATIC STABLE_ABI ${python_sources})
target_compile_definitions(_core PRIVATE FRAGTRACE_VERSION="${PROJECT_VERSION}")
target_link_libraries(_core PRIVATE fragtrace_picture CLI11::CLI11)
set_target_properties(_core PROPERTIES UNITY_BUILD OFF)
# What it links stays its own, whatever else the interpreter has loaded.
target_link_options(_core PRIVATE -Wl,--exclude-libs,ALL)
install(TARGETS _core LIBRARY DESTINATION fragtrace)
install(TARGETS fragtrace fragtrace-bench fragtrace_worker RUNTIME DESTINATION fragtrace)
install(TARGETS fragtrace_geometry LIBRARY DESTINATION fragtrace)
if(TARGET fragtrace_volumes)
  add_dependencies(fragtrace_geometry fragtrace_volumes)
  install(TARGETS fragtrace_volumes LIBRARY DESTINATION fragtrace)
endif()
if(TARGET fragtrace_ktx2)
  add_dependencies(fragtrace_geometry fragtrace_ktx2)
  install(TARGETS fragtrace_ktx2 LIBRARY DESTINATION fragtrace)
  install(FILES ${FRAGTRACE_KTX2_NOTICES} DESTINATION fragtrace/licenses/ktx2)
endif()
install(PROGRAMS src/python/fragtrace_pictures DESTINATION fragtrace)
