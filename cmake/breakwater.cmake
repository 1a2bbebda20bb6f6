# The verbs the top-level file is written in. Programs state in a head line what they need:
#   BUILD modules=probe,ns_channel libs=gsl          what is linked besides their own module
#   BUILD case=porous_breakup                        all sources of that case but its main
#   TEST  ranks=1,2 timeout=7200 args="--check"      how ctest runs them; every test says its ranks
include(GNUInstallDirs)
include(cmake/mpi.cmake)
include(cmake/external.cmake)

set(CMAKE_C_STANDARD 11)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Fuzzers need sanitizers, and an engine where the compiler brings one.
if(BW_FUZZ)
  set(BW_SANITIZE ON)
  include(CheckCSourceCompiles)
  set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
  check_c_source_compiles(
    "#include <stddef.h>
     int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);
     int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size) { return !data && size; }"
    BW_FUZZ_ENGINE)
  unset(CMAKE_REQUIRED_FLAGS)
endif()

add_library(bw_flags INTERFACE)
target_compile_options(bw_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  -Wno-psabi # vectors are returned by inline functions alone: no interface depends on how
  -fno-semantic-interposition # a function of ours is the one of this name, in the shared library too
  -fno-math-errno -fno-trapping-math -fopenmp-simd -fno-common
  $<$<STREQUAL:${BW_MPI},MPICH>:-Wno-stringop-overflow> # its MPI_STATUSES_IGNORE is the address 1
  $<$<BOOL:${BW_WERROR}>:-Werror> $<$<BOOL:${BW_NATIVE}>:-march=native>
  $<$<CONFIG:Release>:-O3> $<$<BOOL:${BW_SANITIZE}>:-fsanitize=address,undefined>
  $<$<BOOL:${BW_SANITIZE}>:-fno-omit-frame-pointer>)
if(BW_FUZZ)
  target_compile_options(bw_flags INTERFACE -g -fno-sanitize-recover=undefined
    $<$<BOOL:${BW_FUZZ_ENGINE}>:-fsanitize=fuzzer-no-link>)
endif()
target_compile_definitions(bw_flags INTERFACE _POSIX_C_SOURCE=200809L
  $<$<STREQUAL:${BW_PRECISION},single>:BW_SINGLE>)
target_link_options(bw_flags INTERFACE $<$<BOOL:${BW_SANITIZE}>:-fsanitize=address,undefined>)
target_link_libraries(bw_flags INTERFACE MPI::MPI_C m)

# The commit goes into the one source that writes run.yaml.
set(BW_VERSION_HEADER ${CMAKE_BINARY_DIR}/generated/bw_version.h)
add_custom_target(bw_version BYPRODUCTS ${BW_VERSION_HEADER}
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
          -DOUT=${BW_VERSION_HEADER} -P ${PROJECT_SOURCE_DIR}/cmake/commit.cmake)

# Headers are included as "bw_solid.h" or as <breakwater/bw_solid.h>.
set(BW_INSTALLED_INCLUDES $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                          $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/breakwater>)

