# An overlay port (`vcpkg install acdf --overlay-ports=lib/recipes/vcpkg`): the checkout that it lies in.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES builder ACDF_BUILD_BUILDER)
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS ${features} -DACDF_BUILD_TOOLS=OFF -DACDF_BUILD_TESTS=OFF -DACDF_BUILD_PYTHON=OFF -DACDF_BUILD_SHARED=OFF
        -DACDF_BUILD_BATCH=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/acdf)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/share/doc")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
