# Compile options of every target.
add_library(catoptric_options INTERFACE)
target_include_directories(catoptric_options INTERFACE ${PROJECT_SOURCE_DIR}/engine ${PROJECT_SOURCE_DIR}/shaders)
# Fused multiply-add is off. Fused operations would round the comparisons that find ray hits differently, so the CPU
# reference and the device could disagree about an edge.
target_compile_options(catoptric_options INTERFACE -ffp-contract=off)
# Implicit conversions of GLM types are errors in this tree. Programs that use the library need not follow this rule, so
# public headers do not define the macro.
target_compile_definitions(catoptric_options INTERFACE GLM_FORCE_EXPLICIT_CTOR)
# Debug and sanitizer builds check indices in the standard library.
target_compile_definitions(catoptric_options INTERFACE
    $<$<OR:$<CONFIG:Debug>,$<BOOL:${CATOPTRIC_SANITIZE}>>:_GLIBCXX_ASSERTIONS>)
if(CATOPTRIC_SANITIZE)
    target_compile_options(catoptric_options INTERFACE
        -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    target_link_options(catoptric_options INTERFACE -fsanitize=address,undefined)
    add_library(catoptric_sanitizer_support OBJECT ${PROJECT_SOURCE_DIR}/cmake/sanitizer_support.cpp)
endif()

# Programs record which code they run (tests/mutations/reached.cpp).
if(CATOPTRIC_REACHED)
    add_library(catoptric_reached STATIC ${PROJECT_SOURCE_DIR}/tests/mutations/reached.cpp)
    target_compile_options(catoptric_options INTERFACE -fsanitize-coverage=trace-pc)
    target_link_libraries(catoptric_options INTERFACE catoptric_reached)
endif()

# program(TARGET): links an executable of this tree with the engine's object files, including functions that the shared
# library hides.
function(program target)
    get_property(layers GLOBAL PROPERTY CATOPTRIC_LAYERS)
    get_property(program_layers GLOBAL PROPERTY CATOPTRIC_PROGRAM_LAYERS)
    list(APPEND layers ${program_layers})
    list(TRANSFORM layers PREPEND catoptric_)
    target_link_libraries(${target} PRIVATE ${layers} catoptric_options catoptric_warnings)
    add_dependencies(${target} catoptric_images catoptric_draco)
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
    # In grouped sources, this warning mistakes an included source for a header.
    target_compile_options(catoptric_warnings INTERFACE -Wno-subobject-linkage)
endif()
