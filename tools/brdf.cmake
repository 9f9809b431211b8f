# What `acdf brdf` stands on, apart from the program so that tests can call it.
add_library(acdf_brdf STATIC brdf.cpp)
target_include_directories(acdf_brdf PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(acdf_brdf PRIVATE ACDF_VERSION="${PROJECT_VERSION}")
target_link_libraries(acdf_brdf PUBLIC acdf_tools acdf_compress acdf_input acdf_measure PRIVATE acdf_options)
