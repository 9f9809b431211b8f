# The pictures of `acdf plot`, apart from the program so that tests can call them.
add_library(acdf_plot STATIC
    plot_brdf.cpp
    plot_colour.cpp
    plot_density.cpp
    plot_image.cpp
    plot_knots.cpp
    plot_legend.cpp
    plot_local.cpp
    plot_range.cpp
)
target_include_directories(acdf_plot PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(acdf_plot
    PUBLIC acdf_compress acdf_input CLI11::CLI11 OpenImageIO::OpenImageIO
    PRIVATE acdf_options TBB::tbb)