# bw_module(name [DEPENDS module...] [PRIVATE_LIBS lib...] [OPTIONS option...]): modules/<name>/**.c
# become libbw_<name>.a, compiled with OPTIONS besides. What is installed of it: install.cmake.
function(bw_module name)
  cmake_parse_arguments(A "" "" "DEPENDS;PRIVATE_LIBS;OPTIONS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS modules/${name}/*.c)
  list(TRANSFORM A_DEPENDS PREPEND bw_)
  set(kind PUBLIC)
  if(sources)
    set_property(SOURCE ${sources} APPEND PROPERTY COMPILE_OPTIONS ${A_OPTIONS})
    add_library(bw_${name} STATIC ${sources})
    target_link_libraries(bw_${name} PRIVATE $<BUILD_INTERFACE:bw_flags> PUBLIC m)
    foreach(lib ${A_PRIVATE_LIBS})
      _bw_external(${lib})
      target_link_libraries(bw_${name} PRIVATE $<BUILD_INTERFACE:bw_ext_${lib}>
                                               $<INSTALL_INTERFACE:bw_ext_${lib}>)
    endforeach()
  else()
    add_library(bw_${name} INTERFACE)
    set(kind INTERFACE)
  endif()
  target_include_directories(bw_${name} ${kind} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/modules/${name}>
                             ${BW_INSTALLED_INCLUDES})
  target_link_libraries(bw_${name} ${kind} ${A_DEPENDS} MPI::MPI_C)
  target_compile_definitions(bw_${name} ${kind} $<$<STREQUAL:${BW_PRECISION},single>:BW_SINGLE>)
  set_target_properties(bw_${name} PROPERTIES EXPORT_NAME ${name})
  add_library(bw::${name} ALIAS bw_${name})
  set_property(GLOBAL APPEND PROPERTY BW_MODULES ${name})
  set_property(GLOBAL APPEND PROPERTY BW_SOURCES ${sources})
  set_property(GLOBAL APPEND PROPERTY BW_LIBS ${A_PRIVATE_LIBS})
endfunction()

# bw_stamp(name source): compile this source of a module with the version and commit.
function(bw_stamp name source)
  add_dependencies(bw_${name} bw_version)
  set_property(SOURCE modules/${name}/${source} APPEND PROPERTY COMPILE_OPTIONS
               -include ${BW_VERSION_HEADER})
  set_property(SOURCE modules/${name}/${source} APPEND PROPERTY OBJECT_DEPENDS
               ${BW_VERSION_HEADER})
endfunction()

# Stop the configuration because of a head line, or where one is missing.
function(_bw_head_error file)
  file(RELATIVE_PATH place ${PROJECT_SOURCE_DIR} ${file})
  list(JOIN ARGN "" what)
  message(FATAL_ERROR " ${place}: ${what}") # after a space CMake leaves the line whole
endfunction()

# One word KEY=VALUE of a head line: is the key known here, and the value one of its kind?
function(_bw_head_word file word key value)
  if(word STREQUAL "TEST" AND key STREQUAL "ranks")
    set(kind "whole numbers with commas between, e.g. ranks=1,2,4")
    set(pattern "^[1-9][0-9]*(,[1-9][0-9]*)*$")
  elseif(word STREQUAL "TEST" AND key STREQUAL "timeout")
    # a limit ends what hangs; whether a machine is busy must not matter
    set(kind "seconds, ${BW_LEAST_TIMEOUT} at least")
    set(pattern "^[1-9][0-9]*$")
    if(value MATCHES "${pattern}" AND value LESS BW_LEAST_TIMEOUT)
      _bw_head_error(${file} "TEST ${key}=${value} must be ${kind}")
    endif()
  elseif(word STREQUAL "TEST" AND key STREQUAL "args")
    set(kind "what the program is started with, e.g. args=\"--check\"")
    set(pattern ".")
  elseif(word STREQUAL "BUILD" AND key MATCHES "^(modules|libs|case)$")
    set(kind "names with commas between")
    set(pattern "^[A-Za-z0-9_.-]+(,[A-Za-z0-9_.-]+)*$")
  elseif(word STREQUAL "TEST")
    _bw_head_error(${file} "TEST has the keys ranks, timeout and args, not ${key}")
  else()
    _bw_head_error(${file} "BUILD has the keys modules, libs and case, not ${key}")
  endif()
  if(NOT value MATCHES "${pattern}")
    _bw_head_error(${file} "${word} ${key}=${value} must be ${kind}")
  endif()
endfunction()

# What BUILD names must be there.
function(_bw_head_names file modules case)
  foreach(module ${modules})
    if(NOT TARGET bw_${module})
      _bw_head_error(${file} "BUILD modules=${module}: there is no such module")
    endif()
  endforeach()
  if(case AND NOT IS_DIRECTORY ${PROJECT_SOURCE_DIR}/cases/${case})
    _bw_head_error(${file} "BUILD case=${case}: there is no such folder of cases/")
  endif()
endfunction()

# Reads the head of a program: head_ranks, head_timeout, head_args, head_modules, head_libs,
# head_case, those not said being empty. A head is a line of its own, ` * TEST key=value ...` or
# ` * BUILD ...`, one of each at most. What cannot be read stops the configuration: a head that was
# overlooked would be a test that does not run.
function(_bw_read_head file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  foreach(key ranks timeout args modules libs case)
    set(head_${key} "")
  endforeach()
  file(STRINGS ${file} lines REGEX "^[ /*]*(TEST|BUILD)([^A-Za-z0-9_]|$)|(TEST|BUILD)[ ]+[A-Za-z]+[ ]*=")
  set(words_seen "")
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "^[ /*]*(TEST|BUILD)([^*]*)")
      _bw_head_error(${file} "TEST and BUILD begin a line of their own, not as in: ${line}")
    endif()
    set(word ${CMAKE_MATCH_1})
    string(STRIP "${CMAKE_MATCH_2}" rest)
    if(word IN_LIST words_seen)
      _bw_head_error(${file} "a second line of ${word}: ${line}")
    endif()
    list(APPEND words_seen ${word})
    while(NOT rest STREQUAL "")
      if(NOT rest MATCHES "^([a-z]+)=(\"([^\"]*)\"|[^ \"]+)[ ]*(.*)$")
        _bw_head_error(${file} "${word} is followed by words key=value, not by: ${rest}")
      endif()
      set(key ${CMAKE_MATCH_1})
      set(value "${CMAKE_MATCH_2}")
      set(rest "${CMAKE_MATCH_4}")
      string(REPLACE "\"" "" value "${value}")
      _bw_head_word(${file} ${word} ${key} "${value}")
      if(NOT head_${key} STREQUAL "")
        _bw_head_error(${file} "${word} says ${key} twice")
      endif()
      if(NOT key STREQUAL "args")
        string(REPLACE "," ";" value "${value}")
      endif()
      set(head_${key} "${value}")
    endwhile()
  endforeach()
  _bw_head_names(${file} "${head_modules}" "${head_case}")
  foreach(key ranks timeout args modules libs case)
    set(head_${key} "${head_${key}}" PARENT_SCOPE)
  endforeach()
endfunction()

# A program of one or more sources, linked as the head of the first one says.
function(_bw_program target own head)
  add_executable(${target} ${head} ${ARGN})
  _bw_read_head(${head})
  if(head_case)
    file(GLOB parts CONFIGURE_DEPENDS cases/${head_case}/*.c)
    list(FILTER parts EXCLUDE REGEX "/${head_case}\\.c$")
    target_sources(${target} PRIVATE ${parts})
    target_include_directories(${target} PRIVATE cases/${head_case})
  endif()
  list(TRANSFORM head_modules PREPEND bw_)
  foreach(lib ${head_libs})
    _bw_external(${lib})
  endforeach()
  list(TRANSFORM head_libs PREPEND bw_ext_)
  if(own)
    list(PREPEND head_modules bw_${own})
  endif()
  list(APPEND head_modules bw_core)
  if(BW_HWCAPS)
    set(head_modules breakwater) # of which the dynamic linker takes the one for its processor
  endif()
  target_link_libraries(${target} PRIVATE ${head_modules} ${head_libs} bw_flags)
endfunction()

file(WRITE ${CMAKE_BINARY_DIR}/programs.txt "")
set(BW_MPI_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1
    OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_hwloc_base_binding_policy=none
    BW_SOURCE_DIR=${PROJECT_SOURCE_DIR} BW_BUILD_DIR=${CMAKE_BINARY_DIR})

# Time limits are there for what hangs: no test may fail because the machine has other work as well.
# A test has twenty minutes, ten times and more what it takes on a quiet machine; the head of one
# that takes longer than two asks for more.
set(BW_LEAST_TIMEOUT 600)
set(BW_TIMEOUT 1200)
set(BW_SCRIPT_TIMEOUT 3600)

# One ctest per number of ranks named in the head. build/programs.txt gets a line for ./run:
# the program, the numbers of ranks with commas between.
function(_bw_run label name target head)
  _bw_read_head(${head})
  if(NOT head_ranks)
    _bw_head_error(${head} "has no line ` * TEST ranks=...` that says on how many ranks it runs")
  endif()
  if(NOT head_timeout)
    set(head_timeout ${BW_TIMEOUT})
  endif()
  separate_arguments(args UNIX_COMMAND "${head_args}")
  # On few ranks, two where it can be: what the other presets run of each program.
  list(GET head_ranks -1 head_few)
  if(2 IN_LIST head_ranks)
    set(head_few 2)
  endif()
  foreach(np ${head_ranks})
    add_test(NAME ${label}.${name}.np${np}
             COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${np} $<TARGET_FILE:${target}> ${args}
             WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
    set(labels ${label})
    if(np EQUAL head_few)
      list(APPEND labels ${label}.few)
    endif()
    set_tests_properties(${label}.${name}.np${np} PROPERTIES LABELS "${labels}" PROCESSORS ${np}
                         TIMEOUT ${head_timeout} ENVIRONMENT "${BW_MPI_ENVIRONMENT}"
                         RESOURCE_LOCK ${label}.${name}) # its files are the same on any np
  endforeach()
  list(JOIN head_ranks "," ranks)
  file(APPEND ${CMAKE_BINARY_DIR}/programs.txt "${target} ${ranks}\n")
endfunction()

# cases/NAME/NAME.c and its companions: build/bin/NAME
function(bw_cases)
  file(GLOB heads CONFIGURE_DEPENDS cases/*/*.c)
  foreach(head ${heads})
    get_filename_component(name ${head} NAME_WE)
    get_filename_component(folder ${head} DIRECTORY)
    get_filename_component(folder_name ${folder} NAME)
    if(name STREQUAL folder_name)
      file(GLOB others CONFIGURE_DEPENDS ${folder}/*.c)
      list(REMOVE_ITEM others ${head})
      _bw_program(${name} "" ${head} ${others})
      set_property(GLOBAL APPEND PROPERTY BW_PROGRAMS ${name})
    endif()
  endforeach()
endfunction()

# tests/unit/MODULE/test_X.c with Check
function(bw_unit_tests)
  _bw_external(check)
  file(GLOB heads CONFIGURE_DEPENDS tests/unit/*/test_*.c tests/mpi/test_*.c)
  foreach(head ${heads})
    get_filename_component(name ${head} NAME_WE)
    get_filename_component(folder ${head} DIRECTORY)
    get_filename_component(module ${folder} NAME)
    set(label unit)
    set(own ${module})
    if(module STREQUAL "mpi")
      set(label mpi)
      set(own "")
    endif()
    _bw_program(${name} "${own}" ${head})
    target_include_directories(${name} PRIVATE tests/support)
    target_link_libraries(${name} PRIVATE bw_ext_check)
    _bw_run(${label} ${module}.${name} ${name} ${head})
  endforeach()
  _bw_program(fails_on_one_rank "" ${PROJECT_SOURCE_DIR}/tests/support/fails_on_one_rank.c) # of robustness.assertion
  target_link_libraries(fails_on_one_rank PRIVATE bw_ext_check)
  foreach(name no_memory bad_disk count_memory) # of the tests of these names in robustness
    add_library(${name} MODULE ${PROJECT_SOURCE_DIR}/tests/support/${name}.c)
    target_link_libraries(${name} PRIVATE bw_flags ${CMAKE_DL_LIBS})
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
  endforeach()
endfunction()

# validation/MODULE/CLAIM.c: the quick form is a test, `run validate --full` gives --full. After
# them all, the report of what they found.
function(bw_validations)
  add_library(bw_validation STATIC validation/support/bw_validation.c)
  target_include_directories(bw_validation PUBLIC validation/support)
  target_link_libraries(bw_validation PUBLIC bw_core PRIVATE bw_flags)
  file(GLOB heads CONFIGURE_DEPENDS validation/*/*.c)
  foreach(head ${heads})
    get_filename_component(name ${head} NAME_WE)
    get_filename_component(folder ${head} DIRECTORY)
    get_filename_component(module ${folder} NAME)
    if(NOT module STREQUAL "support")
      set(target val_${module}_${name})
      _bw_program(${target} ${module} ${head})
      target_link_libraries(${target} PRIVATE bw_validation)
      _bw_run(validation ${module}.${name} ${target} ${head})
    endif()
  endforeach()
  get_directory_property(claims TESTS)
  list(FILTER claims INCLUDE REGEX "^validation\\.")
  add_test(NAME validation.report
           COMMAND /usr/bin/python3 tools/report.py ${CMAKE_BINARY_DIR}/verification
           WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(validation.report PROPERTIES LABELS validation DEPENDS "${claims}")
endfunction()

# bench/NAME.c: build/bin/bench_NAME, run by `./run bench NAME`; no test fails on a clock
function(bw_benches)
  add_library(bw_bench STATIC bench/support/bw_bench.c)
  target_include_directories(bw_bench PUBLIC bench/support)
  target_link_libraries(bw_bench PUBLIC bw_core PRIVATE bw_flags)
  file(GLOB heads CONFIGURE_DEPENDS bench/*.c)
  foreach(head ${heads})
    get_filename_component(name ${head} NAME_WE)
    _bw_program(bench_${name} "" ${head})
    target_link_libraries(bench_${name} PRIVATE bw_bench)
  endforeach()
endfunction()

# docs/examples/*.c: what a user's program looks like; run as tests
function(bw_examples)
  file(GLOB heads CONFIGURE_DEPENDS docs/examples/*.c)
  foreach(head ${heads})
    get_filename_component(name ${head} NAME_WE)
    _bw_program(example_${name} "" ${head})
    _bw_run(example ${name} example_${name} ${head})
  endforeach()
endfunction()

# tests/fuzz/fuzz_NAME.c: build/bin/fuzz_NAME, and a test that runs its seeds and some thousand inputs
# made of them. BW_FUZZ=ON: everything with sanitizers and with libFuzzer (clang) or AFL++, where the
# compiler has one of them; else with the driver that the test uses (tests/fuzz/README.md).
function(bw_fuzzers)
  set(driver tests/fuzz/driver.c)
  if(BW_FUZZ_ENGINE)
    set(driver "")
  endif()
  file(GLOB heads CONFIGURE_DEPENDS tests/fuzz/fuzz_*.c)
  foreach(head ${heads})
    get_filename_component(name ${head} NAME_WE)
    string(REPLACE "fuzz_" "" short ${name})
    _bw_program(${name} "" ${head} tests/fuzz/fuzz.c ${driver})
    set(runs 3000)
    if(short MATCHES "checkpoint|restart") # each input is a file of HDF5
      set(runs 300)
    endif()
    set(amount --runs=${runs})
    if(BW_FUZZ_ENGINE)
      target_link_options(${name} PRIVATE -fsanitize=fuzzer)
      set(amount -runs=${runs} -max_len=4096 -timeout=20)
    endif()
    add_test(NAME fuzz.${short}
             COMMAND ${name} ${amount} ${PROJECT_SOURCE_DIR}/tests/fuzz/seeds/${short}
             WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
    set_tests_properties(fuzz.${short} PROPERTIES LABELS fuzz TIMEOUT ${BW_TIMEOUT} ENVIRONMENT
                         "${BW_MPI_ENVIRONMENT};ASAN_OPTIONS=detect_leaks=0")
  endforeach()
endfunction()

# tests/{mpi,restart,robustness,lint}/*.sh: one test per script; arguments: source and build folder.
function(bw_scripted_tests)
  file(GLOB scripts CONFIGURE_DEPENDS tests/mpi/*.sh tests/restart/*.sh tests/robustness/*.sh tests/lint/*.sh)
  foreach(script ${scripts})
    get_filename_component(name ${script} NAME_WE)
    get_filename_component(folder ${script} DIRECTORY)
    get_filename_component(label ${folder} NAME)
    add_test(NAME ${label}.${name}
             COMMAND sh ${script} ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR})
    # A lint is one process that reads; other scripts start runs on several ranks.
    set(processors 2)
    if(label STREQUAL lint)
      set(processors 1)
    endif()
    set_tests_properties(${label}.${name} PROPERTIES LABELS ${label} PROCESSORS ${processors}
                         TIMEOUT ${BW_SCRIPT_TIMEOUT}
                         ENVIRONMENT "${BW_MPI_ENVIRONMENT}")
  endforeach()
endfunction()
