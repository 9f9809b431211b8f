# What `acdf batch` stands on, apart from the program so that tests can call it.
add_library(acdf_batch STATIC
    batch_jobs.cpp
    batch_manifest.cpp
    batch_memory.cpp
    batch_ninja.cpp
    batch_plan.cpp
    batch_report.cpp
    batch_run.cpp
    batch_shard.cpp
)
target_include_directories(acdf_batch PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(acdf_batch
    PUBLIC acdf_files acdf_tools acdf_input CLI11::CLI11 nlohmann_json::nlohmann_json
    PRIVATE acdf_options TBB::tbb)
