/// \file
/// Which mesh a run began with.
#ifndef TAFONI_WEATHERING_DETAIL_SURFACE_HASH_HPP
#define TAFONI_WEATHERING_DETAIL_SURFACE_HASH_HPP

#include <tafoni/core/detail/bytes.hpp>
#include <tafoni/geometry/triangle_surface.hpp>

#include <cstdint>

namespace tafoni::detail {

/// The mesh that a run began with. O(vertices + faces).
[[nodiscard]] inline std::uint64_t surface_hash(triangle_surface const& s) {
    number_hash h;
    h.add(static_cast<std::uint64_t>(s.positions.size()));
    for (vec3 const& p : s.positions) {
        for (int d = 0; d < 3; ++d) h.add(p[d]);
    }
    for (auto const& t : s.triangles) {
        for (std::uint32_t const c : t) h.add(std::uint64_t{c});
    }
    return h.value();
}

}  // namespace tafoni::detail

#endif
