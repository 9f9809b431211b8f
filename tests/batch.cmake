# acdf batch: its parts, and the program as a user runs it.
if(TARGET acdf_batch)
    acdf_add_test(test_batch SHARDS 8 COST 20
        SOURCES batch_command.cpp batch_parts.cpp batch_run.cpp
        LIBRARIES acdf_batch acdf_compress nlohmann_json::nlohmann_json)
    target_compile_definitions(test_batch PRIVATE ACDF_PROGRAM="$<TARGET_FILE:acdf>")
    acdf_compile_quickly(test_batch)
    add_dependencies(test_batch acdf)
    add_executable(make_batch_probes make_batch_probes.cpp)
    target_link_libraries(make_batch_probes PRIVATE acdf_options)
endif()
