# The decoder that was written from SPEC.md alone (format/decoder), in Python with NumPy, against the program. The
# interpreter is Debian's, whose NumPy is that of tools/packages.txt, where there is one.
find_program(ACDF_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(ACDF_PYTHON python3)
if(ACDF_PYTHON)
    execute_process(COMMAND ${ACDF_PYTHON} -c "import numpy" RESULT_VARIABLE acdf_no_numpy OUTPUT_QUIET ERROR_QUIET)
    if(acdf_no_numpy)
        message(STATUS "no NumPy for ${ACDF_PYTHON}: the test of format/decoder is left out")
    elseif(TARGET acdf AND TARGET make_vectors AND NOT ACDF_SANITIZE) # it tests the format, and runs no code of its own
        get_property(acdf_rules DIRECTORY lib/reader PROPERTY ACDF_PROGRAM_OF_test_reader_rules)
        get_property(acdf_visibility_rules DIRECTORY lib/visibility PROPERTY ACDF_PROGRAM_OF_test_visibility_rules)
        add_test(NAME decoder
            COMMAND ${ACDF_PYTHON} -B ${CMAKE_CURRENT_LIST_DIR}/decoder.py
                --program $<TARGET_FILE:acdf> --make-vectors $<TARGET_FILE:make_vectors>
                --broken-files $<TARGET_FILE:${acdf_rules}> --broken-files $<TARGET_FILE:${acdf_visibility_rules}>)
        set_tests_properties(decoder PROPERTIES TIMEOUT 600 COST 20 LABELS decoder)
    endif()
endif()
