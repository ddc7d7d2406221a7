/// \file
/// What a decomposition of a solid into cells looks like to the parts that work on it.
#ifndef TAFONI_DECOMPOSITION_CONCEPTS_HPP
#define TAFONI_DECOMPOSITION_CONCEPTS_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <span>

namespace tafoni {

/// The corners of a face's loop, in order: a span where they are stored, a small value where they are computed.
template <class L>
concept vertex_loop = requires(L const& loop, std::size_t k) {
    { loop.size() } -> std::same_as<std::size_t>;
    { static_cast<vertex_index>(loop[k]) };
    loop.begin();
    loop.end();
};

/// A conforming complex of cells, faces and shared vertices: shards, voxels, bricks, your own.
///
/// Laws: every face lies between `front` and `back` = `face_cells(f)`; on the skin `back` is not
/// valid. Loops run counter-clockwise seen from outside `front`, so the normal leads from front to
/// back; loop 0 is the outline, the rest are holes (clockwise). Vertices are shared: two faces that
/// touch along an edge name the same two vertices, and around one cell every directed edge has its
/// opposite. `face_patch(f)` names the smooth piece of the input surface that a skin face lies on;
/// it is not valid inside and on artificial skin (sides and base of a terrain), where no water enters.
/// `model_size()` > 0 is the length that tolerances are relative to.
template <class C>
concept cell_complex = requires(C const& c, cell_index cell, face_index face, vertex_index vertex, std::size_t loop) {
    { c.cell_count() } -> std::same_as<std::size_t>;
    { c.cell_volume(cell) } -> std::same_as<double>;
    { c.cell_centroid(cell) } -> std::same_as<vec3>;
    { c.vertex_count() } -> std::same_as<std::size_t>;
    { c.position(vertex) } -> std::same_as<vec3>;
    { c.face_count() } -> std::same_as<std::size_t>;
    { c.face_cells(face) } -> std::same_as<std::array<cell_index, 2>>;
    { c.loop_count(face) } -> std::same_as<std::size_t>;
    { c.face_loop(face, loop) } -> vertex_loop;
    { c.face_patch(face) } -> std::same_as<patch_index>;
    { c.model_size() } -> std::same_as<double>;
};

/// Where shards grow from. Laws: pure; the points depend on the arguments only and lie in no particular order.
/// Model: `struct mine { std::vector<vec3> operator()(solid const&, std::uint64_t seed) const; };`
/// The concept `site_pattern` stands in decomposition/sites.hpp, beside the shipped patterns.

}  // namespace tafoni

#endif
