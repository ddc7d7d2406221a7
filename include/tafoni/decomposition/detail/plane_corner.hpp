/// \file
/// The point in which three planes of a Voronoi cell meet.
#ifndef TAFONI_DECOMPOSITION_DETAIL_PLANE_CORNER_HPP
#define TAFONI_DECOMPOSITION_DETAIL_PLANE_CORNER_HPP

#include <tafoni/geometry/predicates.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace tafoni::detail {

/// The box in which cells live, lattice coordinates.
struct lattice_box {
    ivec3 lo{};
    ivec3 hi{};
};

/// A point and a bound on its distance from the true one, relative to a site.
struct vertex_estimate {
    double x = 0;
    double y = 0;
    double z = 0;
    double error = 0;
};

/// n . y = h for a plane of the cell of `base`, in doubles.
struct double_plane {
    double x = 0;
    double y = 0;
    double z = 0;
    double h = 0;
    double nn = 0;  ///< |n|^2
};

[[nodiscard]] inline double_plane to_double_plane(ivec3 const& base, exact::plane const& p) noexcept {
    if (p.axis >= 0) {
        auto const a = static_cast<std::size_t>(p.axis);
        double const e = p.upper ? 1 : -1;
        std::array<double, 3> n{0, 0, 0};
        n[a] = e;
        return {n[0], n[1], n[2], e * static_cast<double>(p.at[a] - base[a]), 1};
    }
    auto const x = static_cast<double>(p.at[0] - base[0]);
    auto const y = static_cast<double>(p.at[1] - base[1]);
    auto const z = static_cast<double>(p.at[2] - base[2]);
    double const nn = x * x + y * y + z * z;
    return {x, y, z, 0.5 * nn, nn};
}

/// Where three planes meet, from integers: right to four roundings however flat the corner is. About 300 ns.
[[nodiscard]] inline vertex_estimate solve_exactly(ivec3 const& base, exact::plane const& a, exact::plane const& b,
                                                   exact::plane const& c) noexcept {
    using namespace exact::detail;
    auto const ra = plane_row<limb>(base, a);
    auto const rb = plane_row<limb>(base, b);
    auto const rc = plane_row<limb>(base, c);
    auto const bc = cross(rb.n, rc.n);
    auto const ca = cross(rc.n, ra.n);
    auto const ab = cross(ra.n, rb.n);
    double const det = 2 * to_double(dot(ra.n, bc));
    auto const at = [&](std::size_t k) { return to_double(ra.h * bc[k] + rb.h * ca[k] + rc.h * ab[k]) / det; };
    vertex_estimate v{at(0), at(1), at(2), 0};
    v.error = 0x1p-49 * (std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
    return v;
}

/// Where three planes of the cell of `base` meet, by Cramer's rule; exactly where that is too flat.
[[nodiscard]] inline vertex_estimate solve(ivec3 const& base, exact::plane const& pa, exact::plane const& pb,
                                           exact::plane const& pc, double_plane const& a, double_plane const& b,
                                           double_plane const& c) noexcept {
    double const bcx = b.y * c.z - b.z * c.y;
    double const bcy = b.z * c.x - b.x * c.z;
    double const bcz = b.x * c.y - b.y * c.x;
    double const cax = c.y * a.z - c.z * a.y;
    double const cay = c.z * a.x - c.x * a.z;
    double const caz = c.x * a.y - c.y * a.x;
    double const abx = a.y * b.z - a.z * b.y;
    double const aby = a.z * b.x - a.x * b.z;
    double const abz = a.x * b.y - a.y * b.x;
    double const det = a.x * bcx + a.y * bcy + a.z * bcz;
    double const size = std::sqrt(a.nn * b.nn * c.nn);
    if (!(std::fabs(det) > 1e-3 * size)) return solve_exactly(base, pa, pb, pc);
    vertex_estimate v;
    double const f = 1 / det;
    v.x = (a.h * bcx + b.h * cax + c.h * abx) * f;
    v.y = (a.h * bcy + b.h * cay + c.h * aby) * f;
    v.z = (a.h * bcz + b.h * caz + c.h * abz) * f;
    // Each term of the numerators is at most |a||b||c||v|: about 50 roundings of that, over det.
    v.error = 0x1p-47 * (std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z)) * size * std::fabs(f);
    return v;
}

[[nodiscard]] inline vertex_estimate solve(ivec3 const& base, exact::plane const& a, exact::plane const& b,
                                           exact::plane const& c) noexcept {
    return solve(base, a, b, c, to_double_plane(base, a), to_double_plane(base, b), to_double_plane(base, c));
}

}  // namespace tafoni::detail

#endif
