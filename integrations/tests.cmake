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
