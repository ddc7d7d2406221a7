#include <tafoni/decomposition/shard_surface.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include "support/shapes.hpp"
#include "support/shard_laws.hpp"
#include "support/surface_laws.hpp"

using namespace tafoni;

namespace {

/// Boxes and tetrahedra at small whole places, which touch, overlap and contain each other.
indexed_mesh soup(stream& draw, std::uint64_t parts) {
    indexed_mesh m;
    std::uint64_t const range = 2 + draw.index_below(4);
    auto const point = [&] {
        vec3 p{0, 0, 0};
        for (int a = 0; a < 3; ++a) p[a] = static_cast<double>(draw.index_below(range));
        return p;
    };
    while (parts > 0) {
        if (draw.chance(0.5)) {
            vec3 const lo = point();
            vec3 const size = point();
            tafoni_test::append(m, tafoni_test::box(lo, vec3{lo[0] + size[0] + 1, lo[1] + size[1] + 1, lo[2] + size[2] + 1}));
        } else {
            std::array<vec3, 4> q{};
            for (vec3& p : q) p = point();
            double const det = dot(vec3(q[1] - q[0]), cross(vec3(q[2] - q[0]), vec3(q[3] - q[0])));
            if (det == 0) continue;
            if (det < 0) std::swap(q[1], q[2]);
            auto t = tafoni_test::tetrahedron();
            t.positions.assign(q.begin(), q.end());
            tafoni_test::append(m, t);
        }
        --parts;
    }
    return m;
}

}  // namespace

TEST_CASE("solids that touch, overlap and nest on a lattice keep the laws of their chain, with sites on the same lattice") {
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        stream draw(seed, stage::user, 0);
        std::uint64_t const parts = 1 + draw.index_below(4);
        solid const body = make_solid(soup(draw, parts));
        std::uint64_t const count = 1 + draw.index_below(30);
        std::uint64_t const kind = draw.index_below(4);
        std::vector<vec3> sites;
        for (std::uint64_t k = 0; k < count; ++k) {
            vec3 p{0, 0, 0};
            for (int a = 0; a < 3; ++a) {
                double const lo = body.bounds.lo[a];
                double const hi = body.bounds.hi[a];
                double const step = kind == 2 ? 0.5 : 1.0;
                double x = lo + step * static_cast<double>(draw.index_below(static_cast<std::uint64_t>((hi - lo) / step) + 1));
                if (kind == 0) x = draw.uniform(lo, hi);
                if (kind == 3) x += draw.uniform(-1e-13, 1e-13);
                p[a] = std::min(hi, std::max(lo, x));
            }
            sites.push_back(p);
        }
        auto const c = voronoi_shards(body, sites, {.duplicates = duplicate_sites::merge});
        auto const broken = tafoni_test::broken_laws(body, c, {.embedded = parts == 1, .points = 10});
        for (auto const& b : broken) UNSCOPED_INFO("seed " << seed << ": " << b);
        CHECK(broken.empty());

        std::vector<std::uint8_t> inside(c.cell_count());
        for (auto& i : inside) i = draw.chance(0.5) ? 1 : 0;
        INFO("seed " << seed);
        CHECK(tafoni_test::manifold_defects(extract_surface(c, inside).mesh) == 0);
    }
}
