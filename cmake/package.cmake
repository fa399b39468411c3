# The Debian package: `./dev deb` builds it, and `apt install ./catoptric_*.deb` installs it. It holds what
# `cmake --install` installs, completions of shells, pages of the manual and the documentation as static pages. Pages and
# completions are what the program itself prints, so they follow its tables. Target `package_files` makes them.
set(generated_folder ${PROJECT_BINARY_DIR}/package)

# print_to_file(FILE COMMAND...): makes the file of what the command prints.
function(print_to_file file)
    add_custom_command(OUTPUT ${generated_folder}/${file}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${generated_folder}
        COMMAND ${ARGN} > ${generated_folder}/${file}
        DEPENDS catoptric_cli VERBATIM)
    set(package_files ${package_files} ${generated_folder}/${file} PARENT_SCOPE)
endfunction()

set(places bash share/bash-completion/completions catoptric zsh share/zsh/vendor-completions _catoptric
    fish share/fish/vendor_completions.d catoptric.fish)
while(places)
    list(POP_FRONT places shell folder name)
    print_to_file(${name}.${shell} $<TARGET_FILE:catoptric_cli> completion ${shell})
    install(FILES ${generated_folder}/${name}.${shell} DESTINATION ${folder} RENAME ${name} OPTIONAL)
endwhile()

find_program(HELP2MAN help2man)
if(HELP2MAN)
    set(help2man ${HELP2MAN} --no-info --section=1 --version-string=${PROJECT_VERSION})
    print_to_file(catoptric.1 ${help2man} "--name=${PROJECT_DESCRIPTION}" $<TARGET_FILE:catoptric_cli>)
    install(FILES ${generated_folder}/catoptric.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
    foreach(verb compare choose render stress bench diff graph list info views sweep results completion)
        print_to_file(catoptric-${verb}.1 ${help2man} --help-option=--help-all "--name=verb of catoptric" "$<TARGET_FILE:catoptric_cli> ${verb}")
        install(FILES ${generated_folder}/catoptric-${verb}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
    endforeach()
endif()

# The documentation as static pages, if MkDocs is there. `./dev docs` builds the same pages without the package.
find_program(MKDOCS mkdocs)
find_program(PYTHON3 python3)
if(MKDOCS AND PYTHON3)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS docs/*)
    add_custom_command(OUTPUT ${generated_folder}/html/index.html
        COMMAND ${PYTHON3} -B ${PROJECT_SOURCE_DIR}/docs/site/build.py $<TARGET_FILE:catoptric_cli> ${generated_folder}/html
        DEPENDS catoptric_cli ${sources} mkdocs.yml README.md CONTRIBUTING.md CHANGELOG.md VERBATIM)
    list(APPEND package_files ${generated_folder}/html/index.html)
endif()
install(DIRECTORY ${generated_folder}/html DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
add_custom_target(package_files DEPENDS ${package_files})

file(GLOB pages CONFIGURE_DEPENDS docs/*.md)
install(FILES README.md ${pages} DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The licences of the package and of uPlot, which the library writes into pages.
file(READ LICENSE licence)
file(READ engine/report/page/third_party/uplot/LICENSE uplot_licence)
file(WRITE ${generated_folder}/copyright "${licence}\nPages of reports contain uPlot (https://github.com/leeoniya/uPlot):\n\n${uplot_licence}\n")
install(FILES ${generated_folder}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET catoptric_view)
    install(FILES samples/view/catoptric-view.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "the authors of Catoptric")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS mesa-vulkan-drivers)
# ffmpeg: films. libglm-dev: headers of the library. librsvg2-bin: figures as PDF. vulkan-validationlayers: --validate.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "ffmpeg, libglm-dev, librsvg2-bin, vulkan-validationlayers")
include(CPack)
