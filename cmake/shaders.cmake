# Compiles every shaders/**/*.{vert,frag,comp} to SPIR-V at build time and adds it to the library. A shader's name is
# its path without shaders/, such as "reflect/naive.frag". shader_variant(PATH NAME DEFINE...) also compiles the same
# file with macros, under the name "PATH#NAME".
set(CATOPTRIC_SHADER_FOLDER ${PROJECT_SOURCE_DIR}/shaders)
set(CATOPTRIC_SPIRV_FOLDER ${PROJECT_BINARY_DIR}/spirv)

function(compile_shader path name)
    string(MAKE_C_IDENTIFIER "spirv_${name}" identifier)
    set(output ${CATOPTRIC_SPIRV_FOLDER}/${identifier}.spv)
    set(defines)
    foreach(define IN LISTS ARGN)
        list(APPEND defines -D${define})
    endforeach()
    add_custom_command(OUTPUT ${output}
        COMMAND Vulkan::glslangValidator --quiet -V --target-env vulkan1.3 ${defines}
                -I${CATOPTRIC_SHADER_FOLDER} --depfile ${output}.d
                -o ${output} ${CATOPTRIC_SHADER_FOLDER}/${path}
        MAIN_DEPENDENCY ${CATOPTRIC_SHADER_FOLDER}/${path} DEPFILE ${output}.d
        COMMENT "SPIR-V ${name}" VERBATIM)
    set_property(GLOBAL APPEND PROPERTY CATOPTRIC_SPIRV_FILES ${output})
    set_property(GLOBAL APPEND_STRING PROPERTY CATOPTRIC_SPIRV_WORDS "EMBED(${identifier}, \"${output}\")\n")
    set_property(GLOBAL APPEND_STRING PROPERTY CATOPTRIC_SPIRV_ROWS
        "    {\"${name}\", {${identifier}, ${identifier}_end}},\n")
endfunction()

macro(shader_variant path variant)
    compile_shader(${path} "${path}#${variant}" ${ARGN})
endmacro()

# embed_shaders(TARGET): writes a C++ table of all compiled shaders and adds it to the target.
function(embed_shaders target)
    file(GLOB_RECURSE files RELATIVE ${CATOPTRIC_SHADER_FOLDER} CONFIGURE_DEPENDS
        ${CATOPTRIC_SHADER_FOLDER}/*.vert ${CATOPTRIC_SHADER_FOLDER}/*.frag ${CATOPTRIC_SHADER_FOLDER}/*.comp)
    foreach(file IN LISTS files)
        compile_shader(${file} ${file})
    endforeach()
    get_property(spirv GLOBAL PROPERTY CATOPTRIC_SPIRV_FILES)
    get_property(words GLOBAL PROPERTY CATOPTRIC_SPIRV_WORDS)
    get_property(rows GLOBAL PROPERTY CATOPTRIC_SPIRV_ROWS)
    get_property(embed_macro GLOBAL PROPERTY CATOPTRIC_EMBED_MACRO)
    file(CONFIGURE OUTPUT ${CATOPTRIC_SPIRV_FOLDER}/table.cpp @ONLY CONTENT [[
#include "gpu/shader.hpp"

#include <cstdint>

@embed_macro@
@words@
namespace catoptric::gpu {

std::span<const EmbeddedShader> embedded_shaders() {
    static const EmbeddedShader table[] = {
@rows@    };
    return table;
}

} // namespace catoptric::gpu
]])
    target_sources(${target} PRIVATE ${CATOPTRIC_SPIRV_FOLDER}/table.cpp ${spirv})
    set_source_files_properties(${CATOPTRIC_SPIRV_FOLDER}/table.cpp PROPERTIES
        OBJECT_DEPENDS "${spirv}" SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
