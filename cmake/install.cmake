# What `cmake --install` puts into a prefix: programs, the modules as static libraries, all of them
# in one shared library, headers, case files, a package for find_package(Breakwater) with targets
# bw::MODULE and bw::breakwater (the shared one), and breakwater.pc. docs/install.md is the page.
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY BW_MODULES)
get_property(sources GLOBAL PROPERTY BW_SOURCES)
get_property(libs GLOBAL PROPERTY BW_LIBS)
list(REMOVE_DUPLICATES libs)
list(TRANSFORM modules PREPEND bw_ OUTPUT_VARIABLE targets)

# ---- the shared library -------------------------------------------------------------------------

# _bw_shared(target object...): one library libbreakwater.so of all modules
function(_bw_shared target)
  add_library(${target} SHARED ${ARGN})
  list(TRANSFORM libs REPLACE "(.+)" "$<BUILD_INTERFACE:bw_ext_\\1>" OUTPUT_VARIABLE needed)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:bw_flags> ${needed} PUBLIC MPI::MPI_C m)
  list(TRANSFORM modules REPLACE "(.+)" "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/modules/\\1>"
       OUTPUT_VARIABLE folders)
  target_include_directories(${target} PUBLIC ${folders}
                             ${BW_INSTALLED_INCLUDES})
  target_link_options(${target} PRIVATE $<$<NOT:$<BOOL:${BW_SANITIZE}>>:-Wl,-z,defs>) # nothing is left undefined
  target_compile_definitions(${target} PUBLIC $<$<STREQUAL:${BW_PRECISION},single>:BW_SINGLE>)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME breakwater LINKER_LANGUAGE C
                        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
endfunction()

