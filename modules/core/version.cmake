# Writes built_from.h, the version and the commit of the source. Each build runs this script, because
# only then is it known whether a file differs from the commit; the header is left alone if it says
# the same already, so that nothing is compiled again.
#   cmake -D SOURCE=DIR -D VERSION=0.2.0 -D OUTPUT=built_from.h -P version.cmake
file(REAL_PATH ${SOURCE} SOURCE)
set(commit "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  # git refuses a folder that another user owns unless it is named as safe.
  execute_process(COMMAND ${GIT} -c safe.directory=${SOURCE} -C ${SOURCE}
                          describe --always --dirty --tags --long --abbrev=12
                  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
elseif(EXISTS ${SOURCE}/.git_archival.txt)
  # `git archive` has put the commit into this file (.gitattributes).
  file(READ ${SOURCE}/.git_archival.txt text)
  if(text MATCHES "commit: ([0-9a-f]+)")
    string(SUBSTRING ${CMAKE_MATCH_1} 0 12 commit)
  endif()
endif()
if(NOT commit MATCHES "^[A-Za-z0-9._/+-]+$")
  set(commit "unknown")
endif()
set(text "#define PATINA_VERSION \"${VERSION}\"\n#define PATINA_COMMIT \"${commit}\"\n")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${OUTPUT} "${text}")
endif()
