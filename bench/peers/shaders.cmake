# prototype_shaders(TARGET): compiles the shaders of the prototypes and of ray lists to SPIR-V, and adds a table of
# their names and words to the target's sources.
function(prototype_shaders target)
    set(made ${CMAKE_CURRENT_BINARY_DIR}/shaders)
    file(MAKE_DIRECTORY ${made})
    set(includes)
    set(rows)
    set(headers)
    foreach(build surface.vert diffuse.frag mirror.frag trace.comp "trace.comp#skip_links" rays.comp)
        string(REGEX REPLACE "#.*" "" file ${build})
        set(source ${CMAKE_CURRENT_SOURCE_DIR}/shaders/${file})
        string(MAKE_C_IDENTIFIER "prototype_${build}" identifier)
        set(header ${made}/${identifier}.h)
        set(define)
        if(build MATCHES "#(.*)")
            string(TOUPPER ${CMAKE_MATCH_1} define)
            set(define -D${define})
        endif()
        add_custom_command(OUTPUT ${header}
            COMMAND Vulkan::glslangValidator --quiet -V --target-env vulkan1.3 ${define} -I${CMAKE_CURRENT_SOURCE_DIR}/shaders
                    -I${CATOPTRIC_SHADER_FOLDER}
                    --vn ${identifier} --depfile ${header}.d -o ${header} ${source}
            MAIN_DEPENDENCY ${source} DEPFILE ${header}.d COMMENT "SPIR-V peers/${build}" VERBATIM)
        list(APPEND headers ${header})
        string(APPEND includes "#include \"${identifier}.h\"\n")
        string(APPEND rows "    {\"peers/${build}\", ${identifier}},\n")
    endforeach()
    file(CONFIGURE OUTPUT ${made}/table.cpp @ONLY CONTENT [[
#include "prototype_shaders.hpp"

#include <cstdint>

namespace {
@includes@
const catoptric::gpu::EmbeddedShader kShaders[] = {
@rows@};
} // namespace

namespace peers {
std::span<const catoptric::gpu::EmbeddedShader> prototype_shaders() { return kShaders; }
} // namespace peers
]])
    target_sources(${target} PRIVATE ${made}/table.cpp ${headers})
    set_source_files_properties(${made}/table.cpp PROPERTIES OBJECT_DEPENDS "${headers}")
    target_include_directories(${target} PRIVATE ${made} ${CMAKE_CURRENT_SOURCE_DIR})
endfunction()
