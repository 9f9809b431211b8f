# Installs the reader alone, moves it elsewhere, and builds the consumers against it: once through
# find_package(acdf), once with nothing but pkg-config and the compiler, which links what is in C++ as it was compiled. Their link lines may hold zlib and the
# language's own runtime, no more.
#
# cmake -DBUILD=... -DWORK=... -DFILE=... -DCC=... -DCXX=... -DLIBDIR=... -P check_installed.cmake
cmake_minimum_required(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/../checks.cmake)

# expect_missing_file(PROGRAM): an error is a message and an exit code, no crash.
function(expect_missing_file program)
    execute_process(COMMAND ${program} ${WORK}/no-such-file.acdf RESULT_VARIABLE result ERROR_VARIABLE err)
    if(NOT result EQUAL 1 OR NOT err MATCHES "no-such-file\\.acdf: .+")
        message(FATAL_ERROR "${program} on a missing file: exit code ${result}, message '${err}'")
    endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
run(ignored ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed --component reader)
file(RENAME ${WORK}/installed ${WORK}/prefix)
file(GLOB_RECURSE programs ${WORK}/prefix/bin/*)
if(programs)
    message(FATAL_ERROR "the component `reader` installs programs: ${programs}")
endif()

# All headers that were installed find what they include; that each may stand alone is seen where the library is built. In C:
# those that are not of C++ alone.
file(GLOB headers RELATIVE ${WORK}/prefix/include ${WORK}/prefix/include/acdf/*.h)
list(FILTER headers EXCLUDE REGEX "words.h$") # which other headers include in the middle
set(of_c)
set(of_cpp)
foreach(header IN LISTS headers)
    string(APPEND of_cpp "#include <${header}>\n")
    file(STRINGS ${WORK}/prefix/include/${header} once REGEX "^#pragma once" LIMIT_COUNT 1)
    if(NOT once)
        string(APPEND of_c "#include <${header}>\n")
    endif()
endforeach()
foreach(header layout sample local brdf table acdf reader views)
    if(NOT of_cpp MATCHES "<acdf/${header}\\.h>" OR NOT header MATCHES "reader|views" AND NOT of_c MATCHES "<acdf/${header}\\.h>")
        message(FATAL_ERROR "acdf/${header}.h is not installed, or in another language: ${headers}")
    endif()
endforeach()
set(strict -Wall -Wextra -Wconversion -Werror -I${WORK}/prefix/include -fsyntax-only)
file(WRITE ${WORK}/all.c "${of_c}")
file(WRITE ${WORK}/all.cpp "${of_cpp}")
run(ignored ${CC} -std=c99 ${strict} ${WORK}/all.c)
run(ignored ${CXX} -std=c++17 ${strict} ${WORK}/all.cpp)

# find_package: the reader alone asks for zlib alone.
run(ignored ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G Ninja -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=None # optimising takes longest
    -DCMAKE_C_COMPILER=${CC} -DCMAKE_CXX_COMPILER=${CXX})
run(ignored ${CMAKE_COMMAND} --build ${WORK}/build)

# pkg-config; the C program by the C compiler, which links no C++ runtime.
set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/${LIBDIR}/pkgconfig)
run(flags pkg-config --cflags --libs acdf)
string(STRIP "${flags}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(ignored ${CC} -std=c99 ${CMAKE_CURRENT_LIST_DIR}/consumer.c -o ${WORK}/pkgconfig_c ${flags})
file(GLOB_RECURSE compiled ${WORK}/build/consumer.cpp.o) # its headers are where those of the C program were
run(ignored ${CXX} ${compiled} -o ${WORK}/pkgconfig_cpp ${flags})

set(runtime z m c gcc_s stdc++ ld-linux-x86-64 ld-linux-aarch64)
foreach(program build/consumer_c build/consumer_cpp pkgconfig_c pkgconfig_cpp)
    set(allowed ${runtime})
    if(program STREQUAL pkgconfig_c)
        list(REMOVE_ITEM allowed stdc++ gcc_s)
    endif()
    expect_needed(${WORK}/${program} ${allowed})
    expect_missing_file(${WORK}/${program})
    run(output ${WORK}/${program} ${FILE})
    if(NOT DEFINED expected)
        set(expected "${output}")
    elseif(NOT output STREQUAL expected)
        message(FATAL_ERROR "${program} samples other samples:\n${output}\nthan the first consumer:\n${expected}")
    endif()
endforeach()
if(NOT expected MATCHES "^total [0-9].*\n.*\n")
    message(FATAL_ERROR "the consumers printed no samples: ${expected}")
endif()

# The rooms beside the reader: none of their headers came with it.
file(GLOB folders ${WORK}/prefix/include/acdf/*/)
foreach(folder IN LISTS folders)
    if(IS_DIRECTORY ${folder})
        message(FATAL_ERROR "the component `reader` installs ${folder}")
    endif()
endforeach()
set(rooms arrays curves indexed visibility product shader)
set(needs)
if(BATCH)
    list(APPEND rooms batch)
    set(needs hwy) # batches alone
endif()
foreach(room IN LISTS rooms)
    run(ignored ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component ${room})
endforeach()
run(ignored ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/../rooms -B ${WORK}/rooms -G Ninja
    -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=None
    -DCMAKE_CXX_COMPILER=${CXX} -DBATCH=${BATCH})
run(ignored ${CMAKE_COMMAND} --build ${WORK}/rooms)
list(TRANSFORM rooms PREPEND acdf- OUTPUT_VARIABLE packages)
list(REVERSE packages)
run(flags pkg-config --cflags --libs ${packages})
string(STRIP "${flags}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
file(GLOB_RECURSE compiled ${WORK}/rooms/rooms.cpp.o)
run(ignored ${CXX} ${compiled} -o ${WORK}/pkgconfig_rooms ${flags})
foreach(program rooms/rooms pkgconfig_rooms)
    expect_needed(${WORK}/${program} ${runtime} ${needs})
    run(output ${WORK}/${program} ${LIGHT} ${CURVES})
    if(NOT output MATCHES "^product and shader: [1-9]")
        message(FATAL_ERROR "${program} printed: ${output}")
    endif()
endforeach()
