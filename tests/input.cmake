# Reading environment maps. OpenEXR's own mapping functions (ImfEnvmap.h) are an oracle for its layouts.
if(TARGET acdf_input)
    find_package(OpenEXR REQUIRED)
    acdf_add_test(test_input SHARDS 6
        SOURCES
            input_conventions.cpp
            input_detect.cpp
            input_files.cpp
            input_hostile.cpp
            input_probes.cpp
            input_projection.cpp
            input_resample.cpp
            input_scene.cpp
            input_scene_hostile.cpp
        LIBRARIES acdf_input OpenImageIO::OpenImageIO OpenEXR::OpenEXR OpenEXR::OpenEXRUtil)
    set_source_files_properties(input_resample.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endif()

# BRDFs: measured ones, models, tables.
if(TARGET acdf_input)
    acdf_add_test(test_input_brdf
        SOURCES
            input_brdf_files.cpp
            input_brdf_merl.cpp
            input_brdf_models.cpp
            input_brdf_rgl.cpp
        LIBRARIES acdf_input OpenImageIO::OpenImageIO)
endif()
