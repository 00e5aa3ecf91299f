# SPDX-License-Identifier: MIT
# Read by cpack: the packages of the libraries that the programs link. Those of `view`, of compressed scenes and of volumes are only
# recommended, since `render` works without them, and the program says which are missing.
set(folder ${CPACK_FRAGTRACE_BUILD}/generated/shlibdeps)
file(WRITE ${folder}/debian/control "Source: fragtrace\n\nPackage: fragtrace\nArchitecture: any\n")
set(build ${CPACK_FRAGTRACE_BUILD})
set(volumes)
if(EXISTS ${build}/libfragtrace_volumes.so)
  set(volumes -e${build}/libfragtrace_volumes.so)
endif()
execute_process(
  COMMAND dpkg-shlibdeps -O
          -dDepends -e${build}/fragtrace -e${build}/fragtrace-bench -e${build}/fragtrace_worker -e${build}/libfragtrace_pictures.so
                    -e${build}/libfragtrace_letters.so
          -dRecommends -e${build}/libfragtrace_geometry.so -e${build}/libfragtrace_window.so ${volumes}
  WORKING_DIRECTORY ${folder} OUTPUT_VARIABLE found COMMAND_ERROR_IS_FATAL ANY)
foreach(field Depends Recommends)
  string(TOUPPER ${field} name)
  if(NOT found MATCHES "shlibs:${field}=([^\n]+)")
    message(FATAL_ERROR "dpkg-shlibdeps named no ${field}:\n${found}")
  endif()
  set(CPACK_DEBIAN_PACKAGE_${name} "${CMAKE_MATCH_1}, ${CPACK_FRAGTRACE_${name}}")
endforeach()
