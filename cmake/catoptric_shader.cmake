# catoptric_shader(TARGET FILE): compiles the fragment shader of a technique of the target's own (catoptric::app::Search,
# docs/library.md), in every build that the engine may ask for, and makes it part of the target under FILE's name without folders.
# It may include lib/*.glsl, shared.h, and files beside it. The target is a program or a shared library: of a static one a
# linker would leave out what nobody calls. CATOPTRIC_SHADERS, a global property: the folder with lib/ and shared.h.

function(catoptric_shader target file)
    find_program(CATOPTRIC_GLSLANG glslangValidator)
    if(NOT CATOPTRIC_GLSLANG)
        message(FATAL_ERROR "catoptric_shader needs glslangValidator (Debian: apt install glslang-tools)")
    endif()
    get_property(shaders GLOBAL PROPERTY CATOPTRIC_SHADERS)
    get_filename_component(source ${file} ABSOLUTE)
    get_filename_component(folder ${source} DIRECTORY)
    set(made ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders/${file})
    file(MAKE_DIRECTORY ${made})
    set(includes)
    set(rows)
    set(headers)
    # Captures in one array or several; mirrors with nothing else to show, with light of their own, with causes of
    # error taken away; the two last with shadow maps or without.
    foreach(arrays "" arrays)
        foreach(kind "" lit lit_unshadowed ablate ablate_unshadowed)
            set(build ${arrays} ${kind})
            list(JOIN build _ build)
            set(defines)
            if(arrays)
                list(APPEND defines -DARRAYS)
            endif()
            if(kind MATCHES lit)
                list(APPEND defines -DLIT)
            elseif(kind MATCHES ablate)
                list(APPEND defines -DABLATE)
            endif()
            if(kind STREQUAL lit_unshadowed)
                list(APPEND defines -DUNSHADOWED)
            elseif(kind STREQUAL ablate)
                list(APPEND defines -DSHADOW_MAP)
            endif()
            get_filename_component(name ${file} NAME)
            if(build)
                string(APPEND name "#${build}")
            endif()
            set(header ${made}/spirv_${build}.h)
            add_custom_command(OUTPUT ${header}
                COMMAND ${CATOPTRIC_GLSLANG} --quiet -V --target-env vulkan1.3 ${defines} -I${shaders} -I${folder}
                        --vn spirv_${build} --depfile ${header}.d -o ${header} ${source}
                MAIN_DEPENDENCY ${source} DEPFILE ${header}.d COMMENT "SPIR-V ${name}" VERBATIM)
            list(APPEND headers ${header})
            string(APPEND includes "#include \"spirv_${build}.h\"\n")
            string(APPEND rows "    {\"${name}\", spirv_${build}},\n")
        endforeach()
    endforeach()
    file(CONFIGURE OUTPUT ${made}/builds.cpp @ONLY CONTENT [[
#include <catoptric/technique.hpp>

#include <cstdint>

namespace {
@includes@
const catoptric::app::Shader kBuilds[] = {
@rows@};
const catoptric::app::RegisteredShaders kRegistered{kBuilds};
} // namespace
]])
    target_sources(${target} PRIVATE ${made}/builds.cpp ${headers})
    set_source_files_properties(${made}/builds.cpp PROPERTIES OBJECT_DEPENDS "${headers}")
endfunction()
