# SPDX-License-Identifier: MIT
# Removes what the last `cmake --install` put in place, and the directories that this leaves empty.

if(NOT EXISTS "${MANIFEST}")
  message(FATAL_ERROR "nothing to remove: there is no ${MANIFEST}")
endif()
file(STRINGS "${MANIFEST}" files)
foreach(file IN LISTS files)
  set(path "$ENV{DESTDIR}${file}")
  if(EXISTS "${path}" OR IS_SYMLINK "${path}")
    message(STATUS "Removing ${path}")
    file(REMOVE "${path}")
  endif()
  # Only directories of our own; the others are the system's, empty or not.
  get_filename_component(directory "${path}" DIRECTORY)
  if(directory MATCHES "/cmake/mien$")
    file(GLOB left "${directory}/*")
    if(NOT left)
      file(REMOVE_RECURSE "${directory}")
    endif()
  endif()
endforeach()
file(REMOVE "${MANIFEST}")
