/// \file
/// What the paper's scenes share: a solid cut into shards, its links, and looks at what has fallen.
#ifndef TAFONI_TESTS_PAPER_SCENE_HPP
#define TAFONI_TESTS_PAPER_SCENE_HPP

#include <support/shapes.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/weathering/frost_run.hpp>

#include <functional>
#include <utility>
#include <vector>

namespace tafoni_test {

using namespace tafoni;

struct scene {
    solid body;
    shard_complex shards;
    link_graph links;
};

/// Cuts `body` by `sites`.
[[nodiscard]] inline scene make_scene(solid body, std::vector<vec3> const& sites) {
    scene s{.body = std::move(body), .shards = {}, .links = {}};
    s.shards = voronoi_shards(s.body, sites);
    s.links = make_link_graph(s.shards);
    return s;
}

/// The cells whose centroid fulfils the predicate.
[[nodiscard]] inline std::vector<cell_index> cells_where(shard_complex const& shards,
                                                         std::function<bool(vec3 const&)> const& fulfils) {
    std::vector<cell_index> r;
    for (std::size_t c = 0; c < shards.cell_count(); ++c) {
        if (fulfils(shards.cell_centroid(cell_index{c}))) r.push_back(cell_index{c});
    }
    return r;
}

/// The cells with a link to the outside whose normal fulfils the predicate.
[[nodiscard]] inline std::vector<cell_index> skin_cells_where(link_graph const& links,
                                                              std::function<bool(vec3 const&)> const& fulfils) {
    std::vector<std::uint8_t> found(links.cell_count(), 0);
    for (std::size_t l = links.interior_link_count(); l < links.link_count(); ++l) {
        if (fulfils(links.link_normal(link_index{l}))) found[links.link_cells(link_index{l})[0].value] = 1;
    }
    std::vector<cell_index> r;
    for (std::size_t c = 0; c < found.size(); ++c) {
        if (found[c] != 0) r.push_back(cell_index{c});
    }
    return r;
}

/// Volume of the cells in a state.
template <class Run>
[[nodiscard]] double volume_of(Run const& run, cell_state state) {
    return pairwise_sum(0, run.cells().size(), [&](std::size_t c) {
        return run.cells()[c] == state ? run.network().cell_volume(cell_index{c}) : 0.0;
    });
}

/// Volume-weighted mean place of what fell between two numbers of paths.
template <class Run>
[[nodiscard]] vec3 mean_place_fallen(Run const& run, shard_complex const& shards, std::uint64_t after, std::uint64_t until) {
    vec3 sum{0, 0, 0};
    double weight = 0;
    for (detached_block const& block : run.blocks()) {
        if (block.path <= after || block.path > until) continue;
        for (cell_index const c : block.cells) {
            double const v = shards.cell_volume(c);
            vec3 const x = shards.cell_centroid(c);
            sum = vec3{sum[0] + v * x[0], sum[1] + v * x[1], sum[2] + v * x[2]};
            weight += v;
        }
    }
    return weight > 0 ? vec3{sum[0] / weight, sum[1] / weight, sum[2] / weight} : vec3{0, 0, 0};
}

/// True when every solid cell hangs on a core cell by whole bonds; by union-find, not by the engine's search.
template <class Run>
[[nodiscard]] bool all_solid_hangs_on_core(Run const& run) {
    auto const& network = run.network();
    std::vector<std::uint32_t> parent(network.cell_count());
    for (std::uint32_t c = 0; c < parent.size(); ++c) parent[c] = c;
    auto const root = [&](std::uint32_t c) {
        while (parent[c] != c) c = parent[c] = parent[parent[c]];
        return c;
    };
    for (std::size_t l = 0; l < network.link_count(); ++l) {
        if (!network.has_link(link_index{l}) || run.state(link_index{l}) != link_state::bonded) continue;
        auto const cells = network.link_cells(link_index{l});
        parent[root(cells[0].value)] = root(cells[1].value);
    }
    std::vector<std::uint8_t> core(parent.size(), 0);
    for (std::uint32_t c = 0; c < parent.size(); ++c) {
        if (run.cells()[c] == cell_state::core) core[root(c)] = 1;
    }
    for (std::uint32_t c = 0; c < parent.size(); ++c) {
        if (run.cells()[c] == cell_state::solid && core[root(c)] == 0) return false;
    }
    return true;
}

}  // namespace tafoni_test

#endif
