/// \file
/// On which side of a bisector a point of the surface lies: the exact signs with the diagram's sites filled in.
#ifndef TAFONI_DECOMPOSITION_DETAIL_SURFACE_SIGNS_HPP
#define TAFONI_DECOMPOSITION_DETAIL_SURFACE_SIGNS_HPP

#include <tafoni/decomposition/voronoi_diagram.hpp>
#include <tafoni/geometry/predicates.hpp>
#include <tafoni/geometry/solid.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// b - a as doubles; exact where the lattice difference has at most 53 bits, else rounded once.
[[nodiscard]] inline vec3 difference(ivec3 const& b, ivec3 const& a) noexcept {
    return vec3{static_cast<double>(b[0] - a[0]), static_cast<double>(b[1] - a[1]), static_cast<double>(b[2] - a[2])};
}

/// Questions about points on the surface of a solid. Each is about cell i, the points being
/// relative to it, and `beyond` means on the other side of a bisector from i. Never undecided.
struct surface_signs {
    voronoi_diagram const& diagram;
    std::vector<ivec3> const& points;  ///< vertices of the solid on the lattice

    [[nodiscard]] exact::site site(std::uint32_t i) const noexcept { return {diagram.sites[i], i}; }

    /// Is q on k's side of the bisector of i and k?
    [[nodiscard]] bool vertex_beyond(std::uint32_t i, std::uint32_t k, ivec3 const& q) const noexcept {
        return exact::side1(site(i), site(k), q) > 0;
    }

    /// Is the point where edge a b meets the bisector (i, k) on j's side of (i, j)?
    [[nodiscard]] bool edge_point_beyond(std::uint32_t i, std::uint32_t k, std::uint32_t j, ivec3 const& a,
                                         ivec3 const& b) const noexcept {
        return exact::side2(site(i), site(k), site(j), a, b) > 0;
    }

    /// Is the point where triangle q meets the bisectors (i, k) and (i, l) on j's side of (i, j)?
    [[nodiscard]] bool triangle_point_beyond(std::uint32_t i, std::uint32_t k, std::uint32_t l, std::uint32_t j,
                                             std::array<ivec3, 3> const& q) const noexcept {
        return exact::side3(site(i), site(k), site(l), site(j), q[0], q[1], q[2]) > 0;
    }
};

}  // namespace tafoni::detail

#endif
