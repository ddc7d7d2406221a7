# What the headers need, as SYSTEM includes, so that a host's warnings stay its own.
# One small target per library instead of the imported ones: Debian's Boost and Eigen packages are
# usable without their CMake files, and the installed package can find them the same way.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(range-v3 REQUIRED)  # its version file only accepts an exact match
if(range-v3_VERSION VERSION_LESS 0.12)
    message(FATAL_ERROR "tafoni needs range-v3 0.12, found ${range-v3_VERSION}")
endif()
find_package(Boost 1.74 REQUIRED)

function(tafoni_system_dependency name)
    if(TARGET ${name})
        return()
    endif()
    add_library(${name} INTERFACE IMPORTED GLOBAL)
    foreach(target IN LISTS ARGN)
        get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
        if(folders)
            target_include_directories(${name} SYSTEM INTERFACE ${folders})
        endif()
    endforeach()
endfunction()

tafoni_system_dependency(tafoni_eigen Eigen3::Eigen)
tafoni_system_dependency(tafoni_range_v3 range-v3::concepts range-v3::meta range-v3::range-v3)
tafoni_system_dependency(tafoni_boost Boost::headers)
