/// \file
/// Lines through points: links and paths, as files show them.
#ifndef TAFONI_IO_POLYLINE_SET_HPP
#define TAFONI_IO_POLYLINE_SET_HPP

#include <tafoni/core/vector.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

namespace tafoni {

/// Line i runs through the points `corners[offsets[i] .. offsets[i + 1])`.
struct polyline_set {
    std::vector<vec3> positions{};
    std::vector<std::uint32_t> corners{};
    std::vector<std::size_t> offsets{0};

    [[nodiscard]] std::size_t line_count() const noexcept { return offsets.empty() ? 0 : offsets.size() - 1; }
    void add_line(std::span<std::uint32_t const> line) {
        if (offsets.empty()) offsets.push_back(0);
        corners.insert(corners.end(), line.begin(), line.end());
        offsets.push_back(corners.size());
    }
    void add_line(std::initializer_list<std::uint32_t> line) { add_line(std::span{line.begin(), line.size()}); }
};

}  // namespace tafoni

#endif
