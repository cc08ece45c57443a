# SPDX-License-Identifier: MIT
# Tests of what stands on mien.h in other languages; tests/CMakeLists.txt includes this.

set(integrations ${PROJECT_SOURCE_DIR}/integrations)

# ---- the interface as data --------------------------------------------------------------------------

add_test(NAME api_json
  COMMAND Python3::Interpreter ${integrations}/api/dump_api.py --check)
set_tests_properties(api_json PROPERTIES LABELS guard)
add_test(NAME api_compatible
  COMMAND Python3::Interpreter ${integrations}/api/check_compatible.py)
add_test(NAME api_compatible_self_test
  COMMAND Python3::Interpreter ${integrations}/api/check_compatible.py --self-test)
set_tests_properties(api_compatible api_compatible_self_test PROPERTIES LABELS guard)
add_test(NAME api_conventions
  COMMAND Python3::Interpreter ${integrations}/api/conventions_test.py)
set_tests_properties(api_conventions PROPERTIES LABELS guard)
add_test(NAME api_statuses
  COMMAND Python3::Interpreter ${integrations}/api/check_statuses.py --self-test)
set_tests_properties(api_statuses PROPERTIES LABELS guard)
add_test(NAME api_layout
  COMMAND Python3::Interpreter ${integrations}/api/layout_test.py ${CMAKE_C_COMPILER})
set_tests_properties(api_layout PROPERTIES LABELS abi)
# clang compiles for any machine without its C library.
find_program(MIEN_CLANG clang)
if(MIEN_CLANG)
  foreach(target wasm32 armv7-none-eabihf)
    add_test(NAME api_layout_32_${target}
      COMMAND Python3::Interpreter ${integrations}/api/layout_test.py --32
        ${MIEN_CLANG} --target=${target})
    set_tests_properties(api_layout_32_${target} PROPERTIES LABELS abi)
  endforeach()
else()
  message(STATUS "NOT TESTED: layouts of structs on 32-bit machines; there is no clang")
endif()

add_test(NAME api_bindings
  COMMAND Python3::Interpreter ${integrations}/api/check_bindings.py --self-test)
add_test(NAME api_generated
  COMMAND Python3::Interpreter ${integrations}/api/generate.py --check all)
add_test(NAME api_templates
  COMMAND Python3::Interpreter ${integrations}/api/generate_test.py)
set_tests_properties(api_bindings api_generated api_templates PROPERTIES LABELS guard)

# ---- Python -----------------------------------------------------------------------------------------

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
set(python_tests author callbacks clip deformer document farm fit lifetime mapping misuse mix torch values wheel)
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
foreach(name torch wheel)
  if(name IN_LIST python_tests)
    set_property(TEST python_${name}_test APPEND PROPERTY LABELS all)
  endif()
endforeach()
if(MIEN_SANITIZE MATCHES "address")
  set_property(TEST python_callbacks_test python_lifetime_test python_misuse_test APPEND PROPERTY LABELS sanitized)
endif()

# ---- C++ --------------------------------------------------------------------------------------------

# mien.hpp promises to compile in four ways, without a warning.
set(strict_cxx -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Wcast-qual -Werror)
foreach(standard 17 20)
  foreach(way plain exceptions)
    set(name cpp_${way}_${standard}_test)
    add_executable(${name} ${integrations}/cpp/mien_test.cpp)
    set_target_properties(${name} PROPERTIES CXX_STANDARD ${standard})
    target_compile_options(${name} PRIVATE ${quick} ${strict_cxx})
    target_include_directories(${name} PRIVATE ${integrations}/cpp)
    target_link_libraries(${name} PRIVATE mien_author)
    if(way STREQUAL exceptions)
      target_compile_definitions(${name} PRIVATE MIEN_EXCEPTIONS)
    else()
      target_compile_options(${name} PRIVATE -fno-exceptions -fno-rtti)
    endif()
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS abi)
  endforeach()
endforeach()

add_executable(cpp_solve_test ${integrations}/cpp/mien_solve_test.cpp)
set_target_properties(cpp_solve_test PROPERTIES CXX_STANDARD 17)
target_compile_options(cpp_solve_test PRIVATE ${quick} ${strict_cxx} -fno-exceptions -fno-rtti)
target_include_directories(cpp_solve_test PRIVATE ${integrations}/cpp)
target_link_libraries(cpp_solve_test PRIVATE mien_author mien_solve)
add_test(NAME cpp_solve_test COMMAND cpp_solve_test)
set_tests_properties(cpp_solve_test PROPERTIES LABELS abi)

