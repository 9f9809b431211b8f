# Tests of lib/reader and format/.
find_package(ZLIB REQUIRED)

# Each public header alone, as the languages it is written for.
foreach(header layout elementary random tree sphere octahedral grid sample blend brdf local table)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/header_${header}.c)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include <acdf/${header}.h>\nint acdf_header_${header};\n")
    list(APPEND acdf_header_sources ${source})
endforeach()
foreach(header layout elementary random tree sphere octahedral grid sample blend brdf local table reader)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/header_${header}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include <acdf/${header}.h>\nextern \"C\" int acdf_header_${header}_cpp;\n")
    list(APPEND acdf_header_sources ${source})
endforeach()
add_library(acdf_test_headers OBJECT ${acdf_header_sources})
target_link_libraries(acdf_test_headers PRIVATE acdf_reader acdf_options)
set_target_properties(acdf_test_headers PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF)

add_library(acdf_test_c99 OBJECT reader_c99.c)
target_link_libraries(acdf_test_c99 PRIVATE acdf_reader acdf_options)
set_target_properties(acdf_test_c99 PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF)

acdf_add_test(test_reader_sampling
    SOURCES reader_sampling.cpp $<TARGET_OBJECTS:acdf_test_c99>
    LIBRARIES acdf_reader ZLIB::ZLIB)
add_dependencies(test_reader_sampling acdf_test_headers)
acdf_add_test(test_octahedral SOURCES octahedral.cpp LIBRARIES acdf_reader)
acdf_add_test(test_reader_rules SOURCES reader_rules.cpp reader_rules_local.cpp reader_rules_brdf.cpp LIBRARIES acdf_reader ZLIB::ZLIB)
acdf_add_test(test_reader_load SOURCES reader_load.cpp LIBRARIES acdf_reader ZLIB::ZLIB)
acdf_add_test(test_reader_spec SOURCES reader_spec.cpp LIBRARIES acdf_reader ZLIB::ZLIB)
acdf_add_test(test_reader_memory SOURCES reader_memory.cpp LIBRARIES acdf_reader ZLIB::ZLIB)
target_link_options(test_reader_memory PRIVATE -Wl,--wrap=malloc,--wrap=calloc,--wrap=aligned_alloc)

# The reader's sources once more, so that their work can be counted: each basic block calls a function of the test.
get_target_property(acdf_reader_sources acdf_reader SOURCES)
list(TRANSFORM acdf_reader_sources PREPEND ${PROJECT_SOURCE_DIR}/lib/reader/)
add_library(acdf_test_counted_reader OBJECT ${acdf_reader_sources})
target_include_directories(acdf_test_counted_reader PRIVATE
    ${PROJECT_SOURCE_DIR}/format ${PROJECT_SOURCE_DIR}/lib/reader)
target_compile_options(acdf_test_counted_reader PRIVATE -fsanitize-coverage=trace-pc)
target_link_libraries(acdf_test_counted_reader PRIVATE ZLIB::ZLIB acdf_options)
acdf_add_test(test_reader_hostile
    SOURCES reader_hostile.cpp $<TARGET_OBJECTS:acdf_test_counted_reader>
    LIBRARIES ZLIB::ZLIB)
target_include_directories(test_reader_hostile PRIVATE
    ${PROJECT_SOURCE_DIR}/format ${PROJECT_SOURCE_DIR}/lib/reader)
target_link_options(test_reader_hostile PRIVATE -Wl,--wrap=malloc,--wrap=calloc,--wrap=aligned_alloc)
