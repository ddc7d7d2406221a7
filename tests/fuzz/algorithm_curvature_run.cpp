// Bytes make a mesh, policies and a plan: curvature weathering keeps its numbers, its maps and its checkpoints.
#include "check_mesh_file.hpp"
#include "damaged_checkpoint.hpp"
#include "random_soup.hpp"

#include <tafoni/curvature/bubble_ratio.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/curvature/quadric_fit.hpp>
#include <tafoni/weathering/curvature_run.hpp>

namespace {

using namespace tafoni;
using tafoni_test::choices;
using tafoni_test::require;

template <class Run>
void check_run(triangle_surface const& input, Run const& run) {
    triangle_surface const s = run.surface();
    for (auto const& t : s.triangles) {
        for (std::uint32_t const v : t) require(v < s.positions.size(), "corners are vertices");
    }
    for (vec3 const& p : s.positions) require(is_finite(p), "positions are finite");
    require(run.new_vertex().size() == input.positions.size(), "every vertex of the input leads somewhere");
    for (vertex_index const v : run.new_vertex()) require(!v.valid() || v.value < s.positions.size(), "vertices lead to vertices");
    std::vector<double> const wear = run.wear();
    require(wear.size() == s.positions.size(), "a way per vertex");
    for (double const w : wear) require(w >= 0 && std::isfinite(w), "ways are finite");
    require(std::isfinite(run.report().removed_volume), "the volume is finite");
}

template <class Estimator, class Direction>
void weather(triangle_surface const& s, choices& c, Estimator const& estimator, Direction const& direction) {
    curvature_weathering<Estimator, Direction> const process{.estimator = estimator, .direction = direction};
    curvature_options options{.power = 1 + 4 * c.unit(), .step_divisor = 1 + 20 * c.unit()};
    options.check_every = static_cast<std::uint32_t>(c.below(4));
    options.topology = c.chance(0.5) ? mesh_topology::keep : mesh_topology::adapt;
    curvature_run run(s, process, options);
    curvature_run same(s, process, options);
    for (std::uint64_t act = 1 + c.below(3); act-- > 0;) {
        std::uint64_t const n = c.below(8);
        run.run(n);
        check_run(s, run);
        if (options.check_every == 0) {
            std::uint64_t const first = c.below(n + 1);
            same.run(first);
            auto const middle = same.checkpoint();
            same.resume(middle);
            require(same.checkpoint() == middle, "a checkpoint comes back as it was");
            same.run(n - first);
            require(same.checkpoint() == run.checkpoint(), "n then m iterations are n + m, also over checkpoints");
        }
    }
    tafoni_test::resume_damaged(run, c);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(unsigned char const* bytes, std::size_t size) {
    choices c(std::span(bytes, size));
    triangle_surface const s = tafoni_test::random_soup(c);
    switch (c.below(4)) {
    case 0: weather(s, c, tensor_fit{}, laplacian_direction{}); break;
    case 1: weather(s, c, cotangent{}, blended_direction{}); break;
    case 2: weather(s, c, quadric_fit{}, inward_normal{}); break;
    default: weather(s, c, bubble_ratio{}, laplacian_direction{}); break;
    }
    return 0;
}
