/// \file
/// Cuts a solid into the parts of it that lie nearest to given sites.
#ifndef TAFONI_DECOMPOSITION_VORONOI_SHARDS_HPP
#define TAFONI_DECOMPOSITION_VORONOI_SHARDS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/decomposition/detail/complex_assembly.hpp>
#include <tafoni/decomposition/detail/sliver_merge.hpp>
#include <tafoni/decomposition/shard_complex.hpp>
#include <tafoni/decomposition/voronoi_diagram.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni {

/// What to do with sites outside the box of the solid. Sites in the box but outside the solid are
/// always taken: their cells may still reach into it.
enum class outside_sites { refuse, drop };

struct voronoi_shards_options {
    duplicate_sites duplicates = duplicate_sites::refuse;  ///< sites at one place
    outside_sites outside = outside_sites::refuse;
    double patch_angle = 15;    ///< degrees in [0, 180]: skin stays one patch where its normal turns by no more; 0: a patch per polygon
    double min_volume = 1e-12;  ///< of the solid's volume, in [0, 1]: smaller shards are given to a neighbour
};

namespace detail {

/// The solid and its sites on the lattice, with room for the walls around them.
struct shard_lattice {
    static constexpr std::int64_t margin = std::int64_t{1} << 53;  // of at most 2^56 for the solid

    lattice_frame frame{};
    ivec3 hi{};                          ///< far corner of the walls; the near one is 0
    std::vector<ivec3> points{};         ///< vertices of the solid
    std::vector<ivec3> sites{};          ///< those that are kept
    std::vector<std::uint32_t> given{};  ///< kept site -> the caller's

    [[nodiscard]] static ivec3 shifted(ivec3 p) noexcept {
        for (auto& x : p) x += margin;
        return p;
    }
};

[[nodiscard]] inline shard_lattice map_to_lattice(solid const& body, std::span<vec3 const> sites,
                                                  voronoi_shards_options const& options) {
    char const* const who = "voronoi_shards";
    if (sites.empty()) fail<invalid_input>(errc::no_sites, std::string(who) + ": there are no sites");
    require_indexable(who, sites.size() + 6);
    if (body.triangles.empty()) fail<invalid_input>(errc::empty_input, std::string(who) + ": the solid has no triangles");
    shard_lattice l;
    l.frame = make_lattice_frame(body.bounds);
    l.frame.exponent -= 1;
    std::vector<std::uint8_t> used(body.positions.size(), 0);
    for (auto const& t : body.triangles) {
        for (std::uint32_t v : t) used[v] = 1;
    }
    l.points.resize(body.positions.size());
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (used[v] != 0) l.points[v] = shard_lattice::shifted(l.frame.to_lattice(body.positions[v]));
    }
    for (std::uint32_t s = 0; s < sites.size(); ++s) {
        if (!is_finite(sites[s])) {
            fail<invalid_input>(errc::non_finite_site, std::string(who) + ": site " + std::to_string(s) + " is not finite",
                                {.kind = entity::site, .index = s});
        }
        if (body.bounds.contains(sites[s])) {
            l.sites.push_back(shard_lattice::shifted(l.frame.to_lattice(sites[s])));
            l.given.push_back(s);
        } else if (options.outside == outside_sites::refuse) {
            fail<invalid_input>(errc::site_outside,
                                std::string(who) + ": site " + std::to_string(s) + " lies outside the box of the solid",
                                {.kind = entity::site, .index = s});
        }
    }
    if (l.sites.empty()) {
        fail<invalid_input>(errc::no_sites, std::string(who) + ": all sites lie outside the box of the solid");
    }
    l.hi = shard_lattice::shifted(shard_lattice::shifted(l.frame.to_lattice(body.bounds.hi)));
    return l;
}

