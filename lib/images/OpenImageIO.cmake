# Debian 12's OpenImageIO package names the include folder of OpenCV, on which it does not depend: CMake would
# refuse the target where that folder is absent.
find_package(OpenImageIO REQUIRED)
foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(folders OpenImageIO::OpenImageIO ${property})
    if(folders)
        list(FILTER folders EXCLUDE REGEX "/opencv4$")
        set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${folders}")
    endif()
endforeach()
