/// \file
/// Checks that a mesh bounds a solid, and makes that solid.
#ifndef TAFONI_GEOMETRY_MAKE_SOLID_HPP
#define TAFONI_GEOMETRY_MAKE_SOLID_HPP

#include <tafoni/core/run_context.hpp>
#include <tafoni/geometry/detail/checked_mesh.hpp>
#include <tafoni/geometry/detail/solid_checks.hpp>
#include <tafoni/geometry/solid.hpp>
#include <tafoni/geometry/triangulate.hpp>

#include <span>

namespace tafoni {

/// What `make_solid` may be told besides the mesh.
struct make_solid_options {
    /// Empty, or one entry per face: 1 = a cut through the rock (side or base of a terrain), where no water enters.
    std::span<std::uint8_t const> artificial{};
};

namespace detail {

struct make_solid_fn {
    /// The solid that a closed, outward oriented mesh of polygons bounds.
    ///
    /// Vertices keep their numbers and places, polygons are cut by `triangulate`, `polygon_of` names
    /// the face of the mesh. Several components, cavities (inward oriented shells inside another one),
    /// any genus, vertices where sheets touch, vertices that no face uses, faces of zero area and
    /// surfaces that cut themselves are accepted. Works for sizes of 1e-100 to 1e100.
    ///
    /// \throws invalid_input  empty_input, non_finite_vertex, index_out_of_range, degenerate_face,
    ///   out_of_range (the cube of the extent must be a normal number), attribute_length, size_overflow.
    /// \throws bad_topology  duplicate_face, nonmanifold_edge (more than two sides), inconsistent_orientation or
    ///   non_orientable (two sides that run the same way), not_closed, inverted_orientation (a component that
    ///   encloses negative volume and lies in no other one), zero_volume.
    /// Checks run in this order, non-finite vertices first; the message names element and count. For an edge the
    /// place holds the running number of the corner where its first side starts and, as value, how many there are.
    /// O(n log d) for n corners and at most d edges at a vertex, plus O(n) per cavity.
    template <polygon_mesh M>
    [[nodiscard]] solid operator()(M const& mesh, make_solid_options const& options = {},
                                   run_context const& context = {}) const {
        char const* const who = "make_solid";
        context.tick(who, 0);
        if (mesh_access<M>::vertex_count(mesh) == 0 || mesh_access<M>::face_count(mesh) == 0) {
            fail<invalid_input>(errc::empty_input, std::string(who) + ": the mesh has " +
                                                       std::to_string(mesh_access<M>::vertex_count(mesh)) +
                                                       " vertices and " +
                                                       std::to_string(mesh_access<M>::face_count(mesh)) + " faces");
        }
        indexed_mesh polygons = checked_copy(who, mesh);
        require_proper_faces(who, polygons);
        if (!options.artificial.empty() && options.artificial.size() != polygons.face_count()) {
            fail<invalid_input>(errc::attribute_length,
                                std::string(who) + ": artificial has " + std::to_string(options.artificial.size()) +
                                    " entries for " + std::to_string(polygons.face_count()) + " faces",
                                {.kind = entity::attribute,
                                 .value = static_cast<double>(options.artificial.size()),
                                 .limit = static_cast<double>(polygons.face_count())});
        }
        box3 const bounds = used_bounds(polygons);
        require_safe_extent(who, bounds);
        context.tick(who, 0.3);
        std::vector<std::uint32_t> const across = paired_sides(who, polygons);
        context.tick(who, 0.6);

        solid s;
        s.bounds = bounds;
        s.polygon_count = polygons.face_count();
        if (options.artificial.empty()) s.artificial.assign(s.polygon_count, 0);
        else s.artificial.assign(options.artificial.begin(), options.artificial.end());
        cut_polygons(who, polygons, across, s);
        s.positions = std::move(polygons.positions);
        context.tick(who, 0.8);
        measure(who, s);
        context.tick(who, 1);
        return s;
    }
};

}  // namespace detail

/// Makes a solid from a mesh; see `detail::make_solid_fn`.
inline constexpr detail::make_solid_fn make_solid{};

}  // namespace tafoni

#endif
