# catoptric_shader(TARGET FILE): compiles the fragment shader of a user's own technique (catoptric::session::Search,
# docs/library.md). Adds all variants that the engine may ask for to the target, under FILE's name without folders. The
# shader may include lib/*.glsl, shared.h and files beside it. The target must be a program or a shared library, because
# a linker leaves unused objects of a static library out. The global property CATOPTRIC_SHADERS is the folder with lib/
# and shared.h.

# EMBED(NAME, FILE) embeds a file of words in C++ as the array NAME, which ends at NAME_end. The assembler reads the
# file, so no words go through the compiler.
set_property(GLOBAL PROPERTY CATOPTRIC_EMBED_MACRO [[
#define EMBED(name, file)                                                                          \
    asm(".pushsection .rodata, \"a\"\n.balign 4\n" #name ":\n.incbin \"" file "\"\n" #name "_end:\n.popsection"); \
    extern "C" __attribute__((visibility("hidden"))) const std::uint32_t name[], name##_end[];
]])

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
    set(words)
    set(rows)
    set(spirv)
    get_property(embed_macro GLOBAL PROPERTY CATOPTRIC_EMBED_MACRO)
    string(MAKE_C_IDENTIFIER "spirv_${target}_${file}" identifier)
    # The shader itself, and the variant that removes causes of error (shaders/lib/ablate.glsl).
    foreach(build plain ablate)
        get_filename_component(name ${file} NAME)
        set(defines)
        if(build STREQUAL ablate)
            set(defines -DABLATE)
            string(APPEND name "#ablate")
        endif()
        set(output ${made}/${identifier}_${build}.spv)
        add_custom_command(OUTPUT ${output}
            COMMAND ${CATOPTRIC_GLSLANG} --quiet -V --target-env vulkan1.3 ${defines} -I${shaders} -I${folder}
                    --depfile ${output}.d -o ${output} ${source}
            MAIN_DEPENDENCY ${source} DEPFILE ${output}.d COMMENT "SPIR-V ${name}" VERBATIM)
        list(APPEND spirv ${output})
        string(APPEND words "EMBED(${identifier}_${build}, \"${output}\")\n")
        string(APPEND rows "    {\"${name}\", {${identifier}_${build}, ${identifier}_${build}_end}},\n")
    endforeach()
    file(CONFIGURE OUTPUT ${made}/builds.cpp @ONLY CONTENT [[
#include <catoptric/technique.hpp>

#include <cstdint>

@embed_macro@
@words@
namespace {
const catoptric::session::Shader kBuilds[] = {
@rows@};
const catoptric::session::RegisteredShaders kRegistered{kBuilds};
} // namespace
]])
    target_sources(${target} PRIVATE ${made}/builds.cpp ${spirv})
    set_source_files_properties(${made}/builds.cpp PROPERTIES OBJECT_DEPENDS "${spirv}")
endfunction()
