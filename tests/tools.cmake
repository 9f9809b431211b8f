# The acdf program and the parts its subcommands stand on.
if(TARGET acdf)
    acdf_add_test(test_tools SHARDS 3
        SOURCES c_api.cpp tools_commands.cpp tools_output.cpp tools_parts.cpp
        LIBRARIES acdf_tools acdf_compress nlohmann_json::nlohmann_json)
    target_compile_definitions(test_tools PRIVATE
        ACDF_PROGRAM="$<TARGET_FILE:acdf>" ACDF_VERSION="${PROJECT_VERSION}")
    acdf_compile_quickly(test_tools)
    add_dependencies(test_tools acdf)
endif()
