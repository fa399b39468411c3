# layer(NAME USES other... ) declares engine/NAME: an object library of every source in the folder.
# USES is the list of layers whose headers it may include; anything else stops the build
# (cmake/check_arrows.cmake). Headers are in a file set, so that CMake proves that each compiles alone.
include(CMakeParseArguments)

function(layer name)
    cmake_parse_arguments(arg "" "" "USES;LINK" ${ARGN})
    set(folder ${PROJECT_SOURCE_DIR}/engine/${name})
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
    file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.hpp)
    set(target catoptric_${name})

    set(stamp ${PROJECT_BINARY_DIR}/arrows/${name}.stamp)
    string(REPLACE ";" "," uses "${name};${arg_USES}")
    add_custom_command(OUTPUT ${stamp}
        COMMAND ${CMAKE_COMMAND} -DLAYER=${name} "-DUSES=${uses}" -DFOLDER=${folder} -DSTAMP=${stamp}
                -P ${PROJECT_SOURCE_DIR}/cmake/check_arrows.cmake
        DEPENDS ${sources} ${headers} ${PROJECT_SOURCE_DIR}/cmake/check_arrows.cmake VERBATIM)

    if(NOT sources)
        message(STATUS "layer ${name}: no sources yet")
        return()
    endif()
    add_library(${target} OBJECT ${sources} ${stamp})
    target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/engine FILES ${headers})
    set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
    target_link_libraries(${target} PUBLIC catoptric_options glm::glm PRIVATE catoptric_warnings ${arg_LINK})
    set_property(GLOBAL APPEND PROPERTY CATOPTRIC_LAYERS ${name})
endfunction()
