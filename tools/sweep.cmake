# The rows, texts and pages of `acdf sweep`, apart from the program so that tests can call them.
add_library(acdf_sweep STATIC
    report_chart.cpp
    report_html.cpp
    sweep_advice.cpp
    sweep_brdf.cpp
    sweep_build.cpp
    sweep_environment.cpp
    sweep_irradiance.cpp
    sweep_local.cpp
    sweep_rivals.cpp
    sweep_text.cpp
    sweep_timing.cpp
)
target_include_directories(acdf_sweep PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(acdf_sweep
    PUBLIC acdf_files acdf_brdf acdf_plot acdf_measure nlohmann_json::nlohmann_json
    PRIVATE acdf_options TBB::tbb)
