# The pictures of `acdf plot`, and the subcommand itself.
if(TARGET acdf_plot)
    acdf_add_test(test_plot SHARDS 2
        SOURCES plot_command.cpp plot_colours.cpp plot_density.cpp plot_knots.cpp plot_legend.cpp plot_range.cpp
        LIBRARIES acdf_plot acdf_measure acdf_tools)
    target_compile_definitions(test_plot PRIVATE ACDF_PROGRAM="$<TARGET_FILE:acdf>")
    acdf_compile_quickly(test_plot)
    add_dependencies(test_plot acdf)
endif()
