/// \file
/// The exact Voronoi diagram of points in a box.
#ifndef TAFONI_DECOMPOSITION_VORONOI_DIAGRAM_HPP
#define TAFONI_DECOMPOSITION_VORONOI_DIAGRAM_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/decomposition/detail/assemble_diagram.hpp>
#include <tafoni/decomposition/detail/site_tree.hpp>
#include <tafoni/geometry/lattice.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni {

/// What to do with sites at one lattice point.
enum class duplicate_sites { refuse, merge };

struct voronoi_options {
    duplicate_sites duplicates = duplicate_sites::refuse;
};

/// The cells of sites in a box, with exact connectivity.
///
/// The diagram is that of the generic perturbation in `predicates.hpp`: every vertex has exactly
/// four sites or walls, where a symmetric input has more some vertices coincide and some faces
/// have zero area. Cells are numbered in Morton order of their sites: a permutation of the input
/// changes `input_of` and `cell_of_input` and nothing else. All fields are read-only in spirit.
struct voronoi_diagram {
    lattice_frame frame;
    ivec3 box_lo{};  ///< the walls, lattice coordinates
    ivec3 box_hi{};

    std::vector<ivec3> sites;                  ///< cell -> site, lattice coordinates, all different
    std::vector<std::uint32_t> input_of;       ///< cell -> the caller's index (the lowest of merged ones)
    std::vector<std::uint32_t> cell_of_input;  ///< the caller's index -> cell

    std::vector<std::uint32_t> face_begin;    ///< cell -> its first face; one more entry than cells
    std::vector<std::uint32_t> neighbour;     ///< face -> cell beyond it, ascending in a cell; or cells + wall, walls -x +x -y +y -z +z
    std::vector<std::uint32_t> corner_begin;  ///< face -> its first corner; one more entry than faces
    std::vector<std::uint32_t> corners;       ///< vertices, counter-clockwise seen from outside the cell, lowest vertex first

    std::vector<vec3> vertices;                       ///< lattice units; `frame.to_user` gives the user's
    std::vector<std::array<std::uint32_t, 4>> keys;  ///< vertex -> its sites and walls, ascending

    [[nodiscard]] std::size_t cell_count() const noexcept { return sites.size(); }
    [[nodiscard]] std::size_t face_count() const noexcept { return neighbour.size(); }
    [[nodiscard]] bool is_wall(std::uint32_t face) const noexcept { return neighbour[face] >= sites.size(); }
    [[nodiscard]] std::span<std::uint32_t const> corners_of(std::size_t face) const noexcept {
        return std::span(corners).subspan(corner_begin[face], corner_begin[face + 1] - corner_begin[face]);
    }
    /// Input sites that share a cell with one of a lower index.
    [[nodiscard]] std::size_t merged_count() const noexcept { return cell_of_input.size() - input_of.size(); }

    /// Area times outward unit normal of a face, squared lattice units. O(corners).
    [[nodiscard]] vec3 face_area(std::size_t face) const noexcept {
        auto const loop = corners_of(face);
        vec3 const& o = vertices[loop[0]];
        double x = 0;
        double y = 0;
        double z = 0;
        vec3 const& first = vertices[loop[1]];
        double ax = first[0] - o[0];
        double ay = first[1] - o[1];
        double az = first[2] - o[2];
        for (std::size_t k = 2; k < loop.size(); ++k) {
            vec3 const& b = vertices[loop[k]];
            double const bx = b[0] - o[0];
            double const by = b[1] - o[1];
            double const bz = b[2] - o[2];
            x += ay * bz - az * by;
            y += az * bx - ax * bz;
            z += ax * by - ay * bx;
            ax = bx;
            ay = by;
            az = bz;
        }
        return vec3{0.5 * x, 0.5 * y, 0.5 * z};
    }

    /// Volume of a cell, cubed lattice units. O(corners of the cell).
    [[nodiscard]] double cell_volume(std::size_t cell) const noexcept {
        vec3 const at = lattice_frame::to_double(sites[cell]);
        double v = 0;
        for (std::size_t f = face_begin[cell]; f < face_begin[cell + 1]; ++f) {
            vec3 const& o = vertices[corners[corner_begin[f]]];
            v += dot(face_area(f), vec3{o[0] - at[0], o[1] - at[1], o[2] - at[2]});
        }
        return v / 3;
    }
};

