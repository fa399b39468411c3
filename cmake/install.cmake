# cmake --install: the library, its public headers, the program, and find_package(catoptric).
include(CMakePackageConfigHelpers)

set_target_properties(catoptric_cli PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
install(TARGETS catoptric catoptric_cli EXPORT catoptricTargets
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})

# Headers that need neither Vulkan, the shaders' folder nor the JSON library.
foreach(name core scene require measure report app)
    install(DIRECTORY engine/${name}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/catoptric/${name}
        FILES_MATCHING PATTERN "*.hpp" PATTERN "shader_math.hpp" EXCLUDE PATTERN "json.hpp" EXCLUDE PATTERN "gltf_*.hpp" EXCLUDE PATTERN "obj_text.hpp" EXCLUDE)
endforeach()
install(DIRECTORY samples/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/catoptric)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/catoptric)
install(EXPORT catoptricTargets NAMESPACE catoptric:: DESTINATION ${package_folder})
configure_package_config_file(cmake/catoptricConfig.cmake.in ${PROJECT_BINARY_DIR}/catoptricConfig.cmake
    INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/catoptricConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/catoptricConfig.cmake ${PROJECT_BINARY_DIR}/catoptricConfigVersion.cmake
    DESTINATION ${package_folder})
