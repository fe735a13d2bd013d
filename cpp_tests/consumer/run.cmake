# Configures, builds and runs the consumer project in one way.
#   cmake -DSOURCE=... -DBINARY=... -DWAY=... -DLINKAGE=... -DPREFIX=... -DLIBDIR=... -DHOLEFILL_SOURCE=...
#         -DTARGET_DIR=... -DPROFILE=... -DGENERATOR=... -P run.cmake

file(REMOVE_RECURSE "${BINARY}")
set(ENV{PKG_CONFIG_PATH} "${PREFIX}/${LIBDIR}/pkgconfig")
# The loader finds the installed library by the path that CMake puts into the program.
execute_process(
  COMMAND "${CMAKE_COMMAND}" -S "${SOURCE}" -B "${BINARY}" -G "${GENERATOR}" -DWAY=${WAY} -DLINKAGE=${LINKAGE}
          -DHOLEFILL_SOURCE=${HOLEFILL_SOURCE} -DHOLEFILL_CARGO_TARGET_DIR=${TARGET_DIR}
          -DHOLEFILL_CARGO_PROFILE=${PROFILE} -DCMAKE_PREFIX_PATH=${PREFIX}
          COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_COMMAND}" --build "${BINARY}" COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_CTEST_COMMAND}" --output-on-failure WORKING_DIRECTORY "${BINARY}"
                COMMAND_ERROR_IS_FATAL ANY)
# The static program must not need the shared library.
if(LINKAGE STREQUAL "static")
  find_program(READELF readelf)
  if(READELF)
    execute_process(COMMAND "${READELF}" -d "${BINARY}/consumer" OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
    if(dynamic MATCHES "libholefill")
      message(FATAL_ERROR "the static program needs the shared library")
    endif()
  endif()
endif()
