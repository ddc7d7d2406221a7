#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/graph/air_flood.hpp>
#include <tafoni/graph/make_link_graph.hpp>
#include <tafoni/graph/surface_walk.hpp>

#include <set>

using namespace tafoni;

namespace {

voxel_cells random_rock(stream& random) {
    voxel_cells_options o;
    for (std::size_t& s : o.size) s = 1 + random.index_below(6);
    for (bool& side : o.artificial) side = random.chance(0.2);
    double const share = random.uniform01();
    return voxel_cells::from_predicate(o, [&](vec3 const&) { return random.chance(share); });
}

std::vector<link_state> fresh_links(auto const& n, stream& random) {
    std::vector<link_state> links(n.link_count(), link_state::gone);
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (!n.has_link(link_index{l})) continue;
        links[l] = random.chance(0.3) ? link_state::broken : link_state::bonded;
    }
    return links;
}

/// Air with a path of air to an exterior link, by closure until nothing changes.
std::vector<char> brute_open(auto const& n, std::vector<cell_state> const& cells) {
    std::vector<char> open(cells.size(), 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t l = 0; l < n.link_count(); ++l) {
            if (!n.has_link(link_index{l})) continue;
            auto const ends = n.link_cells(link_index{l});
            bool const from_outside = !ends[1].valid() || open[ends[0].value] || open[ends[1].value];
            for (cell_index const e : ends) {
                if (e.valid() && cells[e.value] == cell_state::air && from_outside && !open[e.value]) {
                    open[e.value] = 1;
                    changed = true;
                }
            }
        }
    }
    return open;
}

void require_flooded(auto const& n, std::vector<cell_state> const& cells, std::vector<link_state> const& at_start,
                     std::vector<link_state> const& links) {
    auto const open = brute_open(n, cells);
    for (std::size_t l = 0; l < n.link_count(); ++l) {
        if (!n.has_link(link_index{l})) continue;
        auto const ends = n.link_cells(link_index{l});
        bool const a = cells[ends[0].value] != cell_state::air;
        bool const b = ends[1].valid() && cells[ends[1].value] != cell_state::air;
        link_state expected = link_state::gone;
        if (a && b) {
            expected = at_start[l];
        } else if (a || b) {
            bool const reached = !ends[1].valid() || open[ends[0].value] || open[ends[1].value];
            expected = reached ? link_state::skin : link_state::pocket;
        }
        REQUIRE(links[l] == expected);
    }
}

void require_change(std::vector<link_state> const& before, std::vector<link_state> const& after,
                    exposure_change const& change) {
    std::vector<link_index> opened;
    std::vector<link_index> closed;
    for (std::size_t l = 0; l < before.size(); ++l) {
        bool const was = before[l] == link_state::skin;
        bool const is = after[l] == link_state::skin;
        if (is && !was) opened.push_back(link_index{l});
        if (was && !is) closed.push_back(link_index{l});
    }
    REQUIRE(change.opened == opened);
    REQUIRE(change.closed == closed);
}

/// The paper's search as printed, from all remaining exterior links, over neighbours between rock and air.
std::vector<link_state> walk_by_the_book(auto const& n, std::vector<cell_state> const& cells,
                                         std::vector<link_state> links) {
    std::vector<link_index> queue;
    std::vector<char> one_sided(links.size(), 0);
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (!n.has_link(link_index{l})) continue;
        auto const ends = n.link_cells(link_index{l});
        bool const a = cells[ends[0].value] != cell_state::air;
        bool const b = ends[1].valid() && cells[ends[1].value] != cell_state::air;
        one_sided[l] = a != b;
        if (!a && !b) {
            links[l] = link_state::gone;
        } else if (a != b) {
            if (links[l] != link_state::skin && ends[1].valid()) links[l] = link_state::pocket;
            if (!ends[1].valid()) links[l] = link_state::skin;
            if (links[l] == link_state::skin) queue.push_back(link_index{l});
        }
    }
    for (std::size_t i = 0; i < queue.size(); ++i) {
        n.for_each_neighbor(queue[i], [&](link_index m) {
            if (!one_sided[m.value] || links[m.value] == link_state::skin) return;
            links[m.value] = link_state::skin;
            queue.push_back(m);
        });
    }
    return links;
}

