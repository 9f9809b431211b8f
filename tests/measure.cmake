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
acdf_add_test(test_measure_brdf_rivals
    SOURCES measure_brdf_rivals.cpp
    LIBRARIES acdf_measure acdf_input)
