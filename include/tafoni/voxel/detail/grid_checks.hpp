/// \file
/// What every grid with memory of its own refuses.
#ifndef TAFONI_VOXEL_DETAIL_GRID_CHECKS_HPP
#define TAFONI_VOXEL_DETAIL_GRID_CHECKS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tafoni::detail {

[[nodiscard]] inline std::string voxel_text(std::size_t i, std::size_t j, std::size_t k) {
    return std::string("(") + std::to_string(i) + ", " + std::to_string(j) + ", " + std::to_string(k) + ")";
}
[[nodiscard]] inline std::string size_text(std::array<std::size_t, 3> const& n) {
    return std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]);
}
/// Place of a voxel in memory, x fastest.
[[nodiscard]] inline std::size_t linear_index(std::array<std::size_t, 3> const& n, voxel v) noexcept {
    return static_cast<std::size_t>(v.x) +
           n[0] * (static_cast<std::size_t>(v.y) + n[1] * static_cast<std::size_t>(v.z));
}

/// A valid frame of at most `most` voxels. The product cannot overflow: no side is longer than 2^20.
inline void require_stored_frame(char const* who, grid_frame const& frame, std::size_t most) {
    frame.validate();
    if (frame.voxel_count() > most) {
        fail<invalid_input>(errc::size_overflow,
                            std::string(who) + ": got " + size_text(frame.size) + " = " +
                                std::to_string(frame.voxel_count()) + " voxels, at most " + std::to_string(most),
                            {.kind = entity::voxel, .value = static_cast<double>(frame.voxel_count()),
                             .limit = static_cast<double>(most)});
    }
}

inline void require_voxel(char const* who, grid_frame const& frame, voxel v) {
    if (frame.contains(v)) return;
    fail<invalid_input>(errc::index_out_of_range,
                        std::string(who) + ": voxel (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " +
                            std::to_string(v.z) + ") of a grid of " + size_text(frame.size),
                        {.kind = entity::voxel});
}

/// One byte per voxel, none of them anything but a state. O(voxels).
inline void require_states(char const* who, grid_frame const& frame, std::span<std::uint8_t const> states) {
    std::size_t const n = frame.voxel_count();
    if (states.size() != n) {
        fail<invalid_input>(errc::attribute_length,
                            std::string(who) + ": got " + std::to_string(states.size()) + " states, the grid has " +
                                std::to_string(n) + " voxels",
                            {.kind = entity::voxel, .value = static_cast<double>(states.size()),
                             .limit = static_cast<double>(n)});
    }
    auto const wrong = std::find_if(states.begin(), states.end(), [](std::uint8_t s) { return s > 2; });
    if (wrong == states.end()) return;
    auto const at = static_cast<std::size_t>(wrong - states.begin());
    std::size_t const row = at / frame.size[0];
    fail<invalid_input>(errc::out_of_range,
                        std::string(who) + ": state of voxel " +
                            voxel_text(at % frame.size[0], row % frame.size[1], row / frame.size[1]) + ": got " +
                            std::to_string(*wrong) + ", at most 2",
                        {.kind = entity::voxel, .index = at, .value = static_cast<double>(*wrong), .limit = 2});
}

/// Bytes that a grid offers for its states. O(1). \throws invalid_input  `attribute_length`
inline void require_bytes(std::array<std::size_t, 3> const& n, std::span<std::uint8_t const> bytes) {
    std::size_t const voxels = n[0] * n[1] * n[2];
    if (bytes.size() == voxels) return;
    fail<invalid_input>(errc::attribute_length,
                        "grid_access::bytes: got " + std::to_string(bytes.size()) + " bytes for " + size_text(n) + " voxels",
                        {.kind = entity::voxel, .value = static_cast<double>(bytes.size()),
                         .limit = static_cast<double>(voxels)});
}

/// For a state that a grid answered. \throws invalid_input  `out_of_range`
inline void require_state(std::uint8_t state, std::size_t i, std::size_t j, std::size_t k) {
    if (state <= 2) return;
    fail<invalid_input>(errc::out_of_range,
                        "grid_access: state of voxel " + voxel_text(i, j, k) + ": got " + std::to_string(state) + ", at most 2",
                        {.kind = entity::voxel, .value = static_cast<double>(state), .limit = 2});
}

/// \throws invalid_input  `attribute_length`
inline void require_same_size(char const* who, std::array<std::size_t, 3> const& from,
                              std::array<std::size_t, 3> const& to) {
    if (from == to) return;
    fail<invalid_input>(errc::attribute_length,
                        std::string(who) + ": got a grid of " + size_text(from) + " voxels for one of " + size_text(to),
                        {.kind = entity::voxel, .value = static_cast<double>(from[0]) * static_cast<double>(from[1]) *
                                                         static_cast<double>(from[2]),
                         .limit = static_cast<double>(to[0]) * static_cast<double>(to[1]) *
                                  static_cast<double>(to[2])});
}

}  // namespace tafoni::detail

#endif