# Both ways in one program.
add_library(cpp_linking_exceptions OBJECT ${integrations}/cpp/linking_test.cpp)
set_target_properties(cpp_linking_exceptions PROPERTIES CXX_STANDARD 20)
target_compile_definitions(cpp_linking_exceptions PRIVATE MIEN_EXCEPTIONS)
add_executable(cpp_linking_test ${integrations}/cpp/linking_test.cpp)
set_target_properties(cpp_linking_test PROPERTIES CXX_STANDARD 17)
target_link_libraries(cpp_linking_test PRIVATE cpp_linking_exceptions)
foreach(name cpp_linking_exceptions cpp_linking_test)
  target_compile_options(${name} PRIVATE ${strict_cxx})
  target_include_directories(${name} PRIVATE ${integrations}/cpp)
  target_link_libraries(${name} PRIVATE mien)
endforeach()
add_test(NAME cpp_linking_test COMMAND cpp_linking_test)
set_tests_properties(cpp_linking_test PROPERTIES LABELS abi)

add_executable(example_cpp ${PROJECT_SOURCE_DIR}/examples/evaluate.cpp)
add_executable(example_mix_cpp ${PROJECT_SOURCE_DIR}/examples/mix.cpp)
add_executable(example_solve_cpp ${PROJECT_SOURCE_DIR}/examples/solve.cpp)
foreach(name example_cpp example_mix_cpp example_solve_cpp)
  target_compile_options(${name} PRIVATE ${strict_cxx})
  target_include_directories(${name} PRIVATE ${integrations}/cpp)
  target_link_libraries(${name} PRIVATE mien_author)
endforeach()
target_link_libraries(example_solve_cpp PRIVATE mien_solve)

add_executable(example_engine ${PROJECT_SOURCE_DIR}/examples/engine/engine.cpp)
target_compile_options(example_engine PRIVATE ${strict_cxx})
target_include_directories(example_engine PRIVATE ${integrations}/cpp)
target_link_libraries(example_engine PRIVATE mien_author Threads::Threads)
if(NOT CMAKE_CROSSCOMPILING)
  add_test(NAME example_engine COMMAND example_engine --check --pak ${PROJECT_BINARY_DIR}/example_engine.pak)
  set_tests_properties(example_engine PROPERTIES LABELS abi TIMEOUT 300)
endif()

# ---- the examples -----------------------------------------------------------------------------------

if(NOT MIEN_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
  find_program(MIEN_CARGO cargo)
  find_program(MIEN_LUAJIT luajit)
  find_program(MIEN_MCS mcs)
  find_program(MIEN_MONO mono)
  find_program(MIEN_GO go)
  # Go keeps what it compiled beside the build.
  set(go_environment "GOCACHE=${PROJECT_BINARY_DIR}/go" "GOFLAGS=-mod=mod" "GOPROXY=off"
    "CGO_CFLAGS=-O1 -I${PROJECT_SOURCE_DIR}/capi/include" "CGO_LDFLAGS=-L$<TARGET_FILE_DIR:mien>"
    "LD_LIBRARY_PATH=$<TARGET_FILE_DIR:mien>")
  set(examples_environment ${python_environment} ${go_environment} "MIEN_LIB_DIR=$<TARGET_FILE_DIR:mien>"
    "CARGO_TARGET_DIR=${PROJECT_BINARY_DIR}/rust/target/shared")
  set(examples_command ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/examples/examples_agree.py --python ${MIEN_PYTHON}
    --cargo "$<$<BOOL:${MIEN_CARGO}>:${MIEN_CARGO}>"
    --luajit "$<$<BOOL:${MIEN_LUAJIT}>:${MIEN_LUAJIT}>"
    --go "$<$<BOOL:${MIEN_GO}>:${MIEN_GO}>"
    --mcs "$<$<BOOL:${MIEN_MCS}>:${MIEN_MCS}>" --mono "$<$<BOOL:${MIEN_MONO}>:${MIEN_MONO}>"
    --programs $<TARGET_FILE_DIR:example_c>)
  add_test(NAME examples_agree COMMAND ${examples_command})
  set_tests_properties(examples_agree PROPERTIES LABELS abi TIMEOUT 600 ENVIRONMENT "${examples_environment}")
  # The same with the npm package, for ./dev test --all: examples_agree.sh --web PACKAGE
  list(JOIN examples_environment "' '" quoted_environment)
  list(JOIN examples_command "' '" quoted_command)
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/examples_agree.sh
    CONTENT "exec env '${quoted_environment}' '${quoted_command}' \"$@\"\n")
endif()

# ---- types of the Python package --------------------------------------------------------------------

