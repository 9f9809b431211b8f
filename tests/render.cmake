# `acdf render`: scenes, samplers, statistics, and the subcommand itself.
if(TARGET acdf_render)
    acdf_add_test(test_render SHARDS 3
        SOURCES render_command.cpp render_files.cpp render_geometry.cpp render_samplers.cpp render_statistics.cpp
        LIBRARIES acdf_render acdf_tools TBB::tbb)
    target_compile_definitions(test_render PRIVATE
        ACDF_PROGRAM="$<TARGET_FILE:acdf>" ACDF_SCENES="${PROJECT_SOURCE_DIR}/tools/scenes")
    add_dependencies(test_render acdf)
endif()
