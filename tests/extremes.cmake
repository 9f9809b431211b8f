# What must hold at the ends of what numbers can hold.
if(NOT TARGET acdf_input)
    return()
endif()
acdf_add_test(test_extremes
    SOURCES compress_checks.cpp extremes_fits.cpp extremes_reach.cpp extremes_sums.cpp
    LIBRARIES acdf_measure)
