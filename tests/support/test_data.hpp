/// \file
/// Where tests find real data, which is never part of the repository.
#ifndef TAFONI_TESTS_SUPPORT_TEST_DATA_HPP
#define TAFONI_TESTS_SUPPORT_TEST_DATA_HPP

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace tafoni_test {

/// The file `relative` in the folder named by the environment's TAFONI_DATA_DIR, else in the folder
/// that CMake found; an empty path when it is in neither. A test that gets one warns and skips:
/// `auto const path = find("meshes/spot_11k.ply"); if (path.empty()) { WARN("skipped: no data"); return; }`
[[nodiscard]] inline std::filesystem::path find(std::string_view relative) {
    std::error_code ignored;
    if (char const* const folder = std::getenv("TAFONI_DATA_DIR"); folder != nullptr && *folder != '\0') {
        std::filesystem::path const path = std::filesystem::path(folder) / relative;
        if (std::filesystem::exists(path, ignored)) return path;
    }
#ifdef TAFONI_DATA_DIR
    std::filesystem::path const path = std::filesystem::path(TAFONI_DATA_DIR) / relative;
    if (std::filesystem::exists(path, ignored)) return path;
#endif
    return {};
}

}  // namespace tafoni_test

#endif
