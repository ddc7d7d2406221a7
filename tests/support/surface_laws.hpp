/// \file
/// Whether a mesh is a closed 2-manifold.
#ifndef TAFONI_TESTS_SUPPORT_SURFACE_LAWS_HPP
#define TAFONI_TESTS_SUPPORT_SURFACE_LAWS_HPP

#include <tafoni/geometry/indexed_mesh.hpp>

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace tafoni_test {

/// Half-edges without exactly one opposite, plus vertices whose faces do not form one ring.
inline std::size_t manifold_defects(tafoni::indexed_mesh const& m) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> sides;  // half-edge -> faces
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        auto const loop = m.face(f);
        for (std::size_t k = 0; k < loop.size(); ++k) sides[{loop[k], loop[(k + 1) % loop.size()]}].push_back(f);
    }
    std::size_t defects = 0;
    for (auto const& [side, faces] : sides) {
        auto const other = sides.find({side.second, side.first});
        if (faces.size() != 1 || other == sides.end() || side.first == side.second) ++defects;
    }
    if (defects != 0) return defects;
    std::map<std::uint32_t, std::size_t> degree;
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> start;  // vertex -> one half-edge out of it
    for (auto const& [side, faces] : sides) {
        ++degree[side.first];
        start[side.first] = side;
    }
    for (auto const& [v, first] : start) {
        std::size_t seen = 0;
        auto side = first;
        do {
            auto const loop = m.face(sides[side][0]);
            std::size_t k = 0;
            while (loop[k] != v) ++k;
            side = {v, loop[(k + loop.size() - 1) % loop.size()]};
            ++seen;
        } while (side != first && seen <= degree[v]);
        if (seen != degree[v]) ++defects;
    }
    return defects;
}

}  // namespace tafoni_test

#endif
