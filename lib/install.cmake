# Installs the reader and the builder, components `reader` and, which needs the first, `builder`: headers, a static library
# each, one CMake package and a pkg-config file each. Both as shared libraries: `runtime`, and what links to them, `shared`.
# The program: `tools`, its pages and completions `manual`. The Python package: `python`.
# Everything is relocatable: the prefix may be moved or staged after installation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(ACDF_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/acdf)

install(TARGETS acdf_reader EXPORT acdfTargets COMPONENT reader
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES
    ${PROJECT_SOURCE_DIR}/format/acdf/layout.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/acdf.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/allocator.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/blend.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/brdf.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/brdf_about.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/brdf_half.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/brdf_pair.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/brdf_tables.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/brdf_view.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/cells.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/partner.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/cut.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/cut_sample.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/cut_wave.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/dialect.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/dialect_c.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/dialect_words.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/elementary.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/fast.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/fast_cut.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/fast_rows.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/grid.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/halvings.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/linked.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/lobe.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local_corners.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local_fast.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local_fast_point.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/bright_tiles.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local_parts.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local_pdf.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local_position.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local_point.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/local_tables.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/method.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/moved.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/normals.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/octahedral.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/part_queue.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/part_rating.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/pieces.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/visibility.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/portals.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/product.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/product_c.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/product_cut.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/product_groups.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/product_point.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/random.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/reader.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/row_heights.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/sample.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/shader_brdf.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/shader_grids.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/shader_point.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/shader_square.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/shader_tables.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/shader_tiles.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/shader_tree.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/shader_walk.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/short_curves.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/sphere.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/squares.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/table.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/table_entries.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/tile_blocks.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/tile_tables.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/tree.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/views.h
    ${PROJECT_SOURCE_DIR}/lib/reader/acdf/wavefront.h
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/acdf COMPONENT reader)

install(EXPORT acdfTargets NAMESPACE acdf:: DESTINATION ${ACDF_CMAKE_DIR} COMPONENT reader)
if(TARGET acdf_builder)
    install(TARGETS acdf_builder EXPORT acdfBuilderTargets COMPONENT builder
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(FILES
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/accuracy.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/builder.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/outcome.h
        ${PROJECT_SOURCE_DIR}/lib/build/acdf/pixels.h
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
configure_file(${PROJECT_SOURCE_DIR}/lib/reader/acdf.pc.in ${PROJECT_BINARY_DIR}/acdf.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/acdf.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT reader)
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
