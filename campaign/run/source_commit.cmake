# Writes the commit of the sources into a header, at every build, so that a results file can name it. The header is
# written anew only if the commit is another one. SOURCE: the folder of the sources. TARGET: the header.
execute_process(COMMAND git -C "${SOURCE}" rev-parse HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")  # an archive of the sources without their history
else()
  execute_process(COMMAND git -C "${SOURCE}" diff --quiet HEAD ERROR_QUIET RESULT_VARIABLE changed)
  if(changed)
    string(APPEND commit "-changed")
  endif()
endif()
set(text "#define FLEETPROOF_SOURCE_COMMIT \"${commit}\"\n")
set(known "")
if(EXISTS "${TARGET}")
  file(READ "${TARGET}" known)
endif()
if(NOT known STREQUAL text)
  file(WRITE "${TARGET}" "${text}")
endif()
