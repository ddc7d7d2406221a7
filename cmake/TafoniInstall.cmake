include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_DATADIR}/cmake/tafoni")
set(file_sets FILE_SET HEADERS FILE_SET details)
if(interop_headers)
    list(APPEND file_sets FILE_SET interop)
endif()
install(TARGETS tafoni tafoni_reproducible EXPORT tafoni_targets ${file_sets})
install(EXPORT tafoni_targets NAMESPACE tafoni:: FILE tafoni-targets.cmake DESTINATION "${package_dir}")

write_basic_package_version_file("${PROJECT_BINARY_DIR}/tafoni-config-version.cmake"
    COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES
    "${PROJECT_SOURCE_DIR}/cmake/tafoni-config.cmake"
    "${PROJECT_SOURCE_DIR}/cmake/TafoniDependencies.cmake"
    "${PROJECT_BINARY_DIR}/tafoni-config-version.cmake"
    DESTINATION "${package_dir}")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/tafoni/" DESTINATION "${CMAKE_INSTALL_DOCDIR}"
    FILES_MATCHING PATTERN "*.md" PATTERN "detail" EXCLUDE PATTERN "interop" EXCLUDE)
