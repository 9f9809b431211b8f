# What `acdf render` stands on, apart from the program so that tests can call it.
add_library(acdf_render STATIC
    demo_probes.cpp
    render_images.cpp
    render_report.cpp
    render_scene.cpp
    sampler_build.cpp
    sampler_spec.cpp
    scene_file.cpp
    scene_json.cpp
)
target_include_directories(acdf_render PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(acdf_render
    PUBLIC acdf_files acdf_brdf acdf_plot acdf_measure nlohmann_json::nlohmann_json
    PRIVATE acdf_options TBB::tbb)
