# catoptric_shader(TARGET FILE): compiles the fragment shader of a user's own technique (catoptric::app::Search,
# docs/library.md). Adds all variants that the engine may ask for to the target, under FILE's name without folders. The
# shader may include lib/*.glsl, shared.h and files beside it. The target must be a program or a shared library, because
# a linker leaves unused objects of a static library out. The global property CATOPTRIC_SHADERS is the folder with lib/
# and shared.h.

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
    # The shader itself, and the variant that removes causes of error (shaders/lib/ablate.glsl).
    foreach(build "" ablate)
        set(defines)
        if(build)
            set(defines -DABLATE)
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
