if(NOT TARGET acdf_measure)
    return()
endif()

acdf_add_test(test_measure
    SOURCES
        measure_accuracy.cpp
        measure_cells.cpp
        measure_full_cdf.cpp
    LIBRARIES acdf_measure)
