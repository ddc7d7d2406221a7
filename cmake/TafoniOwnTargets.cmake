# Flags of our own tests, benchmarks and examples; nothing here reaches a host.

option(TAFONI_WERROR "Treat warnings in our own targets as errors" ON)

add_library(tafoni_own INTERFACE)
target_link_libraries(tafoni_own INTERFACE tafoni::tafoni tafoni::reproducible)
target_compile_options(tafoni_own INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow
    $<$<BOOL:${TAFONI_WERROR}>:-Werror>)
# g++ 12 warns falsely about std::string at -O2 (its bugs 105329 and 105651); the consumer's build stays strict.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
    target_compile_options(tafoni_own INTERFACE
        -Wno-error=array-bounds -Wno-error=restrict -Wno-error=stringop-overflow -Wno-error=stringop-overread)
endif()
find_package(Threads REQUIRED)
target_link_libraries(tafoni_own INTERFACE Threads::Threads)

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    find_program(TAFONI_CCACHE ccache)
    if(TAFONI_CCACHE)
        # Precompiled headers are cached only with this sloppiness.
        set(CMAKE_CXX_COMPILER_LAUNCHER
            "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
            "${TAFONI_CCACHE}")
    endif()
endif()