namespace detail {

template <class Point, class Inside>
void require_sites(std::span<Point const> sites, Inside const& inside) {
    if (sites.empty()) fail<invalid_input>(errc::no_sites, "make_voronoi_diagram: there are no sites");
    require_indexable("make_voronoi_diagram", sites.size() + 6);
    for (std::size_t k = 0; k < sites.size(); ++k) {
        if (!inside(sites[k])) {
            fail<invalid_input>(errc::site_outside,
                                "make_voronoi_diagram: site " + std::to_string(k) + " lies outside the box",
                                {.kind = entity::site, .index = k});
        }
    }
}

}  // namespace detail

/// The diagram of lattice points in the box [lo, hi] of lattice points.
///
/// Sites on a wall are inside. Independent of the number of threads. Expected O(n log n); a cell
/// with f faces costs O(f^2) in the worst case; where n sites lie on one empty sphere, O(n^2) exact tests (3000: 10 s).
/// Peak memory about 1.15 KB per site, 0.8 KB kept.
/// \throws invalid_input `bad_box`, `no_sites`, `site_outside`, `duplicate_sites` (names the first two), `size_overflow`
///   (beyond 2^32 corners, about 5e7 cells)
/// \throws cancelled  when the observer says so
template <executor Executor = inline_executor>
[[nodiscard]] voronoi_diagram make_voronoi_diagram(lattice_frame const& frame, ivec3 const& lo, ivec3 const& hi,
                                                   std::span<ivec3 const> sites, voronoi_options const& options = {},
                                                   Executor const& pool = {}, run_context const& context = {}) {
    for (std::size_t a = 0; a < 3; ++a) {
        if (lo[a] < 0 || lo[a] >= hi[a] || hi[a] > lattice_frame::limit) {
            detail::fail<invalid_input>(errc::bad_box,
                                        "make_voronoi_diagram: the box must have a positive size in every axis and lie in "
                                        "the lattice, got " + std::to_string(lo[a]) + " to " + std::to_string(hi[a]));
        }
    }
    detail::require_sites(sites, [&](ivec3 const& p) {
        return p[0] >= lo[0] && p[0] <= hi[0] && p[1] >= lo[1] && p[1] <= hi[1] && p[2] >= lo[2] && p[2] <= hi[2];
    });
    context.tick("voronoi cells", 0);

    voronoi_diagram d;
    d.frame = frame;
    d.box_lo = lo;
    d.box_hi = hi;
    auto const order = detail::morton_order(sites);
    d.sites.reserve(sites.size());
    d.input_of.reserve(sites.size());
    d.cell_of_input.resize(sites.size());
    for (auto const k : order) {
        if (!d.sites.empty() && d.sites.back() == sites[k]) {
            if (options.duplicates == duplicate_sites::refuse) {
                detail::fail<invalid_input>(errc::duplicate_sites,
                                            "make_voronoi_diagram: sites " + std::to_string(d.input_of.back()) + " and " +
                                                std::to_string(k) + " are at one place",
                                            {.kind = entity::site, .index = k});
            }
        } else {
            d.sites.push_back(sites[k]);
            d.input_of.push_back(k);
        }
        d.cell_of_input[k] = static_cast<std::uint32_t>(d.sites.size() - 1);
    }
    detail::assemble_diagram(d, pool, context);
    context.tick("voronoi cells", 1);
    return d;
}

/// The diagram of points in a box in the user's frame. O(n log n), see above.
/// \throws invalid_input  as above, and `non_finite_site`
template <executor Executor = inline_executor>
[[nodiscard]] voronoi_diagram make_voronoi_diagram(box3 const& box, std::span<vec3 const> sites,
                                                   voronoi_options const& options = {}, Executor const& pool = {},
                                                   run_context const& context = {}) {
    auto const frame = make_lattice_frame(box);
    for (std::size_t k = 0; k < sites.size(); ++k) {
        if (!is_finite(sites[k])) {
            detail::fail<invalid_input>(errc::non_finite_site,
                                        "make_voronoi_diagram: site " + std::to_string(k) + " is not finite",
                                        {.kind = entity::site, .index = k});
        }
    }
    detail::require_sites(sites, [&box](vec3 const& p) { return box.contains(p); });
    std::vector<ivec3> points(sites.size());
    for (std::size_t k = 0; k < sites.size(); ++k) points[k] = frame.to_lattice(sites[k]);
    return make_voronoi_diagram(frame, {0, 0, 0}, frame.to_lattice(box.hi), std::span<ivec3 const>(points), options,
                                pool, context);
}

}  // namespace tafoni

#endif
