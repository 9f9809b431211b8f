# OpenImageIO::OpenImageIO and OpenImageIO_VERSION, found by header and libraries: the CMake files of Debian 12's package ask for
# the programs of another one, which brings Qt and 40 more, and for a folder of OpenCV's.
find_path(OpenImageIO_INCLUDE_DIR OpenImageIO/imageio.h)
find_library(OpenImageIO_LIBRARY OpenImageIO)
find_library(OpenImageIO_UTIL_LIBRARY OpenImageIO_Util)
mark_as_advanced(OpenImageIO_INCLUDE_DIR OpenImageIO_LIBRARY OpenImageIO_UTIL_LIBRARY)
if(OpenImageIO_INCLUDE_DIR)
    set(numbers)
    foreach(part MAJOR MINOR PATCH TWEAK)
        file(STRINGS ${OpenImageIO_INCLUDE_DIR}/OpenImageIO/oiioversion.h line REGEX "^#define OIIO_VERSION_${part} +[0-9]+")
        string(REGEX MATCH "[0-9]+" number "${line}")
        list(APPEND numbers ${number})
    endforeach()
    list(JOIN numbers . OpenImageIO_VERSION)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenImageIO
    REQUIRED_VARS OpenImageIO_LIBRARY OpenImageIO_UTIL_LIBRARY OpenImageIO_INCLUDE_DIR VERSION_VAR OpenImageIO_VERSION)
if(OpenImageIO_FOUND AND NOT TARGET OpenImageIO::OpenImageIO)
    add_library(OpenImageIO::OpenImageIO UNKNOWN IMPORTED)
    set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
        IMPORTED_LOCATION "${OpenImageIO_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${OpenImageIO_INCLUDE_DIR}"
        INTERFACE_LINK_LIBRARIES "${OpenImageIO_UTIL_LIBRARY}")
endif()