find_program(MIEN_MYPY mypy)
if(MIEN_MYPY)
  add_test(NAME python_types
    COMMAND ${MIEN_MYPY} --config-file ${integrations}/python/pyproject.toml
      --cache-dir ${PROJECT_BINARY_DIR}/mypy ${integrations}/python/mien)
  set_tests_properties(python_types PROPERTIES LABELS python)
else()
  message(STATUS "NOT TESTED: types of the Python package; there is no mypy")
endif()

# Rust: rust/check.sh tests the crates; ./dev test --all calls it where there is a cargo.

# ---- Lua --------------------------------------------------------------------------------------------

if(MIEN_SANITIZE OR CMAKE_CROSSCOMPILING)
  # LuaJIT is neither built with sanitizers nor for other machines.
elseif(MIEN_LUAJIT)
  foreach(name lifetime misuse values)
    add_test(NAME lua_${name}_test COMMAND ${MIEN_LUAJIT} ${integrations}/lua/tests/${name}_test.lua)
    set_tests_properties(lua_${name}_test PROPERTIES LABELS abi TIMEOUT 120 ENVIRONMENT
      "MIEN_LIBRARY=$<TARGET_FILE:mien>;LUA_PATH=${integrations}/lua/?.lua\\;${integrations}/lua/tests/?.lua")
  endforeach()
else()
  message(STATUS "NOT TESTED: the Lua binding; there is no luajit")
endif()

# ---- C# ---------------------------------------------------------------------------------------------

add_test(NAME csharp_project COMMAND Python3::Interpreter ${integrations}/csharp/tests/project_test.py
  "$<$<BOOL:${MIEN_MCS}>:${MIEN_MCS}>" "$<$<BOOL:${MIEN_MONO}>:${MIEN_MONO}>")
set_tests_properties(csharp_project PROPERTIES LABELS guard)
if(MIEN_SANITIZE OR CMAKE_CROSSCOMPILING)
  # Mono is neither built with sanitizers nor for other machines.
