# What must hold at the ends of what numbers can hold.
acdf_add_test(test_fast_math
    SOURCES extremes_fast_math.cpp fast_math.cpp
    LIBRARIES acdf_reader)
set_source_files_properties(fast_math.cpp PROPERTIES COMPILE_OPTIONS "-ffast-math;-O2")

if(NOT TARGET acdf_input)
    return()
endif()
acdf_add_test(test_extremes
    SOURCES compress_checks.cpp extremes_fits.cpp extremes_reach.cpp extremes_sums.cpp
    LIBRARIES acdf_measure)
acdf_add_test(test_extremes_brdf COST 40
    SOURCES extremes_brdf.cpp
    LIBRARIES acdf_brdf)
acdf_add_test(test_extremes_local
    SOURCES extremes_local.cpp
    LIBRARIES acdf_compress acdf_input TBB::tbb)
acdf_add_test(test_runtime_tables
    SOURCES compress_checks.cpp lib/reader/runtime_tables.cpp
    LIBRARIES acdf_measure)
