// A curvature estimator of one's own: the mean over the neighbours of how strongly the surface bends towards each.
// Checked against the laws, compared with the library's, and put to work on a die that rolls in a river.
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/io/write_ply.hpp>
#include <tafoni/testing/curvature_laws.hpp>
#include <tafoni/weathering/curvature_run.hpp>

#include <array>
#include <cstdio>
#include <map>
#include <vector>

using namespace tafoni;

// The circle that touches the surface at p and passes through q bends by 2 n . (p - q) / |p - q|^2.
struct neighbor_circles {
    void operator()(surface_view const& s, std::span<double> mean, executor auto const& threads) const {
        std::vector<vec3> normals(s.positions.size());
        vertex_normals(s, normals, threads);
        threads.for_blocks(mean.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                double sum = 0;
                double circles = 0;
                for (std::uint32_t const w : s.rings->neighbors(v)) {
                    vec3 const d{s.positions[v] - s.positions[w]};
                    double const square = squared_length(d);
                    if (!(square > 0)) continue;  // two vertices in one place
                    sum += 2 * dot(normals[v], d) / square;
                    circles += 1;
                }
                mean[v] = circles > 0 ? sum / circles : 0.0;
            }
        });
    }
};
static_assert(curvature_estimator<neighbor_circles>);

// [0, 1]^3 with n x n squares a side.
indexed_mesh die(int n) {
    indexed_mesh m;
    std::map<std::array<int, 3>, std::uint32_t> known;
    auto const vertex = [&](std::size_t axis, int side, int a, int b) {
        std::array<int, 3> at{};
        at[axis] = side;
        at[(axis + 1) % 3] = a;
        at[(axis + 2) % 3] = b;
        auto const [place, fresh] = known.try_emplace(at, static_cast<std::uint32_t>(known.size()));
        if (fresh) m.add_vertex(vec3{1.0 * at[0] / n, 1.0 * at[1] / n, 1.0 * at[2] / n});
        return place->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (int const side : {0, n}) {
            for (int k = 0; k < n * n; ++k) {
                int const a = k / n;
                int const b = k % n;
                std::uint32_t const p = vertex(axis, side, a, b);
                std::uint32_t const q = vertex(axis, side, a + 1, b + 1);
                std::uint32_t const left = side == 0 ? vertex(axis, side, a, b + 1) : vertex(axis, side, a + 1, b);
                std::uint32_t const right = side == 0 ? vertex(axis, side, a + 1, b) : vertex(axis, side, a, b + 1);
                m.add_face({p, left, q});
                m.add_face({p, q, right});
            }
        }
    }
    return m;
}

int main() {
    for (std::string const& law : laws::curvature(neighbor_circles{})) std::printf("broken law: %s\n", law.c_str());
    thread_pool const threads(2);
    curvature_run run(die(16), curvature_weathering{.estimator = neighbor_circles{}});
    double const removed = run.run(120, {}, threads).removed_volume;
    std::printf("%.0f %% of the die is gone after 120 iterations\n", 100 * removed);
    triangle_surface const pebble = run.surface();
    write_ply("pebble.ply", pebble);
    return laws::curvature(neighbor_circles{}).empty() && removed > 0.2 && removed < 0.9 ? 0 : 1;
}