template <class Network, class Check>
void erode(Network const& n, exposure_policy auto const& policy, stream& random, Check const& check) {
    std::vector<cell_state> cells(n.cell_count(), cell_state::solid);
    for (cell_state& c : cells) {
        if (random.chance(0.1)) c = cell_state::air;
        if (random.chance(0.1)) c = cell_state::core;
    }
    auto const at_start = fresh_links(n, random);
    auto links = at_start;
    auto state = policy.start(n, cells, links);
    check(cells, at_start, at_start, links, true);
    for (int step = 0; step < 30; ++step) {
        std::vector<cell_index> fallen;
        std::uint64_t const tries = random.index_below(6);
        for (std::uint64_t i = 0; i < tries && n.cell_count() > 0; ++i) {
            cell_index const c{static_cast<std::uint32_t>(random.index_below(n.cell_count()))};
            if (cells[c.value] == cell_state::air) continue;
            cells[c.value] = cell_state::air;
            fallen.push_back(c);
        }
        auto const before = links;
        exposure_change change{.opened = {link_index{7U}}};
        policy.update(n, cells, fallen, state, links, change);
        require_change(before, links, change);
        check(cells, at_start, before, links, false);
    }
}

}  // namespace

TEST_CASE("the air flood equals a closure over all links after every fall", "[law13]") {
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 0);
        voxel_cells const rock = random_rock(random);
        auto const check = [](auto const& n) {
            return [&n](auto const& cells, auto const& at_start, auto const&, auto const& links, bool) {
                require_flooded(n, cells, at_start, links);
            };
        };
        erode(rock, air_flood{}, random, check(rock));
        link_graph const graph = make_link_graph(rock);
        erode(graph, air_flood{}, random, check(graph));
    }
}

TEST_CASE("the surface walk equals the paper's search from all remaining exterior links", "[law13]") {
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        INFO("seed " << seed);
        stream random(seed, stage::user, 1);
        voxel_cells const rock = random_rock(random);
        erode(rock, surface_walk{}, random,
              [&](auto const& cells, auto const&, auto before, auto const& links, bool) {
                  REQUIRE(walk_by_the_book(rock, cells, before) == links);
              });
    }
}

TEST_CASE("an air pocket stays closed until a cell opens it, and then all of it is skin") {
    // 5 x 3 x 3 rock; the middle three voxels in a row fall one by one from inside.
    auto const rock = voxel_cells::from_predicate({.size = {5, 3, 3}}, [](vec3 const&) { return true; });
    std::vector<cell_state> cells(rock.cell_count(), cell_state::solid);
    std::vector<link_state> links(rock.link_count(), link_state::bonded);
    auto const policy = air_flood{};
    auto state = policy.start(rock, cells, links);
    exposure_change change;
    auto const fall = [&](std::size_t i) {
        cell_index const c = rock.cell_at(i, 1, 1);
        cells[c.value] = cell_state::air;
        policy.update(rock, cells, std::array{c}, state, links, change);
    };
    fall(2);
    REQUIRE(change.opened.empty());
    fall(3);
    REQUIRE(change.opened.empty());
    std::size_t pockets = 0;
    for (link_state const s : links) pockets += s == link_state::pocket ? 1U : 0U;
    REQUIRE(pockets == 10);
    fall(4);  // on the skin: 4 links of its own, the 10 of the pocket less the one to this cell
    REQUIRE(change.opened.size() == 4 + 9);
    REQUIRE(change.closed.size() == 1);
}

TEST_CASE("the surface walk loses everything where the whole skin falls at once") {
    auto const rock = voxel_cells::from_predicate({.size = {3, 3, 3}}, [](vec3 const&) { return true; });
    std::vector<cell_state> cells(27, cell_state::solid);
    std::vector<link_state> walk(rock.link_count(), link_state::bonded);
    std::vector<link_state> air = walk;
    auto walk_state = surface_walk{}.start(rock, cells, walk);
    auto air_state = air_flood{}.start(rock, cells, air);
    std::vector<cell_index> shell;
    for (std::uint32_t c = 0; c < 27; ++c) {
        if (cell_index{c} == rock.cell_at(1, 1, 1)) continue;
        shell.push_back(cell_index{c});
        cells[c] = cell_state::air;
    }
    exposure_change change;
    surface_walk{}.update(rock, cells, shell, walk_state, walk, change);
    REQUIRE(change.opened.empty());
    REQUIRE(change.closed.size() == 54);
    air_flood{}.update(rock, cells, shell, air_state, air, change);
    REQUIRE(change.opened.size() == 6);
    REQUIRE(change.closed.size() == 54);
}

TEST_CASE("exposure refuses states of the wrong length") {
    auto const rock = voxel_cells::from_predicate({.size = {2, 1, 1}}, [](vec3 const&) { return true; });
    std::vector<cell_state> cells(3, cell_state::solid);
    std::vector<link_state> links(rock.link_count(), link_state::bonded);
    REQUIRE_THROWS_AS(air_flood{}.start(rock, cells, links), invalid_input);
    REQUIRE_THROWS_AS(surface_walk{}.start(rock, cells, links), invalid_input);
}
