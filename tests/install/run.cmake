# cmake -DBUILD=... -DSOURCE=... -DWORK=... -P run.cmake: installs the library into an empty prefix. Builds the outside
# project, each installed header alone and the samples against that prefix. Runs the samples and the installed programs.
cmake_policy(VERSION 3.25)
function(step)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(code)
        message(FATAL_ERROR "${ARGN}\nfailed (${code}):\n${out}")
    endif()
    message("${out}")
    set(output "${out}" PARENT_SCOPE)
endfunction()

if(NOT LAUNCHER) # the build uses no compiler cache
    set(LAUNCHER "")
endif()
set(samples hello_mirror own_geometry own_technique live_loop embedded)
file(REMOVE_RECURSE ${WORK})
file(COPY ${SOURCE}/tests/install/CMakeLists.txt DESTINATION ${WORK}/outside)
foreach(sample IN LISTS samples)
    file(GLOB files ${SOURCE}/samples/${sample}/*)
    file(COPY ${files} DESTINATION ${WORK}/outside)
endforeach()

# Every block of code in docs/library.md must occur in a sample.
file(GLOB files ${WORK}/outside/*)
set(code "")
foreach(file IN LISTS files)
    file(READ ${file} text)
    string(APPEND code "${text}")
endforeach()
file(READ ${SOURCE}/docs/library.md rest)
set(blocks 0)
while(rest MATCHES "\n```(cpp|cmake|glsl)\n")
    string(FIND "${rest}" "${CMAKE_MATCH_0}" begin)
    string(LENGTH "${CMAKE_MATCH_0}" length)
    math(EXPR begin "${begin} + ${length}")
    string(SUBSTRING "${rest}" ${begin} -1 rest)
    string(FIND "${rest}" "\n```" end)
    string(SUBSTRING "${rest}" 0 ${end} block)
    string(SUBSTRING "${rest}" ${end} -1 rest)
    string(SUBSTRING "${rest}" 4 -1 rest)
    string(FIND "${code}" "${block}" found)
    if(found EQUAL -1)
        message(FATAL_ERROR "docs/library.md shows code that is in no sample:\n${block}")
    endif()
    math(EXPR blocks "${blocks} + 1")
endwhile()
if(blocks LESS 4)
    message(FATAL_ERROR "docs/library.md shows ${blocks} blocks of code, wanted at least 4")
endif()

step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
# What the Python package is built from: the library without programs.
step(${CMAKE_COMMAND} --install ${BUILD} --component library --prefix ${WORK}/library)
file(GLOB config ${WORK}/library/lib*/cmake/catoptric/*.cmake ${WORK}/library/lib/*/cmake/catoptric/*.cmake)
if(EXISTS ${WORK}/library/bin OR NOT EXISTS ${WORK}/library/include/catoptric/session.hpp OR NOT config)
    message(FATAL_ERROR "the component `library` wants headers and the CMake package, and no programs")
endif()
foreach(file IN LISTS config)
    file(READ ${file} text)
    if(text MATCHES "catoptric_cli")
        message(FATAL_ERROR "${file} names a program, which the component `library` lacks")
    endif()
endforeach()
# The headers are the interface: they must stay few and short.
file(GLOB_RECURSE headers ${WORK}/prefix/include/catoptric/*.hpp)
list(LENGTH headers count)
set(lines 0)
foreach(header IN LISTS headers)
    file(READ ${header} text)
    string(REGEX REPLACE "[^\n]" "" text "${text}")
    string(LENGTH "${text}" length)
    math(EXPR lines "${lines} + ${length}")
endforeach()
message("${count} headers with ${lines} lines")
if(count GREATER 20 OR lines GREATER 1500)
    message(FATAL_ERROR "wanted at most 20 installed headers with 1500 lines, found ${count} with ${lines}")
endif()
file(GLOB library ${WORK}/prefix/lib*/libcatoptric.so ${WORK}/prefix/lib/*/libcatoptric.so)
if(NOT FLAGS) # builds with sanitizers export more names
    step(${SOURCE}/tests/install/exports.sh ${library} ${WORK}/prefix/include)
endif()
step(${CMAKE_COMMAND} -S ${WORK}/outside -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix
    "-DCMAKE_CXX_FLAGS=${FLAGS}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")
step(${CMAKE_COMMAND} --build ${WORK}/build)
# Outside programs lack this tree's leak suppressions (cmake/sanitizer_support.cpp), and the driver leaks. With
# sanitizers, the samples are therefore run without the check for leaks.
set(environment)
if(FLAGS)
    set(environment ASAN_OPTIONS=detect_leaks=0)
endif()
# Samples run in the folder of their programs, as in docs/library.md. A sample must not write a file with the name of a
# program.
foreach(sample IN LISTS samples)
    if(sample STREQUAL embedded) # makes its own Vulkan instance, whose validation layer writes to stdout
        list(APPEND environment VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
            VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT:VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT)
    endif()
    step(${CMAKE_COMMAND} -E env ${environment} ${CMAKE_COMMAND} -E chdir ${WORK}/build ${WORK}/build/${sample})
    if(output MATCHES "VUID|Validation (Error|Warning)|SYNC-HAZARD")
        message(FATAL_ERROR "${sample}: the validation layer has something to say")
    endif()
endforeach()
foreach(file hello.png waves.png waves.glb live.png embedded.png blend-report/report.html blend-report/report.json)
    if(NOT EXISTS ${WORK}/build/${file})
        message(FATAL_ERROR "the samples wrote no ${file}")
    endif()
endforeach()
# The sample live_loop audits the plan of a file as `catoptric choose` writes it. A function writes such a file, and runs
# the sample with it.
function(audit_plan limit)
    file(WRITE ${WORK}/build/plan.json "{\"certificate\": {\"quantity\": \"flip\", \"max_error\": ${limit}, "
        "\"share\": 0.95, \"confidence\": 0.95, \"reference\": \"raytrace:depth=4\"}, \"proofs\": ["
        "{\"technique\": \"parallax:face=32\", \"keeps_error\": true, \"keeps_time\": true}, "
        "{\"technique\": \"reuse:face=16\", \"keeps_error\": true, \"keeps_time\": true}]}")
    step(${CMAKE_COMMAND} -E env ${environment} ${CMAKE_COMMAND} -E chdir ${WORK}/build ${WORK}/build/live_loop
        --audit plan.json)
    set(output "${output}" PARENT_SCOPE)
endfunction()
set(frames_time "[0-9.]+ % of the frames' time")
audit_plan(1)
if(NOT output MATCHES "audit: ([0-9]+) of ([0-9]+) frames keep flip <= 1; assured share 0\\.[0-9]+; ${frames_time}\n"
    OR NOT CMAKE_MATCH_1 EQUAL CMAKE_MATCH_2 OR CMAKE_MATCH_1 LESS 10)
    message(FATAL_ERROR "live_loop --audit: wanted at least 10 audited frames that keep flip <= 1")
endif()
audit_plan(0) # each plan raises an alarm
if(NOT output MATCHES "audit: 0 of [0-9]+ frames keep flip <= 0; assured share 0\\.000; ${frames_time}; alarm: too many")
    message(FATAL_ERROR "live_loop --audit: wanted an alarm for flip <= 0")
endif()
file(WRITE ${WORK}/build/bad.json "{}")
foreach(case "bad.json=certificate: wanted the one that 'catoptric choose' writes, found nothing" "none.json=none.json")
    string(REGEX MATCH "^([^=]*)=(.*)$" case ${case})
    execute_process(COMMAND ${WORK}/build/live_loop --audit ${CMAKE_MATCH_1} WORKING_DIRECTORY ${WORK}/build
        RESULT_VARIABLE code ERROR_VARIABLE said)
    if(NOT code EQUAL 1 OR NOT said MATCHES "^live_loop: .*${CMAKE_MATCH_2}")
        message(FATAL_ERROR "live_loop --audit ${CMAKE_MATCH_1}: wanted '${CMAKE_MATCH_2}', found (${code}) ${said}")
    endif()
endforeach()
# With amount=1 and lookup=bilinear, the sample's technique `blend` must draw the picture of `parallax`.
set(images ${WORK}/build/blend-report/images)
step(${CMAKE_COMMAND} -E compare_files ${images}/blend-amount1-face64-lookupbilinear.exr
    ${images}/parallax-face64.exr)
foreach(other parallax-face64 blend-amount0-face64)
    execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${images}/blend-face64.exr ${images}/${other}.exr
        RESULT_VARIABLE differs ERROR_QUIET)
    if(NOT differs)
        message(FATAL_ERROR "blend with amount=0.5 shows what ${other} shows: its constant does not reach the shader")
    endif()
endforeach()
step(${WORK}/prefix/bin/catoptric --version)
step(${WORK}/prefix/bin/catoptric diff ${WORK}/build/hello.png ${WORK}/build/hello.png) # also loads the image module
if(EXISTS ${BUILD}/catoptric-view) # not built if its libraries are missing
    step(${WORK}/prefix/bin/catoptric-view --version)
endif()
