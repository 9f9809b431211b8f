if(NOT TARGET acdf_compress)
    return()
endif()
find_package(rapidcheck REQUIRED)

acdf_add_test(test_compress SHARDS 4
    SOURCES
        compress_curve.cpp
        compress_join.cpp
        compress_planes.cpp
        compress_polyline.cpp
        compress_quantize.cpp
        compress_regional.cpp
        compress_store.cpp
        compress_two_lights.cpp
        compress_tree.cpp
        compress_variance.cpp
        compress_seed.cpp
        lib/compress/growth.cpp
    LIBRARIES acdf_measure rapidcheck)
acdf_add_test(test_compress_fits
    SOURCES compress_checks.cpp compress_fits.cpp
    LIBRARIES acdf_measure)
acdf_add_test(test_compress_probes
    SOURCES compress_checks.cpp compress_probes.cpp
    LIBRARIES acdf_input acdf_measure)
acdf_add_test(test_compress_golden
    SOURCES compress_golden.cpp local_golden.cpp
    LIBRARIES acdf_compress)
target_compile_definitions(test_compress_golden PRIVATE ACDF_MAKE_GOLDEN="$<TARGET_FILE:make_golden>")
add_dependencies(test_compress_golden make_golden)
set_source_files_properties(compress_variance.cpp local_golden.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
