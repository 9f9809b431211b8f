if(NOT TARGET acdf_measure)
    return()
endif()

acdf_add_test(test_measure
    SOURCES
        measure_accuracy.cpp
        measure_cells.cpp
        measure_full_cdf.cpp
    LIBRARIES acdf_measure)

# The rivals of local environment maps.
acdf_add_test(test_measure_local
    SOURCES
        measure_local_rivals.cpp
        measure_tiling.cpp
        measure_rival_probes.cpp
    LIBRARIES acdf_measure acdf_input)

# The rivals of BRDF files.
acdf_add_test(test_measure_brdf_rivals SHARDS 2
    SOURCES measure_brdf_rivals.cpp
    LIBRARIES acdf_measure acdf_input)

# Samplers of light behind one interface, and what is done with them.
acdf_add_test(test_measure_samplers
    SOURCES
        measure_estimators.cpp
        measure_light_samplers.cpp
        measure_scanline.cpp
    LIBRARIES acdf_measure)
set_source_files_properties(measure_light_samplers.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

if(TARGET acdf_brdf)
    acdf_add_test(test_measure_files
        SOURCES measure_file_samplers.cpp
        LIBRARIES acdf_measure acdf_input acdf_brdf)
endif()