elseif(MIEN_MCS AND MIEN_MONO)
  add_test(NAME csharp_build COMMAND ${MIEN_MCS} -unsafe -langversion:latest -warnaserror -nowarn:219
    -out:${PROJECT_BINARY_DIR}/csharp_tests.exe
    -recurse:${integrations}/csharp/Mien/*.cs -recurse:${integrations}/csharp/tests/*.cs)
  set_tests_properties(csharp_build PROPERTIES LABELS abi FIXTURES_SETUP csharp)
  add_test(NAME csharp_test COMMAND ${MIEN_MONO} --debug ${PROJECT_BINARY_DIR}/csharp_tests.exe)
  set_tests_properties(csharp_test PROPERTIES LABELS abi FIXTURES_REQUIRED csharp TIMEOUT 120
    ENVIRONMENT "LD_LIBRARY_PATH=$<TARGET_FILE_DIR:mien>")
  add_test(NAME unity_package_test
    COMMAND Python3::Interpreter ${integrations}/unity/tests/package_test.py $<TARGET_FILE:mien>)
  set_tests_properties(unity_package_test PROPERTIES LABELS abi)
  # The package for Unity against stubs; what Unity sets from outside is never assigned there.
  add_test(NAME unity_build COMMAND ${MIEN_MCS} -unsafe -langversion:latest -warnaserror -nowarn:219,414,649
    -out:${PROJECT_BINARY_DIR}/unity_host.exe -recurse:${integrations}/csharp/Mien/*.cs
    -recurse:${integrations}/unity/package/*.cs -recurse:${integrations}/unity/tests/*.cs)
  set_tests_properties(unity_build PROPERTIES LABELS abi FIXTURES_SETUP unity)
  add_test(NAME unity_test COMMAND ${MIEN_MONO} --debug ${PROJECT_BINARY_DIR}/unity_host.exe)
  set_tests_properties(unity_test PROPERTIES LABELS abi FIXTURES_REQUIRED unity TIMEOUT 120
    ENVIRONMENT "LD_LIBRARY_PATH=$<TARGET_FILE_DIR:mien>")
else()
  message(STATUS "NOT TESTED: the C# binding and the package for Unity; there is no mcs and mono")
endif()

# ---- Godot -----------------------------------------------------------------------------------------

# The extension with a host that plays Godot.
if(NOT CMAKE_CROSSCOMPILING)
  set(godot4 extension face godot importer mien_face_3d node surface tests/host tests/host_classes tests/host_methods
    tests/host_values)
  list(TRANSFORM godot4 PREPEND ${integrations}/godot/)
  list(TRANSFORM godot4 APPEND .c)
  add_executable(godot_test ${godot4})
  target_link_libraries(godot_test PRIVATE mien_author m)
  add_test(NAME godot_test COMMAND godot_test ${CMAKE_CURRENT_BINARY_DIR})
  set_tests_properties(godot_test PROPERTIES LABELS abi TIMEOUT 120)
  # The class for Godot 3, run by its editor and a script.
  add_library(mien_godot3 MODULE EXCLUDE_FROM_ALL ${integrations}/godot/face.c ${integrations}/godot/godot3/mien_face.c)
  set_target_properties(mien_godot3 PROPERTIES BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH "$ORIGIN")
  target_link_libraries(mien_godot3 PRIVATE mien)
  find_program(MIEN_GODOT3 godot3-server)
  if(MIEN_GODOT3 AND NOT MIEN_SANITIZE)
    set_target_properties(mien_godot3 PROPERTIES EXCLUDE_FROM_ALL OFF)
    add_test(NAME godot3_test COMMAND ${MIEN_PYTHON} ${integrations}/godot/tests/godot3_test.py
      $<TARGET_FILE:mien_godot3> $<TARGET_FILE:mien>)
    set_tests_properties(godot3_test PROPERTIES LABELS full TIMEOUT 200 SKIP_RETURN_CODE 77
      ENVIRONMENT "${python_environment}")
  else()
    message(STATUS "NOT TESTED: the class for Godot 3; it needs godot3-server and no sanitizers")
  endif()
endif()

# ---- Unreal Engine ---------------------------------------------------------------------------------

# The plugin against stubs of the engine's headers.
if(NOT CMAKE_CROSSCOMPILING)
  set(unreal ${integrations}/unreal/Mien/Source)
  add_executable(unreal_test ${unreal}/MienFace/Private/AnimNode_Mien.cpp
    ${unreal}/MienFace/Private/MienFaceComponent.cpp ${unreal}/MienFace/Private/MienModule.cpp
    ${unreal}/MienFaceEditor/Private/AnimGraphNode_Mien.cpp ${unreal}/MienFaceEditor/Private/MienEditorModule.cpp
    ${integrations}/unreal/tests/host.cpp)
  target_include_directories(unreal_test PRIVATE ${unreal}/MienFace/Public ${unreal}/MienFaceEditor/Public
    ${integrations}/unreal/tests/stubs)
  target_compile_options(unreal_test PRIVATE -frtti)
  target_link_libraries(unreal_test PRIVATE mien_author)
  add_test(NAME unreal_test COMMAND unreal_test ${CMAKE_CURRENT_BINARY_DIR})
  set_tests_properties(unreal_test PROPERTIES LABELS abi TIMEOUT 120)
  if(MIEN_INSTALL AND NOT MIEN_SANITIZE)
    add_test(NAME unreal_plugin_test
      COMMAND Python3::Interpreter ${integrations}/unreal/tests/plugin_test.py ${PROJECT_BINARY_DIR}
        "$<$<BOOL:${MIEN_MCS}>:${MIEN_MCS}>" "$<$<BOOL:${MIEN_MONO}>:${MIEN_MONO}>")
    set_tests_properties(unreal_plugin_test PROPERTIES LABELS abi TIMEOUT 120)
  endif()
endif()

# ---- Go ---------------------------------------------------------------------------------------------

if(MIEN_SANITIZE OR CMAKE_CROSSCOMPILING)
  # Go is neither built with these sanitizers nor for other machines.
elseif(MIEN_GO)
  add_test(NAME go_test COMMAND ${MIEN_GO} test -vet=all ./... WORKING_DIRECTORY ${integrations}/go)
  # The first run compiles Go's own library for the race detector.
  add_test(NAME go_race_test COMMAND ${MIEN_GO} test -race . WORKING_DIRECTORY ${integrations}/go)
  set_tests_properties(go_test go_race_test PROPERTIES LABELS abi TIMEOUT 600 ENVIRONMENT "${go_environment}")
  set_property(TEST go_race_test APPEND PROPERTY LABELS slow)
else()
  message(STATUS "NOT TESTED: the Go binding; there is no go")
endif()

# JavaScript: web/tests test the package; ./dev test --all runs them where there is an emcc.

# CI runs the other languages and engines. Python, C and C++ are what ./dev test runs.
foreach(name examples_agree python_types lua_lifetime_test lua_misuse_test lua_values_test csharp_build csharp_test
    unity_build unity_package_test unity_test godot_test godot3_test unreal_test unreal_plugin_test go_test)
  if(TEST ${name})
    set_property(TEST ${name} APPEND PROPERTY LABELS all)
  endif()
endforeach()
