# Tables of any number of axes: .npy files, the reader's view, the fit, the subcommand, and the example of docs/table.md.
if(TARGET acdf_table)
    acdf_add_test(test_table SHARDS 4
        SOURCES table_command.cpp table_fit.cpp table_npy.cpp table_view.cpp
        LIBRARIES acdf_table nlohmann_json::nlohmann_json)
    add_executable(light_field ${PROJECT_SOURCE_DIR}/docs/examples/light_field.cpp)
    target_link_libraries(light_field PRIVATE acdf_options)
    add_executable(read_table ${PROJECT_SOURCE_DIR}/docs/examples/read_table.cpp)
    target_link_libraries(read_table PRIVATE acdf_reader acdf_options)
    target_compile_definitions(test_table PRIVATE
        ACDF_PROGRAM="$<TARGET_FILE:acdf>" ACDF_EXAMPLES="$<TARGET_FILE_DIR:light_field>")
    acdf_compile_quickly(test_table)
    add_dependencies(test_table acdf light_field read_table)
endif()
