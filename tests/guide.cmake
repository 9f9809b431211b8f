# The program in docs/guide.md: extracted, built against the installed reader, and run on a file of its own sky.
if(TARGET acdf AND NOT ACDF_SANITIZE)
    add_test(NAME docs.guide
        COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/guide.sh
            ${PROJECT_SOURCE_DIR}/docs/guide.md ${PROJECT_BINARY_DIR} $<TARGET_FILE:acdf> ${CMAKE_CXX_COMPILER}
            $<TARGET_FILE:make_guide_sky>)
    set_tests_properties(docs.guide PROPERTIES LABELS packaging TIMEOUT 300)
    add_executable(make_guide_sky make_guide_sky.cpp)
    target_link_libraries(make_guide_sky PRIVATE acdf_options OpenImageIO::OpenImageIO)
endif()
