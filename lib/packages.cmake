# Packages for Debian, by `cpack -G DEB` in the build folder: acdf-tools, libacdf0, libacdf-dev and python3-acdf.
# What is made of the program itself, its pages for man and its completions, is made by the target `manual`.

set(maintainer "the acdf authors <acdf@packages.invalid>")

# ---- pages and completions ----

find_program(ACDF_HELP2MAN help2man)
if(TARGET acdf AND ACDF_HELP2MAN AND NOT ACDF_SANITIZE)
    set(manual ${PROJECT_BINARY_DIR}/manual)
    add_custom_command(OUTPUT ${manual}/acdf.1.gz
        COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/manual.sh $<TARGET_FILE:acdf> ${manual}
        DEPENDS acdf ${CMAKE_CURRENT_LIST_DIR}/manual.sh COMMENT "Pages for man and completions, from acdf itself")
    add_custom_target(manual ALL DEPENDS ${manual}/acdf.1.gz)
    include(GNUInstallDirs)
    install(DIRECTORY ${manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT manual
        FILES_MATCHING PATTERN *.1.gz)
    install(FILES ${manual}/acdf DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT manual)
    install(FILES ${manual}/_acdf DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT manual)
endif()

# ---- what Debian's policy asks of every package ----

set(ACDF_CHANGED "Sun, 22 Nov 2026 12:00:00 +0000") # of this version
set(changes "acdf (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * See CHANGELOG.md.\n\n")
string(APPEND changes " -- ${maintainer}  ${ACDF_CHANGED}\n")
file(WRITE ${PROJECT_BINARY_DIR}/debian/changelog "${changes}")
file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
file(WRITE ${PROJECT_BINARY_DIR}/debian/copyright "Files: *\n\n${license}")
find_program(ACDF_GZIP gzip)
if(ACDF_GZIP)
    execute_process(COMMAND ${ACDF_GZIP} -9nkf ${PROJECT_BINARY_DIR}/debian/changelog)
endif()

# acdf_debian_package(GROUP NAME DEPENDS SUMMARY DESCRIPTION COMPONENTS...): one package of those components.
macro(acdf_debian_package group name depends summary description)
    install(FILES ${PROJECT_BINARY_DIR}/debian/copyright DESTINATION share/doc/${name} COMPONENT ${group}-papers)
    install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION share/doc/${name} COMPONENT ${group}-papers OPTIONAL)
    string(TOUPPER ${group} group_upper)
    set(CPACK_DEBIAN_${group_upper}_PACKAGE_NAME ${name})
    set(CPACK_DEBIAN_${group_upper}_PACKAGE_DEPENDS "${depends}")
    set(CPACK_DEBIAN_${group_upper}_DESCRIPTION "${summary}\n${description}")
    foreach(component ${ARGN} ${group}-papers)
        string(TOUPPER ${component} component_upper)
        set(CPACK_COMPONENT_${component_upper}_GROUP ${group})
        list(APPEND CPACK_COMPONENTS_ALL ${component})
    endforeach()
endmacro()

set(CPACK_COMPONENTS_ALL "")
set(same "(= ${PROJECT_VERSION})")
if(TARGET acdf)
    acdf_debian_package(program acdf-tools "" "compact importance sampling of measured light and reflectance"
        "The program acdf turns environment maps, BRDFs and tables into small\nfiles of adaptive numerical CDFs, measures exactly how much noise they\nhave, and takes and evaluates samples."
        tools manual)
endif()
if(ACDF_BUILD_SHARED)
    acdf_debian_package(libraries libacdf0 "" "importance sampling of measured light: shared libraries"
        "The reader samples from .acdf files and evaluates their densities, the\nbuilder makes them in memory."
        runtime)
    set(development_needs "libacdf0 ${same}, zlib1g-dev, libtbb-dev")
    if(ACDF_BUILD_BATCH)
        string(APPEND development_needs ", libhwy-dev")
    endif()
    acdf_debian_package(development libacdf-dev "${development_needs}"
        "importance sampling of measured light: headers and libraries"
        "To sample from .acdf files in a renderer (C, C++ and kernels), and to make\nthem in memory: static and shared libraries, for CMake and pkg-config."
        reader ${ACDF_ROOMS} builder shared)
    set(CPACK_DEBIAN_LIBRARIES_PACKAGE_CONTROL_EXTRA
        ${PROJECT_BINARY_DIR}/debian/triggers ${PROJECT_BINARY_DIR}/debian/shlibs)
    file(WRITE ${PROJECT_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
    set(needs "${PROJECT_VERSION_MAJOR} libacdf0 (>= ${PROJECT_VERSION})")
    file(WRITE ${PROJECT_BINARY_DIR}/debian/shlibs "libacdf ${needs}\nlibacdf-builder ${needs}\n")
    set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libs)
    set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
endif()
if(TARGET acdf_python)
    acdf_debian_package(scripting python3-acdf "python3, python3-numpy"
        "importance sampling of measured light for Python"
        "The module acdf samples from .acdf files and evaluates their densities for\narrays of NumPy, and makes files from them."
        python)
    set(CPACK_DEBIAN_SCRIPTING_PACKAGE_SECTION python)
    # What Python compiled beside the module would keep its folder.
    set(CPACK_DEBIAN_SCRIPTING_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/prerm)
    file(WRITE ${PROJECT_BINARY_DIR}/debian/prerm
        "#!/bin/sh\nset -e\nif command -v py3clean >/dev/null; then py3clean -p python3-acdf; fi\n")
endif()

# Packages are made of what was built: whether it is hardened cannot be mended any more.
if(NOT ACDF_HARDEN)
    file(WRITE ${PROJECT_BINARY_DIR}/debian/not_hardened.cmake
        "message(WARNING \"these packages are not hardened: configure with --preset package, or -DACDF_HARDEN=ON\")\n")
    set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_BINARY_DIR}/debian/not_hardened.cmake)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "${maintainer}")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${maintainer}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "importance sampling of measured light and reflectance")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib/reader ${PROJECT_BINARY_DIR}/lib/build)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
include(CPack)
