# layer(NAME [IN samples] USES other... ): declares engine/NAME as an object library of every source in the folder, and
# makes it part of the library. A layer in samples/ is part of programs only. USES lists the
# layers whose headers the sources may include. Any other include stops the build (cmake/check_arrows.cmake). With
# CATOPTRIC_UNITY up to CATOPTRIC_UNITY_SIZE sources of a layer are compiled at a time; with the usual 32, that takes a
# tenth of the time. Names in unnamed namespaces must then differ within the layer. Headers are in a file set, so that
# CMake checks that each header compiles alone.
include(CMakeParseArguments)

# arrows(NAME FOLDER STAMP USES): checks the include rules between layers. Sets the variable STAMP to the path of a file
# that a target can depend on. The build makes this file only if no source in FOLDER includes a layer that is not in
# USES.
function(arrows name folder stamp uses)
    file(GLOB files CONFIGURE_DEPENDS ${folder}/*.cpp ${folder}/*.hpp)
    set(made ${PROJECT_BINARY_DIR}/arrows/${name}.stamp)
    string(REPLACE ";" "," uses "${uses}")
    add_custom_command(OUTPUT ${made}
        COMMAND ${CMAKE_COMMAND} -DLAYER=${name} "-DUSES=${uses}" -DFOLDER=${folder} -DENGINE=${PROJECT_SOURCE_DIR}/engine
                -DSTAMP=${made} -P ${PROJECT_SOURCE_DIR}/cmake/check_arrows.cmake
        DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/check_arrows.cmake VERBATIM)
    set(${stamp} ${made} PARENT_SCOPE)
endfunction()

# compile_in_groups(TARGET): with CATOPTRIC_UNITY, compiles up to CATOPTRIC_UNITY_SIZE sources of the target at a time.
function(compile_in_groups target)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${CATOPTRIC_UNITY}
        UNITY_BUILD_BATCH_SIZE ${CATOPTRIC_UNITY_SIZE})
endfunction()

function(layer name)
    cmake_parse_arguments(arg "" "IN" "USES;LINK" ${ARGN})
    if(NOT arg_IN)
        set(arg_IN engine)
    endif()
    set(folder ${PROJECT_SOURCE_DIR}/${arg_IN}/${name})
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
    file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.hpp)
    set(target catoptric_${name})

    arrows(${name} ${folder} stamp "${name};${arg_USES}")

    if(NOT sources)
        message(STATUS "layer ${name}: no sources yet")
        return()
    endif()
    add_library(${target} OBJECT ${sources} ${stamp})
    compile_in_groups(${target})
    target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/${arg_IN} FILES ${headers})
    set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON
        CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_link_libraries(${target} PUBLIC catoptric_options glm::glm PRIVATE catoptric_warnings ${arg_LINK})
    if(arg_IN STREQUAL engine)
        set_property(GLOBAL APPEND PROPERTY CATOPTRIC_LAYERS ${name})
    else()
        set_property(GLOBAL APPEND PROPERTY CATOPTRIC_PROGRAM_LAYERS ${name})
    endif()
endfunction()
