# The reader as a package: see consumer/check_installed.cmake. Sanitized libraries are for testing only and would need
# their flags in the consumer.
if(NOT ACDF_SANITIZE)
    include(GNUInstallDirs)
    add_test(NAME packaging.installed_reader
        COMMAND ${CMAKE_COMMAND}
            -DBUILD=${PROJECT_BINARY_DIR}
            -DWORK=${PROJECT_BINARY_DIR}/consumer
            -DFILE=${CMAKE_CURRENT_SOURCE_DIR}/golden/v1.0/zlib.acdf
            -DCC=${CMAKE_C_COMPILER} -DCXX=${CMAKE_CXX_COMPILER}
            -DLIBDIR=${CMAKE_INSTALL_LIBDIR}
            -P ${CMAKE_CURRENT_SOURCE_DIR}/consumer/check_installed.cmake)
    set_tests_properties(packaging.installed_reader PROPERTIES LABELS packaging TIMEOUT 600)
endif()
