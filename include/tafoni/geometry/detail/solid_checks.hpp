/// \file
/// The steps of `make_solid`: extents, pairing of sides, triangles, volumes of components.
#ifndef TAFONI_GEOMETRY_DETAIL_SOLID_CHECKS_HPP
#define TAFONI_GEOMETRY_DETAIL_SOLID_CHECKS_HPP

#include <tafoni/core/sum.hpp>
#include <tafoni/geometry/detail/edge_faults.hpp>
#include <tafoni/geometry/detail/shell_nesting.hpp>
#include <tafoni/geometry/solid.hpp>
#include <tafoni/geometry/triangulate.hpp>

#include <string>
#include <utility>

namespace tafoni::detail {

/// The box of the vertices that faces use. O(corners).
[[nodiscard]] inline box3 used_bounds(indexed_mesh const& mesh) {
    box3 box;
    for (std::uint32_t const v : mesh.corners) box.include(mesh.positions[v]);
    return box;
}

/// Throws `out_of_range` where the volume could overflow or vanish, `zero_volume` where all points coincide.
inline void require_safe_extent(char const* who, box3 const& box) {
    vec3 const extent = box.extent();
    double const size = std::max(extent[0], std::max(extent[1], extent[2]));
    if (size == 0) {
        fail<bad_topology>(errc::zero_volume, std::string(who) + ": all corners lie in one point", {.value = 0});
    }
    double const cube = size * size * size;
    if (!std::isnormal(cube)) {
        fail<invalid_input>(errc::out_of_range,
                            std::string(who) + ": the mesh is " + (size > 1 ? "too large" : "too small") +
                                ", the cube of its extent is not a normal number",
                            {.kind = entity::none, .value = size, .limit = size > 1 ? 5.6e102 : 2.9e-103});
    }
}

/// Fills triangles, polygon_of and opposite. Diagonals are paired inside their polygon, never by vertex
/// pairs, so a diagonal that joins the ends of another edge is harmless. O(corners log (corners per face)).
inline void cut_polygons(char const* who, indexed_mesh const& mesh, std::vector<std::uint32_t> const& across,
                         solid& s) {
    std::size_t const count = mesh.corners.size() - 2 * mesh.face_count();
    require_indexable(who, 3 * count);
    s.triangles.reserve(count);
    s.polygon_of.reserve(count);
    s.opposite.assign(3 * count, 0);
    std::vector<std::uint32_t> half_edge_of(mesh.corners.size());
    std::vector<std::array<std::uint32_t, 3>> cut;
    std::vector<vec3> places;
    std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> diagonals;
    ear_clipper clip;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        auto const loop = mesh.face(f);
        std::uint32_t const n = static_cast<std::uint32_t>(loop.size());
        cut.clear();
        places.clear();
        diagonals.clear();
        for (std::uint32_t const v : loop) places.push_back(mesh.positions[v]);
        clip(places, cut);
        for (auto const& t : cut) {
            std::uint32_t const first = static_cast<std::uint32_t>(3 * s.triangles.size());
            for (std::uint32_t k = 0; k < 3; ++k) {
                std::uint32_t const a = t[k];
                std::uint32_t const b = t[(k + 1) % 3];
                if (b == (a + 1 == n ? 0 : a + 1)) half_edge_of[mesh.offsets[f] + a] = first + k;
                else diagonals.push_back({{std::min(a, b), std::max(a, b)}, first + k});
            }
            s.triangles.push_back({loop[t[0]], loop[t[1]], loop[t[2]]});
            s.polygon_of.push_back(static_cast<std::uint32_t>(f));
        }
        std::sort(diagonals.begin(), diagonals.end());
        for (std::size_t i = 0; i + 1 < diagonals.size(); i += 2) {
            s.opposite[diagonals[i].second] = diagonals[i + 1].second;
            s.opposite[diagonals[i + 1].second] = diagonals[i].second;
        }
    }
    for (std::size_t c = 0; c < across.size(); ++c) s.opposite[half_edge_of[c]] = half_edge_of[across[c]];
}

/// Volume and area, summed in a frame of about unit size at the low corner of the box so that neither
/// overflows; throws `inverted_orientation` and `zero_volume`. O(triangles), plus O(triangles) per cavity.
inline void measure(char const* who, solid& s) {
    vec3 const extent = s.bounds.extent();
    double const size = std::max(extent[0], std::max(extent[1], extent[2]));
    int const exponent = std::ilogb(size);
    vec3 const origin = s.bounds.lo;
    auto const local = [&](std::uint32_t v) {
        vec3 const& p = s.positions[v];
        return vec3{std::ldexp(p[0] - origin[0], -exponent), std::ldexp(p[1] - origin[1], -exponent),
                    std::ldexp(p[2] - origin[2], -exponent)};
    };
    std::size_t const n = s.triangles.size();
    std::vector<volume_term> terms(n);
    for (std::size_t t = 0; t < n; ++t) {
        auto const& tri = s.triangles[t];
        terms[t] = make_volume_term(local(tri[0]), local(tri[1]), local(tri[2]));
    }
    double const six_volume = pairwise_sum(0, n, [&](std::size_t t) { return terms[t].six_volume; });
    double const size_of_terms = pairwise_sum(0, n, [&](std::size_t t) { return terms[t].size; });
    require_outward_shells(who, s, terms);
    if (!(std::fabs(six_volume) > volume_noise * size_of_terms)) {
        fail<bad_topology>(errc::zero_volume,
                           std::string(who) + ": the surface of " + std::to_string(n) + " triangles encloses no volume",
                           {.value = std::ldexp(six_volume / 6, 3 * exponent), .limit = 0});
    }
    // Shells may each look outwards and still, where they cut themselves, turn more inside out than not.
    if (six_volume < 0) {
        fail<bad_topology>(errc::inverted_orientation,
                           std::string(who) + ": the surface encloses a negative volume; its faces point inwards",
                           {.value = std::ldexp(six_volume / 6, 3 * exponent), .limit = 0});
    }
    s.volume = std::ldexp(six_volume / 6, 3 * exponent);
    s.area = std::ldexp(pairwise_sum(0, n, [&](std::size_t t) { return terms[t].double_area; }) / 2, 2 * exponent);
}

}  // namespace tafoni::detail

#endif