struct voronoi_shards_fn {
    /// The shards of `body`: for every site the connected pieces of the solid that no other site is nearer to.
    ///
    /// The solid need not be convex. Ties go by coordinates, so the order of the sites changes ids only.
    /// Exact but for the rounding of positions: where a solid's surface does not cut itself, every shard is
    /// closed and conforming and the volumes add up; where it does, they are those of the oriented chain.
    /// Triangles are clipped only against the cells that they cross [Yan et al. 2009, Efficient computation of
    /// clipped Voronoi diagram], faces between cells are cut by the resulting loops, the rest follows by a flood
    /// fill of winding numbers. The result is the same for every thread count.
    ///
    /// Expected O(n log n + t log n + k log k) for n sites, t triangles and k pieces of triangles.
    /// \throws invalid_input  no_sites, non_finite_site, site_outside, duplicate_sites (both unless asked otherwise),
    ///   bad_parameter, size_overflow
    /// \throws cancelled  when the observer says so
    template <executor Executor = inline_executor>
    [[nodiscard]] shard_complex operator()(solid const& body, std::span<vec3 const> sites,
                                           voronoi_shards_options const& options = {}, Executor const& threads = {},
                                           run_context const& context = {}) const {
        require_range("voronoi_shards_options.patch_angle", options.patch_angle, 0, 180);
        require_range("voronoi_shards_options.min_volume", options.min_volume, 0, 1);
        shard_lattice lattice = map_to_lattice(body, sites, options);
        voronoi_diagram diagram = make_voronoi_diagram(lattice.frame, {0, 0, 0}, lattice.hi,
                                                       std::span<ivec3 const>(lattice.sites),
                                                       {.duplicates = options.duplicates}, threads, context);
        context.tick("clip surface", 0);
        surface_signs const signs{diagram, lattice.points};
        surface_walk const walk = walk_surface(signs, body, threads);
        context.tick("clip surface", 0.3);
        require_indexable("voronoi_shards", 4 * diagram.vertices.size() + lattice.points.size() + walk.points.size());
        vertex_numbers numbers;
        numbers.solid = static_cast<std::uint32_t>(diagram.vertices.size());
        numbers.edge = numbers.solid + static_cast<std::uint32_t>(lattice.points.size());
        numbers.triangle = numbers.edge + static_cast<std::uint32_t>(walk.points.size());
        surface_pieces const pieces = clip_surface(signs, body, walk, numbers, threads);
        context.tick("clip surface", 1);

        context.tick("assemble shards", 0);
        diagram_winding const winding = wind_diagram(diagram, pieces, numbers, threads);
        vertex_places const places{diagram, lattice.points, walk, pieces, numbers};
        polygon_set interior = assemble_faces(diagram, winding, places, threads);
        context.tick("assemble shards", 0.4);
        shard_split split = split_cells(interior, places, threads);
        context.tick("assemble shards", 0.7);

        shard_complex out;
        out.sites.assign(sites.begin(), sites.end());
        out.merged_sites = diagram.merged_count();
        out.dropped_sites = sites.size() - lattice.given.size();
        assemble_complex(interior, split, places, body, smooth_patches(body, options.patch_angle, threads),
                         static_cast<double>(shard_lattice::margin), threads, out);
        for (site_index& s : out.site_of) s = site_index{lattice.given[s.value]};
        std::vector<std::uint32_t> same_as;
        if (out.merged_sites != 0) {
            same_as.resize(sites.size());
            for (std::uint32_t s = 0; s < same_as.size(); ++s) same_as[s] = s;
            for (std::size_t k = 0; k < lattice.given.size(); ++k) {
                same_as[lattice.given[k]] = lattice.given[diagram.input_of[diagram.cell_of_input[k]]];
            }
        }
        index_sites(out, same_as);
        auto const moved = merge_slivers(out, options.min_volume * body.volume);
        if (out.merged_slivers != 0) index_sites(out, same_as, moved);
        context.tick("assemble shards", 1);
        return out;
    }
};

}  // namespace detail

/// Cuts a solid into shards; see `detail::voronoi_shards_fn`.
inline constexpr detail::voronoi_shards_fn voronoi_shards{};

}  // namespace tafoni

#endif
