# The rows, words and pages of `acdf sweep`; the page in a browser.
if(TARGET acdf_sweep)
    acdf_add_test(test_sweep SHARDS 2 SOURCES sweep.cpp LIBRARIES acdf_sweep)
    acdf_add_test(test_sweep_command SHARDS 2 SOURCES sweep_command.cpp LIBRARIES acdf_plot nlohmann_json::nlohmann_json)
    target_compile_definitions(test_sweep_command PRIVATE ACDF_PROGRAM="$<TARGET_FILE:acdf>")
    acdf_compile_quickly(test_sweep_command)
    add_dependencies(test_sweep_command acdf)
    if(NOT ACDF_SANITIZE) # nothing in it that the tests above do not run
        add_test(NAME report_browser
            COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/report_browser.sh $<TARGET_FILE:acdf> $<TARGET_FILE:make_guide_sky>)
        set_tests_properties(report_browser PROPERTIES SKIP_RETURN_CODE 77 COST 15 TIMEOUT 300)
    endif()
endif()
