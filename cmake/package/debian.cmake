# SPDX-License-Identifier: MIT
# The Debian package, which `cpack -G DEB` writes; scripts/package calls it.
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "the fragtrace authors <maintainers@fragtrace.invalid>")
install(CODE "execute_process(COMMAND ${Python3_EXECUTABLE} ${package}/debian_changelog.py ${CMAKE_SOURCE_DIR}/CHANGELOG.md
                                      fragtrace \"${CPACK_DEBIAN_PACKAGE_MAINTAINER}\" ${written}/changelog.gz
                                      COMMAND_ERROR_IS_FATAL ANY)" COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES ${written}/changelog.gz ${package}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT debian EXCLUDE_FROM_ALL)

set(CPACK_PACKAGE_NAME fragtrace)
# For the release that it is made on: "0.2.0+deb13". Where there is no such number, the version alone.
cmake_host_system_information(RESULT release QUERY DISTRIB_INFO)
set(release_suffix)
if(release_VERSION_ID)
  string(REPLACE "debian" "deb" release_suffix "+${release_ID}${release_VERSION_ID}")
endif()
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION}${release_suffix})
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL Unspecified debian)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "path tracer and viewer for glTF scenes")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"fragtrace renders glTF 2.0 scenes by path tracing in an OpenGL 4.5 shader, on
a GPU or by Mesa's software driver alone. It needs no display and no network.

It writes PNG, JPEG, OpenEXR, Radiance HDR and PFM pictures, removes noise,
compares pictures, and shows scenes in a window while they converge.")
# dpkg-shlibdeps finds the libraries; it does so when the package is made.
set(CPACK_PROJECT_CONFIG_FILE ${package}/debian_libraries.cmake)
set(CPACK_FRAGTRACE_BUILD ${CMAKE_BINARY_DIR})
# OpenGL is opened at run time: by EGL with Mesa's software driver, or by OSMesa.
set(CPACK_FRAGTRACE_DEPENDS "libegl1 | libosmesa6, libgl1-mesa-dri | libosmesa6")
set(CPACK_FRAGTRACE_RECOMMENDS "libosmesa6, libgl1, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS ffmpeg)  # for videos alone, and large
if(glfw3_VERSION VERSION_GREATER_EQUAL 3.4)  # a title bar on Wayland
  string(APPEND CPACK_FRAGTRACE_RECOMMENDS ", libdecor-0-plugin-1-gtk | libdecor-0-plugin-1-cairo")
endif()
include(CPack)
