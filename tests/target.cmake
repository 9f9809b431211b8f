# Channels and filters.
if(TARGET acdf_measure)
    acdf_add_test(test_target SOURCES target.cpp LIBRARIES acdf_measure acdf_compress)
endif()
