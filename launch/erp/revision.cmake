# Writes the C++ file OUT with version and git revision, if they have changed.
#   cmake -DSOURCE=… -DOUT=… -DVERSION=… -P revision.cmake
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=10
  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR NOT revision)
  set(revision "unknown")
endif()
set(text "namespace launch {

const char* version() { return \"${VERSION}\"; }
const char* revision() { return \"${revision}\"; }

}  // namespace launch
")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT "${old}" STREQUAL "${text}")
  file(WRITE ${OUT} "${text}")
endif()
