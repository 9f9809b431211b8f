# Installs the reader and the builder, moves them elsewhere, and builds the examples of the builder against them: once
# through find_package(acdf COMPONENTS builder), once with nothing but pkg-config and the compiler. What they load is oneTBB,
# zlib and the language's own runtime, no more: no reader of images, JSON or cryptography.
#
# cmake -DSOURCE=... -DBUILD=... -DWORK=... -DCXX=... -DLIBDIR=... -P check_installed.cmake
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/../checks.cmake)

set(EXAMPLES ${SOURCE}/docs/examples)
set(configure ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -G Ninja -DEXAMPLES=${EXAMPLES}
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER=${CXX})

# refuse(WHY COMMAND...): the command fails and says why.
function(refuse why)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE err)
    if(result EQUAL 0 OR NOT "${out}${err}" MATCHES "${why}")
        message(FATAL_ERROR "${ARGN}\nwas to fail with '${why}', but: ${result}\n${out}${err}")
    endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
run(ignored ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed --component reader)
file(RENAME ${WORK}/installed ${WORK}/prefix)
refuse("builder" ${configure} -B ${WORK}/without) # the reader alone has none
foreach(room curves indexed visibility) # which the builder needs
    run(ignored ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component ${room})
endforeach()
run(ignored ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component builder)

# Three headers, each alone; nothing of the library's own is installed with them.
run(ignored ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/own --component builder)
file(GLOB_RECURSE headers RELATIVE ${WORK}/own/include ${WORK}/own/include/*)
if(NOT headers STREQUAL "acdf/accuracy.h;acdf/builder.h;acdf/learn.h;acdf/maps.h;acdf/outcome.h;acdf/pixels.h;acdf/rebuild.h;acdf/rebuild_c.h;acdf/renderers.h")
    message(FATAL_ERROR "installed headers: ${headers}")
endif()
foreach(header accuracy builder learn maps renderers)
    file(WRITE ${WORK}/alone.cpp "#include <acdf/${header}.h>\n")
    run(ignored ${CXX} -std=c++17 -Wall -Wextra -Wconversion -Werror -I${WORK}/prefix/include
        -fsyntax-only ${WORK}/alone.cpp)
endforeach()

# The program at the top of the header is the example.
file(READ ${WORK}/prefix/include/acdf/builder.h header)
file(READ ${EXAMPLES}/build_environment.cpp program)
string(REPLACE "\n//     " "\n" header "${header}")
string(REPLACE "\n//\n" "\n\n" header "${header}")
string(FIND "${header}" "${program}" found)
if(found EQUAL -1)
    message(FATAL_ERROR "acdf/builder.h does not quote docs/examples/build_environment.cpp:\n${program}")
endif()

refuse("TBB" ${configure} -B ${WORK}/without_tbb -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON)
run(ignored ${configure} -B ${WORK}/build)
run(ignored ${CMAKE_COMMAND} --build ${WORK}/build)
set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/${LIBDIR}/pkgconfig)
run(flags pkg-config --cflags --libs acdf-builder)
string(STRIP "${flags}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(ignored ${CXX} -std=c++17 ${EXAMPLES}/build_environment.cpp -o ${WORK}/pkgconfig ${flags})

foreach(program build/build_environment build/embed_builder pkgconfig)
    expect_needed(${WORK}/${program} tbb z m c gcc_s stdc++ ld-linux-x86-64 ld-linux-aarch64)
    run(loaded ldd ${WORK}/${program}) # and what those load in turn
    string(TOLOWER "${loaded}" loaded)
    if(loaded MATCHES "imageio|openexr|imath|freetype|png|assimp|crypto|ssl|json|cli11")
        message(FATAL_ERROR "${program} loads ${loaded}")
    endif()
endforeach()

run(expected ${WORK}/build/build_environment)
run(same ${WORK}/pkgconfig)
if(NOT expected MATCHES "^relative variance [0-9.e-]+; a direction .* per steradian\n$" OR NOT same STREQUAL expected)
    message(FATAL_ERROR "the example printed: ${expected}${same}")
endif()

# The sky of embed_builder: its integral is that of the sky (1.5 pi), of the ground (0.2 pi) and of the sun, 1 - 0.99966
# of 2 pi at 5000; on the ground 5/6 pi and the sun at cosine 0.8.
run(printed ${WORK}/build/embed_builder 512)
if(NOT printed MATCHES "^([0-9]+) bytes in .* relative variance ([0-9.e-]+); irradiance ([0-9.]+), the map's integral ([0-9.]+)\n$")
    message(FATAL_ERROR "embed_builder printed: ${printed}")
endif()
set(bytes ${CMAKE_MATCH_1})
set(irradiance ${CMAKE_MATCH_3})
set(total ${CMAKE_MATCH_4})
if(bytes GREATER 65536 OR total LESS 15.6 OR total GREATER 16.6 OR irradiance LESS 10.8 OR irradiance GREATER 11.6)
    message(FATAL_ERROR "embed_builder printed: ${printed}")
endif()
execute_process(COMMAND ${WORK}/build/embed_builder 1 RESULT_VARIABLE result ERROR_VARIABLE err)
if(NOT result EQUAL 2 OR NOT err MATCHES "width")
    message(FATAL_ERROR "embed_builder with a width of 1: ${result} ${err}")
endif()

# The library is configured without the packages of the tools.
run(ignored ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/alone -G Ninja -DCMAKE_CXX_COMPILER=${CXX}
    -DACDF_BUILD_TOOLS=OFF -DACDF_BUILD_BUILDER=ON -DACDF_BUILD_TESTS=OFF
    -DCMAKE_DISABLE_FIND_PACKAGE_OpenSSL=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenImageIO=ON
    -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON
    -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON)
run(targets ${CMAKE_COMMAND} --build ${WORK}/alone --target help)
if(NOT targets MATCHES "acdf_builder" OR targets MATCHES "acdf_input")
    message(FATAL_ERROR "the builder's own build has these targets: ${targets}")
endif()
