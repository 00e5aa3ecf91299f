# SPDX-License-Identifier: MIT
# Writes the version as text, with the commit where the sources are a git checkout; touches the file only when that changes.
set(text ${VERSION})
execute_process(COMMAND git describe --always --dirty --abbrev=12 --exclude *
                WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(NOT failed)
  set(text "${VERSION} (${commit})")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Written by cmake/write_version.cmake.\nstatic constexpr const char* kVersionText = \"${text}\";\n")
