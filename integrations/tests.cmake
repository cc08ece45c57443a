# SPDX-License-Identifier: MIT
# Tests of what stands on mien.h in other languages; tests/CMakeLists.txt includes this.

set(integrations ${PROJECT_SOURCE_DIR}/integrations)

# ---- the interface as data --------------------------------------------------------------------------

add_test(NAME api_json
  COMMAND Python3::Interpreter ${integrations}/api/dump_api.py --check)
set_tests_properties(api_json PROPERTIES LABELS guard)
add_test(NAME api_layout
  COMMAND Python3::Interpreter ${integrations}/api/layout_test.py ${CMAKE_C_COMPILER})
set_tests_properties(api_layout PROPERTIES LABELS abi)

add_test(NAME api_bindings
  COMMAND Python3::Interpreter ${integrations}/api/check_bindings.py)
set_tests_properties(api_bindings PROPERTIES LABELS guard)

# ---- Python -----------------------------------------------------------------------------------------

add_test(NAME python_api
  COMMAND Python3::Interpreter ${integrations}/python/generate_api.py --check)
set_tests_properties(python_api PROPERTIES LABELS guard)

# The tests want an interpreter with NumPy; the first Python on the path may be one without.
set(MIEN_PYTHON "" CACHE FILEPATH "Python with NumPy, for the tests of the package")
if(NOT MIEN_PYTHON)
  foreach(python ${Python3_EXECUTABLE} /usr/bin/python3)
    execute_process(COMMAND ${python} -c "import numpy" RESULT_VARIABLE failed ERROR_QUIET)
    if(failed EQUAL 0)
      set(MIEN_PYTHON ${python})
      break()
    endif()
  endforeach()
endif()
if(NOT MIEN_PYTHON)
  message(WARNING "NOT TESTED: arrays in Python; no interpreter with NumPy was found")
  set(MIEN_PYTHON ${Python3_EXECUTABLE})
endif()

# An interpreter without the sanitizers has to load them before the library that needs them.
set(python_environment "PYTHONPATH=${integrations}/python"
  "MIEN_LIBRARY=$<TARGET_FILE:mien>" "PYTHONDONTWRITEBYTECODE=1")
set(python_tests lifetime misuse values wheel)
if(MIEN_SANITIZE MATCHES "address")
  execute_process(COMMAND ${CMAKE_C_COMPILER} -print-file-name=libclang_rt.asan-${CMAKE_SYSTEM_PROCESSOR}.so
    OUTPUT_VARIABLE sanitizer OUTPUT_STRIP_TRAILING_WHITESPACE)
  # Python itself keeps memory to its end, which is no leak of ours.
  list(APPEND python_environment "LD_PRELOAD=${sanitizer}"
    "ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1")
elseif(MIEN_SANITIZE OR CMAKE_CROSSCOMPILING)
  set(python_tests)
endif()
foreach(name IN LISTS python_tests)
  add_test(NAME python_${name}_test
    COMMAND ${MIEN_PYTHON} ${integrations}/python/tests/${name}_test.py)
  set_tests_properties(python_${name}_test PROPERTIES
    LABELS python ENVIRONMENT "${python_environment}" TIMEOUT 600)
endforeach()
