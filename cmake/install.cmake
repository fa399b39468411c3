# Rules of `cmake --install`: the library, its public headers, the programs, the package for find_package(catoptric),
# and the shader files that techniques of users include. `--component library` installs what programs that link the
# library need, and no program of this tree.
include(CMakePackageConfigHelpers)

install(TARGETS catoptric_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET catoptric_view)
    install(TARGETS catoptric_view RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(DIRECTORY samples/scenes samples/sweep DESTINATION ${CMAKE_INSTALL_DATADIR}/catoptric)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME library)
install(TARGETS catoptric EXPORT catoptricTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS catoptric_images catoptric_draco LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/catoptric)

# Public headers. Programs include those that lie directly in catoptric/. The other headers are included by these.
# Headers include each other by relative paths, which are the same in this tree and installed. tests/install/run.cmake
# checks that there are at most 20 headers with 1,500 lines (docs/notes/ADR-013-library-interface.md).
set(headers
    compare.hpp embed.hpp error.hpp picture.hpp report.hpp scene.hpp session.hpp technique.hpp
    core/export.hpp core/frame_facts.hpp core/math.hpp
    scene/build.hpp scene/material.hpp scene/scene.hpp import/load.hpp
    measure/comparison.hpp measure/picture.hpp
    session/engine.hpp session/run.hpp session/session.hpp)
foreach(header IN LISTS headers)
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES engine/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/catoptric/${folder})
endforeach()
set(CATOPTRIC_SHADER_DESTINATION ${CMAKE_INSTALL_DATADIR}/catoptric/shaders)
install(DIRECTORY shaders/lib DESTINATION ${CATOPTRIC_SHADER_DESTINATION})
install(FILES shaders/shared.h DESTINATION ${CATOPTRIC_SHADER_DESTINATION})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/catoptric)
install(EXPORT catoptricTargets NAMESPACE catoptric:: DESTINATION ${package_folder})
configure_package_config_file(cmake/catoptricConfig.cmake.in ${PROJECT_BINARY_DIR}/catoptricConfig.cmake
    INSTALL_DESTINATION ${package_folder} PATH_VARS CATOPTRIC_SHADER_DESTINATION)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/catoptricConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/catoptricConfig.cmake ${PROJECT_BINARY_DIR}/catoptricConfigVersion.cmake
    cmake/catoptric_shader.cmake DESTINATION ${package_folder})
unset(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME)
