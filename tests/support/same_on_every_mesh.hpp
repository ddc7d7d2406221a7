// What a mesh type has to show: every estimator and every run over it give the bits that they give on plain triangles.
#ifndef TAFONI_TESTS_SUPPORT_SAME_ON_EVERY_MESH_HPP
#define TAFONI_TESTS_SUPPORT_SAME_ON_EVERY_MESH_HPP

#include "support/curved_surfaces.hpp"

#include <tafoni/curvature/bubble_ratio.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/quadric_fit.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/fluid/rain_particles.hpp>
#include <tafoni/testing/mesh_laws.hpp>
#include <tafoni/weathering/curvature_run.hpp>
#include <tafoni/weathering/hydraulic_run.hpp>
#include <tafoni/weathering/wrinkles.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni_test {

/// A ring with uneven triangles and a hole in it, coordinates that float holds exactly.
[[nodiscard]] inline tafoni::triangle_surface uneven_ring() {
    tafoni::triangle_surface s = torus_surface(14, 9, 0.3).mesh;
    for (tafoni::vec3& p : s.positions) {
        for (int d = 0; d < 3; ++d) p[d] = std::floor(p[d] * 0x1p18) * 0x1p-18;
    }
    s.triangles.erase(s.triangles.begin() + 40, s.triangles.begin() + 44);
    return s;
}

/// What differs; empty where `mesh` weathers as `plain` does.
template <tafoni::polygon_mesh M>
[[nodiscard]] std::vector<std::string> differences(M const& mesh, tafoni::triangle_surface const& plain) {
    std::vector<std::string> out = tafoni::laws::mesh(mesh);
    auto const estimator = [&](char const* name, auto const& e) {
        std::vector<double> const ours = tafoni::estimate_curvature(mesh, e);
        std::vector<double> const theirs = tafoni::estimate_curvature(plain, e);
        bool same = ours.size() == theirs.size();
        for (std::size_t v = 0; same && v < ours.size(); ++v) {
            same = std::bit_cast<std::uint64_t>(ours[v]) == std::bit_cast<std::uint64_t>(theirs[v]);
        }
        if (!same) out.push_back(name);
    };
    estimator("tensor_fit", tafoni::tensor_fit{});
    estimator("cotangent", tafoni::cotangent{});
    estimator("quadric_fit", tafoni::quadric_fit{});
    estimator("bubble_ratio", tafoni::bubble_ratio{});
    tafoni::curvature_run ours(mesh);
    tafoni::curvature_run theirs(plain);
    ours.run(5);
    theirs.run(5);
    if (!(ours.surface() == theirs.surface()) || ours.report().iterations != 5) out.push_back("curvature_run");
    auto const under_rain = [&](char const* name, auto const& process) {
        tafoni::box3 box;
        for (tafoni::vec3 const& p : plain.positions) box.include(p);
        tafoni::box_emitter const cloud{.box = {.lo = tafoni::vec3{box.lo[0], box.lo[1], box.hi[2] + 0.1}, .hi = tafoni::vec3{box.hi[0], box.hi[1], box.hi[2] + 0.2}}};
        tafoni::box_sink const sink{.keep = {.lo = tafoni::vec3{box.lo[0] - 1, box.lo[1] - 1, box.lo[2] - 1}, .hi = tafoni::vec3{box.hi[0] + 1, box.hi[1] + 1, box.hi[2] + 1}}};
        tafoni::rain_particles const rain(cloud, sink, {.particles = 300, .radius = 0.1});
        tafoni::hydraulic_run wet(mesh, rain, process);
        tafoni::hydraulic_run same(plain, rain, process);
        wet.run(20);
        same.run(20);
        if (!(wet.surface() == same.surface()) || wet.report().ledger.eroded != same.report().ledger.eroded ||
            !(same.report().ledger.eroded > 0)) {
            out.push_back(name);
        }
    };
    under_rain("hydraulic_run by stress", tafoni::partheniades_erosion{.coefficient = 1e-3, .critical = 0});
    under_rain("hydraulic_run by curvature", tafoni::curvature_erosion<>{});
    auto const folded = [&](auto const& base) {
        std::uint32_t const end = plain.triangles[plain.triangles.size() / 2][0];
        tafoni::wrinkle const fold{.controls = {tafoni::vertex_index{plain.triangles[0][0]}, tafoni::vertex_index{end}}, .radius = 0.3};
        return tafoni::wrinkle_pattern(base, std::span(&fold, 1)).wear(plain.positions, 2);
    };
    tafoni::triangle_surface const fold = folded(mesh);
    if (!(fold == folded(plain)) || fold.positions.size() <= plain.positions.size()) out.push_back("wrinkle_pattern");
    return out;
}

}  // namespace tafoni_test

#endif