list(TRANSFORM targets REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
_bw_shared(breakwater_library ${objects}) # the program of scenes has the plain name
set_target_properties(breakwater_library PROPERTIES EXPORT_NAME breakwater
                      LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
add_library(bw::breakwater ALIAS breakwater_library)

# The dynamic linker looks into glibc-hwcaps/LEVEL beside a library first and takes the highest level
# that the processor has: AVX2 from x86-64-v3 on, AVX-512 from x86-64-v4 on (ld.so(8), glibc 2.33).
if(BW_HWCAPS)
  if(BW_NATIVE)
    message(FATAL_ERROR " BW_HWCAPS chooses the instructions at start, BW_NATIVE when it is built: "
            "set one of them")
  endif()
  foreach(level x86-64-v3 x86-64-v4)
    _bw_shared(breakwater-${level} ${sources})
    add_dependencies(breakwater-${level} bw_version)
    target_compile_options(breakwater-${level} PRIVATE -march=${level})
    set_target_properties(breakwater-${level} PROPERTIES
                          LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/glibc-hwcaps/${level})
    install(TARGETS breakwater-${level}
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${level} NAMELINK_SKIP)
  endforeach()
endif()

# ---- what is installed --------------------------------------------------------------------------

get_property(programs GLOBAL PROPERTY BW_PROGRAMS)
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr") # where the dynamic linker looks by itself
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_FULL_BINDIR}
             OUTPUT_VARIABLE to_lib)
  set_target_properties(${programs} PROPERTIES INSTALL_RPATH "$ORIGIN/${to_lib}")
  set_target_properties(${programs} breakwater_library PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
endif()
install(TARGETS ${programs} RUNTIME)
install(TARGETS ${targets} breakwater_library EXPORT Breakwater)
install(EXPORT Breakwater NAMESPACE bw:: FILE BreakwaterTargets.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Breakwater)

# Headers of users, and those that the author of a law includes.
file(GLOB headers CONFIGURE_DEPENDS modules/*/bw_*.h)
list(APPEND headers modules/pd_body/pd_body.h modules/pd_body/pd_law.h modules/pd_body/pd_level.h
     modules/pd_body/pd_refine.h modules/pd_body/pd_springs.h modules/pd_body/pd_tensor_bound.h modules/pd_body/pd_walk.h)
install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/breakwater)

# A law is compiled for the blocks of the library it is linked with, whatever its own flags say. Which
# of the shared libraries of BW_HWCAPS runs is known at its start only: there the linker refuses one
# that does not fit (pd_law.h).
separate_arguments(flags NATIVE_COMMAND "${CMAKE_C_FLAGS}")
if(BW_NATIVE)
  list(APPEND flags -march=native)
endif()
if(BW_PRECISION STREQUAL "single")
  list(APPEND flags -DBW_SINGLE)
endif()
file(WRITE ${CMAKE_BINARY_DIR}/generated/lanes.c "#include \"pd_body.h\"\nlanes BW_PD_LANES\n")
execute_process(COMMAND ${CMAKE_C_COMPILER} ${flags} -E -P -I modules/core -I modules/particles
                        -I modules/pd_body ${CMAKE_BINARY_DIR}/generated/lanes.c
                WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE lanes COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCH "lanes ([248])" lanes "${lanes}")
set(lanes BW_PD_LANES=${CMAKE_MATCH_1})
target_compile_definitions(bw_pd_body PUBLIC $<INSTALL_INTERFACE:${lanes}>)
if(NOT BW_HWCAPS)
  target_compile_definitions(breakwater_library PUBLIC $<INSTALL_INTERFACE:${lanes}>)
endif()

# A manual page of each program is what it says to --help.
find_program(HELP2MAN help2man)
if(HELP2MAN AND NOT BW_SANITIZE)
  set(pages "")
  foreach(program ${programs})
    set(page ${CMAKE_BINARY_DIR}/man/${program}.1)
    add_custom_command(OUTPUT ${page}.gz DEPENDS ${program}
      COMMAND ${CMAKE_COMMAND} -E env ${BW_MPI_ENVIRONMENT} sh ${PROJECT_SOURCE_DIR}/cmake/manual.sh
              ${HELP2MAN} ${PROJECT_VERSION} $<TARGET_FILE:${program}> ${page})
    list(APPEND pages ${page}.gz)
  endforeach()
  add_custom_target(man ALL DEPENDS ${pages})
  install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()

file(GLOB folders CONFIGURE_DEPENDS cases/* scenes/*)
foreach(folder ${folders})
  if(IS_DIRECTORY ${folder})
    cmake_path(GET folder PARENT_PATH kind)
    cmake_path(GET kind FILENAME kind)
    install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_DATADIR}/breakwater/${kind}
            FILES_MATCHING PATTERN "*.yaml" PATTERN "*.nrrd" PATTERN "README.md"
            PATTERN "*.png" PATTERN "reference.csv")
  endif()
endforeach()
# The Python package as a source that pip takes; it finds templates and program from the prefix.
install(DIRECTORY python DESTINATION ${CMAKE_INSTALL_DATADIR}/breakwater
        PATTERN "__pycache__" EXCLUDE)
install(FILES README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})

# ---- how other projects find it -----------------------------------------------------------------

configure_package_config_file(cmake/BreakwaterConfig.cmake.in
  ${CMAKE_BINARY_DIR}/generated/BreakwaterConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Breakwater)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/generated/BreakwaterConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/generated/BreakwaterConfig.cmake
              ${CMAKE_BINARY_DIR}/generated/BreakwaterConfigVersion.cmake
              cmake/external.cmake cmake/mpi.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Breakwater)

# Paths of breakwater.pc are relative to where it lies, so that a prefix can be moved.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX} OUTPUT_VARIABLE pc_lib)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_INCLUDEDIR BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}
           OUTPUT_VARIABLE pc_include)
string(REGEX REPLACE "[^/]+" ".." pc_up "${pc_lib}/pkgconfig")
set(pc_define "")
if(BW_PRECISION STREQUAL "single")
  set(pc_define " -DBW_SINGLE")
endif()
if(NOT BW_HWCAPS)
  string(APPEND pc_define " -D${lanes}")
endif()
configure_file(cmake/breakwater.pc.in ${CMAKE_BINARY_DIR}/generated/breakwater.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/generated/breakwater.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# ---- a Debian package (./run package) -----------------------------------------------------------

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME breakwater)
set(CPACK_PACKAGE_CONTACT "the Breakwater developers <breakwater@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "fluid flow that bends and breaks solids")
set(CPACK_PACKAGE_DESCRIPTION "Direct numerical simulation of an incompressible flow,
coupled by an immersed boundary to solids of peridynamics
that crack, branch and shed fragments.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)
set(CPACK_STRIP_FILES ON)
file(WRITE ${CMAKE_BINARY_DIR}/generated/shlibs
     "libbreakwater ${PROJECT_VERSION_MAJOR} breakwater (>= ${PROJECT_VERSION})\n")
file(WRITE ${CMAKE_BINARY_DIR}/generated/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/generated/triggers
    ${CMAKE_BINARY_DIR}/generated/shlibs)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/changelog @ONLY CONTENT
       "breakwater (@PROJECT_VERSION@) unstable; urgency=low\n\n  * See CHANGELOG.md.\n\n\
 -- @CPACK_PACKAGE_CONTACT@  Sun, 29 Nov 2026 00:00:00 +0000\n")
  execute_process(COMMAND gzip -9nf changelog WORKING_DIRECTORY ${CMAKE_BINARY_DIR}/generated)
  install(FILES ${CMAKE_BINARY_DIR}/generated/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
  # Debian has the text of the licence itself: the lines above it say which, and why.
  file(READ LICENSE licence)
  string(REGEX REPLACE "\n-----.*" "" licence "${licence}")
  file(WRITE ${CMAKE_BINARY_DIR}/generated/copyright "${licence}\nThe text of the licence is in \
/usr/share/common-licenses/GPL-3.\n")
  install(FILES ${CMAKE_BINARY_DIR}/generated/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
else()
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()
include(CPack)
