/// \file
/// The result of `voronoi_shards`: one conforming complex that owns everything it needs.
#ifndef TAFONI_DECOMPOSITION_SHARD_COMPLEX_HPP
#define TAFONI_DECOMPOSITION_SHARD_COMPLEX_HPP

#include <tafoni/decomposition/concepts.hpp>

#include <cstdint>
#include <vector>

namespace tafoni {

/// Shards of a solid. Models `cell_complex`.
///
/// A shard is a connected piece of a site's cell; ids follow a space-filling order of the sites.
/// Arrays are parallel: everything "per face" has face_count() entries, and so on.
struct shard_complex {
    static constexpr std::uint32_t none = face_index::none;

    /// One face: a flat polygon with holes between two shards, or a fragment of an input triangle.
    struct face_record {
        cell_index front{};  ///< the normal points out of this shard
        cell_index back{};   ///< not valid on the skin
    };

    std::vector<vec3> vertices{};
    std::vector<vertex_index> corners{};        ///< loops, concatenated
    std::vector<std::size_t> loop_begin{0};     ///< loop -> first corner; one past the last at the end
    std::vector<std::uint32_t> face_begin{0};   ///< face -> first loop; one past the last at the end
    std::vector<face_record> faces{};           ///< interior faces first, then skin
    std::size_t interior_face_count = 0;
    std::vector<std::uint32_t> skin_sources{};  ///< per skin face: triangle of the solid that it is cut from
    std::vector<patch_index> skin_patches{};    ///< per skin face: smooth patch; not valid on artificial skin

    std::vector<std::uint32_t> cell_faces{};    ///< faces of the cells, concatenated
    std::vector<std::size_t> cell_begin{0};     ///< cell -> first entry of cell_faces
    std::vector<double> volumes{};              ///< per cell, cubed length unit, > 0
    std::vector<vec3> centroids{};              ///< per cell, of its volume
    std::vector<site_index> site_of{};          ///< per cell -> the caller's site; after a merge that of the part that took the others in
    std::vector<vec3> sites{};                  ///< the caller's sites, in the caller's order
    std::vector<cell_index> shards_of_site{};   ///< those that hold parts of the site's cell, ascending, concatenated
    std::vector<std::size_t> site_begin{0};     ///< site -> first entry of shards_of_site

    std::vector<std::uint32_t> polygon_of{};    ///< triangle of the solid -> face of the input mesh
    std::size_t patch_count = 0;
    double size = 0;                            ///< diagonal of the solid's box

    std::size_t merged_sites = 0;               ///< duplicates merged on request
    std::size_t dropped_sites = 0;              ///< sites outside the solid's box, left out on request
    std::size_t merged_slivers = 0;             ///< shards below the volume limit, given to a neighbour

    [[nodiscard]] std::size_t cell_count() const noexcept { return volumes.size(); }
    [[nodiscard]] double cell_volume(cell_index c) const noexcept { return volumes[c.value]; }
    [[nodiscard]] vec3 cell_centroid(cell_index c) const noexcept { return centroids[c.value]; }
    [[nodiscard]] std::size_t vertex_count() const noexcept { return vertices.size(); }
    [[nodiscard]] vec3 position(vertex_index v) const noexcept { return vertices[v.value]; }
    [[nodiscard]] std::size_t face_count() const noexcept { return faces.size(); }
    [[nodiscard]] std::array<cell_index, 2> face_cells(face_index f) const noexcept {
        return {faces[f.value].front, faces[f.value].back};
    }
    [[nodiscard]] std::size_t loop_count(face_index f) const noexcept {
        return face_begin[f.value + 1] - face_begin[f.value];
    }
    [[nodiscard]] std::span<vertex_index const> face_loop(face_index f, std::size_t loop) const noexcept {
        std::size_t const l = face_begin[f.value] + loop;
        return {corners.data() + loop_begin[l], loop_begin[l + 1] - loop_begin[l]};
    }
    [[nodiscard]] patch_index face_patch(face_index f) const noexcept {
        return f.value < interior_face_count ? patch_index{} : skin_patches[f.value - interior_face_count];
    }
    /// The triangle of the solid that a skin face is cut from; `none` inside.
    [[nodiscard]] std::uint32_t face_source(face_index f) const noexcept {
        return f.value < interior_face_count ? none : skin_sources[f.value - interior_face_count];
    }
    [[nodiscard]] double model_size() const noexcept { return size; }

    [[nodiscard]] std::span<std::uint32_t const> faces_of(cell_index c) const noexcept {
        return {cell_faces.data() + cell_begin[c.value], cell_begin[c.value + 1] - cell_begin[c.value]};
    }
    [[nodiscard]] std::span<cell_index const> shards_of(site_index s) const noexcept {
        return {shards_of_site.data() + site_begin[s.value], site_begin[s.value + 1] - site_begin[s.value]};
    }
};

static_assert(cell_complex<shard_complex>);

}  // namespace tafoni

#endif
