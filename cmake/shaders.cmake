# Compiles every shaders/**/*.{vert,frag,comp} to SPIR-V at build time and adds it to the library. A shader's name is
# its path without shaders/, such as "reflect/naive.frag". shader_variant(PATH NAME DEFINE...) also compiles the same
# file with macros, under the name "PATH#NAME".
set(CATOPTRIC_SHADER_FOLDER ${PROJECT_SOURCE_DIR}/shaders)
set(CATOPTRIC_SPIRV_FOLDER ${PROJECT_BINARY_DIR}/spirv)

function(compile_shader path name)
    string(MAKE_C_IDENTIFIER "spirv_${name}" identifier)
    set(output ${CATOPTRIC_SPIRV_FOLDER}/${identifier}.h)
    set(defines)
    foreach(define IN LISTS ARGN)
        list(APPEND defines -D${define})
    endforeach()
    add_custom_command(OUTPUT ${output}
        COMMAND Vulkan::glslangValidator --quiet -V --target-env vulkan1.3 ${defines}
                -I${CATOPTRIC_SHADER_FOLDER} --vn ${identifier} --depfile ${output}.d
                -o ${output} ${CATOPTRIC_SHADER_FOLDER}/${path}
        MAIN_DEPENDENCY ${CATOPTRIC_SHADER_FOLDER}/${path} DEPFILE ${output}.d
        COMMENT "SPIR-V ${name}" VERBATIM)
    set_property(GLOBAL APPEND PROPERTY CATOPTRIC_SPIRV_HEADERS ${output})
    set_property(GLOBAL APPEND_STRING PROPERTY CATOPTRIC_SPIRV_INCLUDES "#include \"${identifier}.h\"\n")
    set_property(GLOBAL APPEND_STRING PROPERTY CATOPTRIC_SPIRV_ROWS "    {\"${name}\", ${identifier}},\n")
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
    get_property(headers GLOBAL PROPERTY CATOPTRIC_SPIRV_HEADERS)
    get_property(includes GLOBAL PROPERTY CATOPTRIC_SPIRV_INCLUDES)
    get_property(rows GLOBAL PROPERTY CATOPTRIC_SPIRV_ROWS)
    file(CONFIGURE OUTPUT ${CATOPTRIC_SPIRV_FOLDER}/table.cpp @ONLY CONTENT [[
#include "gpu/shader.hpp"

#include <cstdint>

@includes@
namespace catoptric::gpu {

namespace {
const EmbeddedShader kTable[] = {
@rows@};
} // namespace

std::span<const EmbeddedShader> embedded_shaders() { return kTable; }

} // namespace catoptric::gpu
]])
    target_sources(${target} PRIVATE ${CATOPTRIC_SPIRV_FOLDER}/table.cpp ${headers})
    set_source_files_properties(${CATOPTRIC_SPIRV_FOLDER}/table.cpp PROPERTIES OBJECT_DEPENDS "${headers}")
    target_include_directories(${target} PRIVATE ${CATOPTRIC_SPIRV_FOLDER})
endfunction()
