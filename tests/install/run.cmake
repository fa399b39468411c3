# cmake -DBUILD=... -DSOURCE=... -DWORK=... -P run.cmake: installs into an empty prefix, builds the
# outside project against it and runs what came out.
cmake_policy(VERSION 3.25)
function(step)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(code)
        message(FATAL_ERROR "${ARGN}\nfailed (${code}):\n${out}")
    endif()
    set(output "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(COPY ${SOURCE}/tests/install/CMakeLists.txt ${SOURCE}/samples/hello_mirror/hello_mirror.cpp DESTINATION ${WORK}/outside)
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
step(${CMAKE_COMMAND} -S ${WORK}/outside -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix "-DCMAKE_CXX_FLAGS=${FLAGS}")
step(${CMAKE_COMMAND} --build ${WORK}/build)
# An outside program has not this tree's leak suppressions (cmake/sanitizer_support.cpp), and the driver
# leaks: with sanitizers everything but leaks is watched here.
set(environment)
if(FLAGS)
    set(environment ASAN_OPTIONS=detect_leaks=0)
endif()
step(${CMAKE_COMMAND} -E env ${environment} ${CMAKE_COMMAND} -E chdir ${WORK} ${WORK}/build/hello_mirror)
message("${output}")
if(NOT EXISTS ${WORK}/hello.png)
    message(FATAL_ERROR "hello_mirror wrote no hello.png")
endif()
step(${WORK}/prefix/bin/catoptric --version)
