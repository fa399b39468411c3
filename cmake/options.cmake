# What every target is compiled with.
add_library(catoptric_options INTERFACE)
target_include_directories(catoptric_options INTERFACE ${PROJECT_SOURCE_DIR}/engine ${PROJECT_SOURCE_DIR}/shaders)
# A hit is a comparison of floats: contraction to fused multiply-add would let the CPU oracle and the
# device disagree about an edge.
target_compile_options(catoptric_options INTERFACE -ffp-contract=off)
# No implicit conversions in this tree; a public header sets nothing of GLM for programs outside.
target_compile_definitions(catoptric_options INTERFACE GLM_FORCE_EXPLICIT_CTOR)
# The standard library checks indices in builds that look for mistakes.
target_compile_definitions(catoptric_options INTERFACE
    $<$<OR:$<CONFIG:Debug>,$<BOOL:${CATOPTRIC_SANITIZE}>>:_GLIBCXX_ASSERTIONS>)
if(CATOPTRIC_SANITIZE)
    target_compile_options(catoptric_options INTERFACE
        -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    target_link_options(catoptric_options INTERFACE -fsanitize=address,undefined)
    add_library(catoptric_sanitizer_support OBJECT ${PROJECT_SOURCE_DIR}/cmake/sanitizer_support.cpp)
endif()

# program(TARGET): what every executable of this tree links: the engine's object files, hidden parts and all.
function(program target)
    get_property(layers GLOBAL PROPERTY CATOPTRIC_LAYERS)
    list(TRANSFORM layers PREPEND catoptric_)
    target_link_libraries(${target} PRIVATE ${layers} catoptric_options catoptric_warnings)
    add_dependencies(${target} catoptric_images)
    if(CATOPTRIC_SANITIZE)
        target_link_libraries(${target} PRIVATE catoptric_sanitizer_support)
    endif()
endfunction()

add_library(catoptric_warnings INTERFACE)
target_compile_options(catoptric_warnings INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 warns of std::string's own code (GCC bug 105651).
    target_compile_options(catoptric_warnings INTERFACE -Wno-restrict)
endif()
if(CATOPTRIC_UNITY)
    # The warning takes a source that a group includes for a header.
    target_compile_options(catoptric_warnings INTERFACE -Wno-subobject-linkage)
endif()
