# What `acdf table` stands on, apart from the program so that tests can call it.
add_library(acdf_table STATIC table.cpp)
target_include_directories(acdf_table PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(acdf_table PRIVATE ACDF_VERSION="${PROJECT_VERSION}")
target_link_libraries(acdf_table PUBLIC acdf_compress acdf_input acdf_measure PRIVATE acdf_options)
