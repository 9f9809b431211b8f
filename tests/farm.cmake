# The scripts of tools/farm on Ninja, GNU parallel and Slurm: `ctest -L farm`. Those whose engine is missing, and cannot
# be installed, are skipped.
if(TARGET acdf AND TARGET make_batch_probes AND NOT ACDF_SANITIZE)
    foreach(engine ninja parallel slurm)
        add_test(NAME farm.${engine}
            COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/farm.sh ${engine}
                $<TARGET_FILE:acdf> $<TARGET_FILE:make_batch_probes>)
        set_tests_properties(farm.${engine} PROPERTIES
            LABELS farm COST 25 TIMEOUT 600 SKIP_RETURN_CODE 77 RESOURCE_LOCK farm_packages)
    endforeach()
endif()
