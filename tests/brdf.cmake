# BRDFs: the reader's part against the specification, what bins share, fits of them, and the subcommand.
acdf_add_test(test_brdf_reader SOURCES brdf_reader.cpp brdf_golden.cpp wavefront.cpp LIBRARIES acdf_reader ZLIB::ZLIB)

if(TARGET acdf_brdf)
    acdf_add_test(test_brdf SHARDS 2 COST 20
        SOURCES brdf_command.cpp brdf_density.cpp brdf_real.cpp brdf_shared.cpp
        LIBRARIES acdf_brdf nlohmann_json::nlohmann_json)
    target_compile_definitions(test_brdf PRIVATE ACDF_PROGRAM="$<TARGET_FILE:acdf>")
    add_dependencies(test_brdf acdf)
endif()
