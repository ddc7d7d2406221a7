# cmake -P cmake/umbrella.cmake: writes include/tafoni/tafoni.hpp, which includes every header but interop/ and
# testing/. With -DCHECK=ON it only fails when that file is out of date.

get_filename_component(include_dir "${CMAKE_CURRENT_LIST_DIR}/../include" ABSOLUTE)
set(umbrella "${include_dir}/tafoni/tafoni.hpp")
file(GLOB_RECURSE headers RELATIVE "${include_dir}" "${include_dir}/tafoni/*.hpp")
list(FILTER headers EXCLUDE REGEX "^tafoni/(interop/|testing/|tafoni\\.hpp$|fwd\\.hpp$)|/detail/")
list(SORT headers)

string(CONCAT text
    "/// \\file\n"
    "/// Everything but what needs foreign libraries (interop/) and what tests policies (testing/).\n"
    "/// Written by `cmake -P cmake/umbrella.cmake`; include single headers where build time counts.\n"
    "#ifndef TAFONI_TAFONI_HPP\n"
    "#define TAFONI_TAFONI_HPP\n\n")
foreach(header IN LISTS headers)
    string(APPEND text "#include <${header}>\n")
endforeach()
string(APPEND text "\n#endif\n")

if(CHECK)
    set(old "")
    if(EXISTS "${umbrella}")
        file(READ "${umbrella}" old)
    endif()
    if(NOT old STREQUAL text)
        message(FATAL_ERROR "tafoni.hpp does not include every header; run cmake -P cmake/umbrella.cmake")
    endif()
else()
    file(WRITE "${umbrella}" "${text}")
endif()
