# Installs the reader, the rooms beside it and the builder, components `reader`, `visibility`, `batch`, `arrays`, `curves`, `indexed`,
# `product`, `shader` and `builder`: headers and a static library each, one CMake package and a pkg-config file each. All need the
# first, `shader` needs `indexed`, `product` `visibility`, `builder` these and `curves`. As shared libraries, one of the reader
# with the rooms and one of the builder: `runtime`, and what links to them, `shared`.
# The program: `tools`, its pages and completions `manual`. The Python package: `python`.
# Everything is relocatable: the prefix may be moved or staged after installation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(ACDF_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/acdf)

# The reader, and the rooms beside it, each with a component, an export set and a pkg-config file of its own.
install(TARGETS acdf_reader EXPORT acdfTargets COMPONENT reader
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES ${PROJECT_SOURCE_DIR}/format/acdf/layout.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/acdf COMPONENT reader)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/reader/acdf DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT reader
    FILES_MATCHING PATTERN *.h)
foreach(room IN LISTS ACDF_ROOMS)
    install(TARGETS acdf_${room} EXPORT acdf_${room}_targets COMPONENT ${room}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/${room}/acdf/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/acdf
        COMPONENT ${room} FILES_MATCHING PATTERN *.h)
    install(EXPORT acdf_${room}_targets FILE acdf_${room}.cmake NAMESPACE acdf:: DESTINATION ${ACDF_CMAKE_DIR}
        COMPONENT ${room})
endforeach()

install(EXPORT acdfTargets NAMESPACE acdf:: DESTINATION ${ACDF_CMAKE_DIR} COMPONENT reader)
if(TARGET acdf_builder)
    install(TARGETS acdf_builder EXPORT acdfBuilderTargets COMPONENT builder
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(FILES
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/accuracy.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/builder.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/maps.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/outcome.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/pixels.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/learn.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/rebuild.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/rebuild_c.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/renderers.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/acdf COMPONENT builder)
    install(EXPORT acdfBuilderTargets NAMESPACE acdf:: DESTINATION ${ACDF_CMAKE_DIR} COMPONENT builder)
endif()
configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/lib/acdfConfig.cmake.in ${PROJECT_BINARY_DIR}/acdfConfig.cmake
    INSTALL_DESTINATION ${ACDF_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/acdfConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/acdfConfig.cmake ${PROJECT_BINARY_DIR}/acdfConfigVersion.cmake
    DESTINATION ${ACDF_CMAKE_DIR} COMPONENT reader)

# From the folder of the .pc files up to the prefix.
file(RELATIVE_PATH ACDF_PC_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" ACDF_PC_PREFIX "${ACDF_PC_PREFIX}")
set(ACDF_PC_ZLIB "")
if(ACDF_ZLIB)
    set(ACDF_PC_ZLIB zlib)
endif()
configure_file(${PROJECT_SOURCE_DIR}/lib/reader/acdf.pc.in ${PROJECT_BINARY_DIR}/acdf.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/acdf.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT reader)
set(ACDF_PC_SUMMARY_batch "many calls at once")
set(ACDF_PC_SUMMARY_arrays "arrays, for other languages")
set(ACDF_PC_SUMMARY_indexed "environments of several maps")
set(ACDF_PC_SUMMARY_curves "files of the paper's own fits")
set(ACDF_PC_SUMMARY_product "light, cosine and BRDF at once")
set(ACDF_PC_SUMMARY_shader "tables for shaders")
set(ACDF_PC_SUMMARY_visibility "light as positions see it")
set(ACDF_PC_NEEDS_batch "acdf, libhwy")
set(ACDF_PC_NEEDS_arrays acdf)
if(ACDF_BUILD_BATCH)
    set(ACDF_PC_NEEDS_arrays "acdf-batch")
endif()
set(ACDF_PC_NEEDS_curves acdf)
set(ACDF_PC_NEEDS_indexed acdf)
set(ACDF_PC_NEEDS_visibility acdf)
set(ACDF_PC_NEEDS_product acdf-visibility)
set(ACDF_PC_NEEDS_shader acdf-indexed)
foreach(room IN LISTS ACDF_ROOMS)
    set(ACDF_PC_ROOM ${room})
    set(ACDF_PC_SUMMARY ${ACDF_PC_SUMMARY_${room}})
    set(ACDF_PC_NEEDS ${ACDF_PC_NEEDS_${room}})
    configure_file(${PROJECT_SOURCE_DIR}/lib/acdf-room.pc.in ${PROJECT_BINARY_DIR}/acdf-${room}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/acdf-${room}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT ${room})
endforeach()
if(TARGET acdf_builder)
    configure_file(${PROJECT_SOURCE_DIR}/lib/build/acdf-builder.pc.in ${PROJECT_BINARY_DIR}/acdf-builder.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/acdf-builder.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT builder)
endif()

if(ACDF_BUILD_SHARED)
    set(shared acdf_reader_shared)
    if(TARGET acdf_builder_shared)
        list(APPEND shared acdf_builder_shared)
    endif()
    install(TARGETS ${shared} EXPORT acdfSharedTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT shared)
    install(EXPORT acdfSharedTargets NAMESPACE acdf:: DESTINATION ${ACDF_CMAKE_DIR} COMPONENT shared)
endif()

if(TARGET acdf)
    install(TARGETS acdf RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
    get_target_property(modules acdf_images ACDF_MODULES)
    install(TARGETS ${modules}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/acdf COMPONENT tools)
    get_target_property(page acdf ACDF_VIEWER_PAGE)
    if(page) # OPTIONAL: compilers for WebAssembly without its libraries make none
        install(FILES ${page} DESTINATION ${CMAKE_INSTALL_DATADIR}/acdf COMPONENT tools OPTIONAL)
    endif()
endif()

# The Python package: where Debian's interpreter looks; in a wheel at its root.
if(TARGET acdf_python)
    set(python_folder ${CMAKE_INSTALL_LIBDIR}/python3/dist-packages)
    if(SKBUILD)
        set(python_folder .)
    endif()
    install(TARGETS acdf_python LIBRARY DESTINATION ${python_folder}/acdf COMPONENT python)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/python/acdf DESTINATION ${python_folder} COMPONENT python
        FILES_MATCHING PATTERN *.py PATTERN *.pyi PATTERN py.typed PATTERN __pycache__ EXCLUDE)
endif()

if(NOT SKBUILD)
    include(${CMAKE_CURRENT_LIST_DIR}/packages.cmake)
endif()
