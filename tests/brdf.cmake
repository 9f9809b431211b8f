# BRDFs: the reader's part against the specification, what bins share, and fits of them.
acdf_add_test(test_brdf_reader SOURCES brdf_reader.cpp LIBRARIES acdf_reader ZLIB::ZLIB)

if(TARGET acdf_brdf)
    acdf_add_test(test_brdf
        SOURCES brdf_density.cpp brdf_real.cpp brdf_shared.cpp
        LIBRARIES acdf_brdf)
endif()
