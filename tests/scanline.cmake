# The study of one row's knots, as a user runs it.
if(TARGET acdf_plot)
    acdf_add_test(test_scanline
        SOURCES scanline_command.cpp
        LIBRARIES acdf_plot acdf_tools nlohmann_json::nlohmann_json)
    target_compile_definitions(test_scanline PRIVATE ACDF_PROGRAM="$<TARGET_FILE:acdf>")
    acdf_compile_quickly(test_scanline)
    add_dependencies(test_scanline acdf)
endif()
