/// \file
/// Reads positions and faces where they lie in the caller's memory, without copying.
#ifndef TAFONI_GEOMETRY_SPAN_MESH_HPP
#define TAFONI_GEOMETRY_SPAN_MESH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/concepts.hpp>

#include <concepts>
#include <cstdint>
#include <limits>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>

namespace tafoni {

/// A mesh in flat arrays: x y z of vertex 0, x y z of vertex 1, ...; corner indices of any integer type.
///
/// Without offsets the corners come in threes. With offsets face f has the corners
/// [offsets[f], offsets[f + 1]). Negative indices read as huge ones, which `make_solid` refuses by
/// name. The arrays must outlive the view. Made by `view_triangles` and `view_polygons`.
template <std::floating_point Scalar, std::integral Index, bool Triangles>
struct span_mesh {
    std::span<Scalar const> coordinates{};   ///< 3 per vertex
    std::span<Index const> corners{};
    std::span<std::size_t const> offsets{};  ///< faces + 1 entries; empty for triangles
};

namespace detail {

template <class Mesh>
struct span_vertices {
    static std::size_t vertex_count(Mesh const& m) { return m.coordinates.size() / 3; }
    static vec3 position(Mesh const& m, std::size_t v) {
        auto const p = m.coordinates.subspan(3 * v, 3);
        return vec3{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    }
};

}  // namespace detail

template <class Scalar, class Index, bool Triangles>
struct mesh_access<span_mesh<Scalar, Index, Triangles>> : detail::span_vertices<span_mesh<Scalar, Index, Triangles>> {
    using mesh = span_mesh<Scalar, Index, Triangles>;

    static std::size_t face_count(mesh const& m) { return m.offsets.empty() ? 0 : m.offsets.size() - 1; }
    static std::size_t face_size(mesh const& m, std::size_t f) { return m.offsets[f + 1] - m.offsets[f]; }
    static std::uint64_t corner(mesh const& m, std::size_t f, std::size_t k) {
        return static_cast<std::uint64_t>(m.corners[m.offsets[f] + k]);
    }
};

template <class Scalar, class Index>
struct mesh_access<span_mesh<Scalar, Index, true>> : detail::span_vertices<span_mesh<Scalar, Index, true>> {
    using mesh = span_mesh<Scalar, Index, true>;
    static constexpr std::size_t corners_per_face = 3;

    static std::size_t face_count(mesh const& m) { return m.corners.size() / 3; }
    static std::size_t face_size(mesh const&, std::size_t) { return 3; }
    static std::uint64_t corner(mesh const& m, std::size_t f, std::size_t k) {
        return static_cast<std::uint64_t>(m.corners[3 * f + k]);
    }
};

static_assert(triangle_mesh<span_mesh<float, std::int32_t, true>>);
static_assert(polygon_mesh<span_mesh<double, std::uint64_t, false>>);

namespace detail {

/// An array in one piece of numbers: vector, array, span, C array.
template <class R>
concept flat_array = std::ranges::contiguous_range<R> && std::ranges::sized_range<R> &&
                     std::is_arithmetic_v<std::ranges::range_value_t<R>>;

/// A view must not outlive a temporary vector that was passed in.
template <class R>
concept lasting_array = flat_array<R> && std::ranges::borrowed_range<R>;

template <class R>
using element = std::ranges::range_value_t<R>;

inline void require_multiple_of_three(char const* who, char const* what, std::size_t size) {
    if (size % 3 == 0) return;
    fail<invalid_input>(errc::attribute_length,
                        std::string(who) + ": " + what + " has " + std::to_string(size) + " entries, not a multiple of 3",
                        {.kind = entity::attribute, .value = static_cast<double>(size)});
}

}  // namespace detail

/// Triangles in two flat arrays, of float or double and of any integer type.
/// \throws invalid_input  attribute_length: an array is not a multiple of three. O(1).
template <detail::lasting_array Coordinates, detail::lasting_array Corners>
    requires std::floating_point<detail::element<Coordinates>> && std::integral<detail::element<Corners>>
[[nodiscard]] auto view_triangles(Coordinates&& coordinates, Corners&& corners) {
    detail::require_multiple_of_three("view_triangles", "coordinates", std::ranges::size(coordinates));
    detail::require_multiple_of_three("view_triangles", "corners", std::ranges::size(corners));
    using view = span_mesh<detail::element<Coordinates>, detail::element<Corners>, true>;
    return view{{std::ranges::data(coordinates), std::ranges::size(coordinates)},
                {std::ranges::data(corners), std::ranges::size(corners)},
                {}};
}

/// Polygons in flat arrays; `offsets` starts with 0, never falls and ends with the number of corners.
/// \throws invalid_input  attribute_length. O(faces).
template <detail::lasting_array Coordinates, detail::lasting_array Corners>
    requires std::floating_point<detail::element<Coordinates>> && std::integral<detail::element<Corners>>
[[nodiscard]] auto view_polygons(Coordinates&& coordinates, Corners&& corners, std::span<std::size_t const> offsets) {
    detail::require_multiple_of_three("view_polygons", "coordinates", std::ranges::size(coordinates));
    bool ordered = offsets.empty() || (offsets.front() == 0 && offsets.back() == std::ranges::size(corners));
    if (offsets.empty()) ordered = std::ranges::size(corners) == 0;
    for (std::size_t f = 1; f < offsets.size(); ++f) ordered = ordered && offsets[f - 1] <= offsets[f];
    if (!ordered) {
        detail::fail<invalid_input>(errc::attribute_length,
                                    "view_polygons: offsets must rise from 0 to the number of corners, " +
                                        std::to_string(std::ranges::size(corners)),
                                    {.kind = entity::attribute,
                                     .value = static_cast<double>(offsets.size()),
                                     .limit = static_cast<double>(std::ranges::size(corners))});
    }
    using view = span_mesh<detail::element<Coordinates>, detail::element<Corners>, false>;
    return view{{std::ranges::data(coordinates), std::ranges::size(coordinates)},
                {std::ranges::data(corners), std::ranges::size(corners)},
                offsets};
}

}  // namespace tafoni

#endif
