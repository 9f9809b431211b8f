# Local environment maps: the reader's part against the specification, and fits of them.
add_library(acdf_test_local_c99 OBJECT local_c99.c)
target_link_libraries(acdf_test_local_c99 PRIVATE acdf_reader acdf_options)
set_target_properties(acdf_test_local_c99 PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF)
acdf_add_test(test_local_reader
    SOURCES local_reader.cpp $<TARGET_OBJECTS:acdf_test_local_c99>
    LIBRARIES acdf_reader ZLIB::ZLIB)

if(NOT TARGET acdf_input)
    return()
endif()
acdf_add_test(test_local SHARDS 3 COST 10
    SOURCES local_density.cpp local_fit.cpp
    LIBRARIES acdf_compress acdf_input TBB::tbb)
# The figures that docs/local.md tells.
acdf_add_test(test_local_probes COST 60 SOURCES local_probes.cpp LIBRARIES acdf_files)
acdf_add_test(test_local_files SHARDS 3 SOURCES local_files.cpp LIBRARIES acdf_files)
if(TARGET acdf)
    acdf_add_test(test_local_tools SHARDS 3
        SOURCES local_tools.cpp local_command.cpp
        LIBRARIES acdf_plot acdf_tools nlohmann_json::nlohmann_json)
    target_compile_definitions(test_local_tools PRIVATE ACDF_PROGRAM="$<TARGET_FILE:acdf>")
    acdf_compile_quickly(test_local_tools)
    add_dependencies(test_local_tools acdf)
endif()
