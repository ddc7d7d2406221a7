/// \file
/// Groups the polygons of a solid into smooth patches.
#ifndef TAFONI_DECOMPOSITION_DETAIL_SMOOTH_PATCHES_HPP
#define TAFONI_DECOMPOSITION_DETAIL_SMOOTH_PATCHES_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/solid.hpp>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Input polygon -> patch; not valid for artificial polygons.
struct patch_map {
    std::vector<patch_index> of{};
    std::size_t count = 0;
};

/// Polygons belong to one patch when they are joined by sides across which their normals turn by at
/// most `angle` degrees; with 0 every polygon is a patch of its own. Normals are area vectors, scaled
/// by a power of two, so patches do not depend on place or scale. Patches are numbered by their
/// lowest polygon. O(polygons).
template <class Executor>
[[nodiscard]] patch_map smooth_patches(solid const& body, double angle, Executor const& threads) {
    std::vector<vec3> normals(body.polygon_count, vec3{0, 0, 0});
    std::vector<std::uint32_t> parent(body.polygon_count);
    for (std::uint32_t p = 0; p < parent.size(); ++p) parent[p] = p;
    auto const artificial = [&body](std::uint32_t p) { return !body.artificial.empty() && body.artificial[p] != 0; };
    std::vector<std::uint8_t> smooth;  // half-edge -> the patch goes on across it
    if (angle > 0) {
        int exponent = 0;
        (void)std::frexp(body.bounds.diagonal(), &exponent);
        double const scale = std::ldexp(1.0, -exponent);
        std::vector<vec3> areas(body.triangles.size());
        threads.for_blocks(areas.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                vec3 const& a = body.positions[body.triangles[t][0]];
                vec3 const& b = body.positions[body.triangles[t][1]];
                vec3 const& c = body.positions[body.triangles[t][2]];
                vec3 u{0, 0, 0};
                vec3 v{0, 0, 0};
                for (int k = 0; k < 3; ++k) {
                    u[k] = (b[k] - a[k]) * scale;
                    v[k] = (c[k] - a[k]) * scale;
                }
                areas[t] = cross(u, v);
            }
        });
        for (std::size_t t = 0; t < areas.size(); ++t) {
            vec3& sum = normals[body.polygon_of[t]];
            sum = vec3{sum[0] + areas[t][0], sum[1] + areas[t][1], sum[2] + areas[t][2]};
        }
        threads.for_blocks(normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) normals[p] = normalized(normals[p]);
        });
        double const least = elementary::cos(angle * 0x1.1df46a2529d39p-6) - 1e-12;  // pi / 180; the angle itself counts
        smooth.resize(body.opposite.size());
        threads.for_blocks(smooth.size(), 16384, [&](std::size_t begin, std::size_t end) {
            for (std::size_t h = begin; h < end; ++h) {
                std::uint32_t const p = body.polygon_of[h / 3];
                std::uint32_t const q = body.polygon_of[body.opposite[h] / 3];
                bool const on = p < q && !artificial(p) && !artificial(q) && dot(normals[p], normals[q]) >= least;
                smooth[h] = on ? 1 : 0;
            }
        });
    }
    auto const root = [&parent](std::uint32_t x) {
        while (parent[x] != x) {
            parent[x] = parent[parent[x]];
            x = parent[x];
        }
        return x;
    };
    for (std::size_t h = 0; h < smooth.size(); ++h) {
        if (smooth[h] == 0) continue;
        std::uint32_t const a = root(body.polygon_of[h / 3]);
        std::uint32_t const b = root(body.polygon_of[body.opposite[h] / 3]);
        parent[a < b ? b : a] = a < b ? a : b;
    }
    patch_map map;
    map.of.resize(body.polygon_count);
    for (std::uint32_t p = 0; p < map.of.size(); ++p) {
        if (artificial(p)) continue;
        std::uint32_t const r = root(p);
        map.of[p] = r == p ? patch_index{map.count++} : map.of[r];
    }
    return map;
}

}  // namespace tafoni::detail

#endif
