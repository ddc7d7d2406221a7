/// \file
/// A closed oriented surface, checked at the door: what every decomposition starts from.
#ifndef TAFONI_GEOMETRY_SOLID_HPP
#define TAFONI_GEOMETRY_SOLID_HPP

#include <tafoni/core/vector.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace tafoni {

/// The triangulated boundary chain of a solid, outward oriented. Made by `make_solid`
/// (geometry/make_solid.hpp), which validates; trusted everywhere else.
///
/// Half-edge h = 3 t + k runs from corner k to corner (k + 1) % 3 of triangle t.
struct solid {
    std::vector<vec3> positions{};                           ///< the user's frame; isolated vertices are kept
    std::vector<std::array<std::uint32_t, 3>> triangles{};   ///< deterministic triangulation of the polygons
    std::vector<std::uint32_t> polygon_of{};                 ///< triangle -> input face
    std::vector<std::uint32_t> opposite{};                   ///< half-edge -> the half-edge across it
    std::vector<std::uint8_t> artificial{};                  ///< per input face: 1 = a side or base of a terrain
    std::size_t polygon_count = 0;                           ///< faces of the input
    double volume = 0;                                       ///< of this triangulation, > 0, cubed length unit
    double area = 0;                                         ///< of all triangles, squared length unit
    box3 bounds{};                                           ///< of the vertices that faces use
};

}  // namespace tafoni

#endif
