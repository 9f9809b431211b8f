# What becomes of outputs on full disks, in folders that refuse, and where programs are ended at any moment.
if(TARGET acdf)
    acdf_add_test(test_disk SHARDS 2
        SOURCES disk_files.cpp disk_kill.cpp
        LIBRARIES acdf_tools acdf_compress)
    target_compile_definitions(test_disk PRIVATE ACDF_PROGRAM="$<TARGET_FILE:acdf>")
    add_dependencies(test_disk acdf)
endif()
