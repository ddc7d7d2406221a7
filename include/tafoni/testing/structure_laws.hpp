/// \file
/// Law checks for structures: complexes, networks, site patterns, executors, exposures.
#ifndef TAFONI_TESTING_STRUCTURE_LAWS_HPP
#define TAFONI_TESTING_STRUCTURE_LAWS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/concepts.hpp>
#include <tafoni/decomposition/sites.hpp>
#include <tafoni/graph/concepts.hpp>
#include <tafoni/graph/exposure.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::laws {

/// Network: valid first cells, unit normals, positive areas and volumes, links listed once by each of
/// their cells and by no other, neighbours symmetric, once each, without the link itself, and always in
/// the same order. O(links x Neigh log).
template <link_network N>
[[nodiscard]] std::vector<std::string> network(N const& n) {
    std::vector<std::string> broken;
    auto const law = [&](bool holds, std::string what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(std::move(what));
    };
    std::vector<int> listed(n.link_count(), 0);
    for (std::size_t c = 0; c < n.cell_count(); ++c) {
        double const v = n.cell_volume(cell_index{c});
        law(v > 0 && std::isfinite(v), "cell volumes are positive and finite");
        n.for_each_cell_link(cell_index{c}, [&](link_index l) {
            if (l.value >= n.link_count() || !n.has_link(l)) return law(false, "cells list links that exist");
            auto const ends = n.link_cells(l);
            law(ends[0].value == c || ends[1].value == c, "a cell lists its own links only");
            ++listed[l.value];
        });
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::size_t i = 0; i < n.link_count(); ++i) {
        link_index const l{i};
        if (!n.has_link(l)) continue;
        auto const ends = n.link_cells(l);
        law(ends[0].valid() && ends[0].value < n.cell_count(), "link_cells(l)[0] is valid");
        law(!ends[1].valid() || ends[1].value < n.cell_count(), "link_cells(l)[1] is a cell or not valid");
        law(ends[0] != ends[1], "a link joins two different cells");
        law(listed[i] == (ends[1].valid() ? 2 : 1), "each cell of a link lists it once");
        law(n.link_area(l) > 0 && std::isfinite(n.link_area(l)), "link areas are positive and finite");
        law(is_finite(n.link_centroid(l)), "link centroids are finite");
        law(std::fabs(length(n.link_normal(l)) - 1) <= 1e-6, "link normals have unit length");
        std::vector<std::uint32_t> first;
        std::vector<std::uint32_t> again;
        n.for_each_neighbor(l, [&](link_index m) { first.push_back(m.value); });
        n.for_each_neighbor(l, [&](link_index m) { again.push_back(m.value); });
        law(first == again, "neighbours come in the same order every time");
        for (std::uint32_t const m : first) {
            law(m != i, "a link is not its own neighbour");
            law(m < n.link_count() && n.has_link(link_index{m}), "neighbours exist");
            pairs.push_back({static_cast<std::uint32_t>(i), m});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    law(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end(), "a neighbour is visited once");
    for (auto const& [a, b] : pairs) {
        if (!std::binary_search(pairs.begin(), pairs.end(), std::pair{b, a})) law(false, "Neigh is symmetric");
    }
    return broken;
}

/// Complex: around every cell each directed edge has its opposite (so the cell is closed), faces name
/// cells that exist, volumes are positive and those that the faces enclose. O(corners log corners).
template <cell_complex C>
[[nodiscard]] std::vector<std::string> complex(C const& c) {
    std::vector<std::string> broken;
    auto const law = [&](bool holds, std::string what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(std::move(what));
    };
    law(c.model_size() > 0, "model_size() is positive");
    std::map<std::array<std::uint32_t, 3>, int> edges;  // cell, from, to
    std::vector<double> enclosed(c.cell_count(), 0);
    vec3 const origin = c.vertex_count() > 0 ? c.position(vertex_index{std::uint32_t{0}}) : vec3{0, 0, 0};
    for (std::size_t f = 0; f < c.face_count(); ++f) {
        auto const ends = c.face_cells(face_index{f});
        if (!ends[0].valid() || ends[0].value >= c.cell_count() || (ends[1].valid() && ends[1].value >= c.cell_count())) {
            law(false, "faces lie between cells that exist, the front one valid");
            continue;
        }
        law(!ends[1].valid() || !c.face_patch(face_index{f}).valid(), "faces inside have no patch");
        for (std::size_t loop = 0; loop < c.loop_count(face_index{f}); ++loop) {
            auto const corners = c.face_loop(face_index{f}, loop);
            law(corners.size() >= 3, "loops have at least three corners");
            for (std::size_t k = 0; k < corners.size(); ++k) {
                vertex_index const from = corners[k];
                vertex_index const to = corners[(k + 1) % corners.size()];
                if (from.value >= c.vertex_count() || to.value >= c.vertex_count()) {
                    law(false, "loops name vertices that exist");
                    continue;
                }
                law(from != to, "loops do not repeat a vertex at once");
                edges[{ends[0].value, from.value, to.value}] += 1;
                edges[{ends[0].value, to.value, from.value}] -= 1;
                if (ends[1].valid()) {
                    edges[{ends[1].value, to.value, from.value}] += 1;
                    edges[{ends[1].value, from.value, to.value}] -= 1;
                }
            }
            for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
                vec3 const a = c.position(corners[0]) - origin;
                vec3 const b = c.position(corners[k]) - origin;
                vec3 const d = c.position(corners[k + 1]) - origin;
                double const six = dot(a, cross(b, d));
                enclosed[ends[0].value] += six / 6;
                if (ends[1].valid()) enclosed[ends[1].value] -= six / 6;
            }
        }
    }
    for (auto const& edge : edges) law(edge.second == 0, "around a cell every directed edge has its opposite");
    double const cube = c.model_size() * c.model_size() * c.model_size();
    for (std::size_t i = 0; i < c.cell_count(); ++i) {
        double const v = c.cell_volume(cell_index{i});
        law(v > 0, "cell volumes are positive");
        law(std::fabs(v - enclosed[i]) <= 1e-9 * cube, "cell volumes are those that the faces enclose");
    }
    return broken;
}

/// Exposure: while the cells of `n` fall in a random order, links with rock on both sides keep their state,
/// links with rock on one side are skin or pocket (the input's skin: skin), links with none are gone; the
/// lists of changes are complete, ascending and without repetition; the order within one update does not
/// matter. A few at a time, in large networks about a hundredth; O(400 links) at most.
template <exposure_policy E, link_network N>
[[nodiscard]] std::vector<std::string> exposure(E const& policy, N const& n) {
    std::vector<std::string> broken;
    auto const law = [&](bool holds, char const* what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(what);
    };
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        stream random(seed, stage::user, 0);
        std::vector<cell_index> left;
        for (std::size_t c = 0; c < n.cell_count(); ++c) left.push_back(cell_index{c});
        std::vector<cell_state> cells(n.cell_count(), cell_state::solid);
        std::vector<link_state> links(n.link_count(), link_state::bonded);
        for (link_state& l : links) {
            if (random.chance(0.2)) l = link_state::broken;
        }
        auto memory = policy.start(n, cells, links);
        exposure_change change;
        while (!left.empty()) {
            std::vector<cell_index> fallen;
            std::size_t const many = 1 + random.index_below(std::min(left.size(), std::max<std::size_t>(4, n.cell_count() / 64)));
            for (std::size_t k = 0; k < many; ++k) {
                std::size_t const at = random.index_below(left.size());
                fallen.push_back(left[at]);
                left[at] = left.back();
                left.pop_back();
            }
            for (cell_index const c : fallen) cells[c.value] = cell_state::air;
            auto const before = links;
            auto mirrored = links;
            auto mirror = memory;
            exposure_change ignored;
            policy.update(n, cells, std::span<cell_index const>(fallen), memory, std::span<link_state>(links), change);
            std::reverse(fallen.begin(), fallen.end());
            policy.update(n, cells, std::span<cell_index const>(fallen), mirror, std::span<link_state>(mirrored), ignored);
            law(links == mirrored, "the order within one update does not matter");
            std::vector<link_index> opened;
            std::vector<link_index> closed;
            for (std::size_t i = 0; i < links.size(); ++i) {
                if (!n.has_link(link_index{i})) continue;
                auto const ends = n.link_cells(link_index{i});
                bool const first = cells[ends[0].value] != cell_state::air;
                bool const second = ends[1].valid() && cells[ends[1].value] != cell_state::air;
                if (first && second) law(links[i] == before[i], "a link with rock on both sides keeps its state");
                if (!first && !second) law(links[i] == link_state::gone, "a link without rock is gone");
                if (first != second) {
                    law(links[i] == link_state::skin || (ends[1].valid() && links[i] == link_state::pocket),
                        "a link with rock on one side is skin or pocket, the input's skin is skin");
                }
                if (links[i] == link_state::skin && before[i] != link_state::skin) opened.push_back(link_index{i});
                if (links[i] != link_state::skin && before[i] == link_state::skin) closed.push_back(link_index{i});
            }
            law(change.opened == opened && change.closed == closed, "opened and closed list what changed, ascending, once");
        }
    }
    return broken;
}

/// Site pattern: pure, finite points, at least one.
template <site_pattern P>
[[nodiscard]] std::vector<std::string> sites(P const& pattern, solid const& s) {
    std::vector<std::string> broken;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        auto const a = pattern(s, seed);
        auto const b = pattern(s, seed);
        bool const equal = a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](vec3 const& p, vec3 const& q) {
                               return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
                           });
        if (a.empty()) {
            broken.push_back("a pattern returns at least one site; got none");
            return broken;
        }
        if (!std::all_of(a.begin(), a.end(), [](vec3 const& p) { return is_finite(p); })) {
            broken.push_back("sites are finite");
            return broken;
        }
        if (!equal) {
            broken.push_back("sites depend on the arguments only");
            return broken;
        }
    }
    return broken;
}

/// Executor: every block once, with the right bounds; the lowest exception reaches the caller.
template <executor E>
[[nodiscard]] std::vector<std::string> runs_blocks(E const& e) {
    std::vector<std::string> broken;
    if (e.thread_count() < 1) broken.push_back("thread_count() is at least 1");
    for (std::size_t const n : {0u, 1u, 7u, 64u, 1000u}) {
        for (std::size_t const grain : {1u, 3u, 64u, 5000u}) {
            std::vector<std::atomic<int>> hits(n);
            std::atomic<int> wrong = 0;
            e.for_blocks(n, grain, [&](std::size_t begin, std::size_t end) {
                if (begin % grain != 0 || end != std::min(begin + grain, n)) ++wrong;
                for (std::size_t i = begin; i < end; ++i) ++hits[i];
            });
            if (wrong != 0) broken.push_back("blocks begin at multiples of the grain and end a grain later");
            if (!std::all_of(hits.begin(), hits.end(), [](auto const& h) { return h == 1; })) {
                broken.push_back("every index is visited exactly once");
            }
        }
    }
    try {
        e.for_blocks(100, 1, [](std::size_t begin, std::size_t) {
            if (begin >= 40) throw std::runtime_error(std::to_string(begin));
        });
        broken.push_back("exceptions reach the caller");
    } catch (std::runtime_error const& error) {
        if (std::string(error.what()) != "40") broken.push_back("the exception of the lowest block reaches the caller");
    }
    std::sort(broken.begin(), broken.end());
    broken.erase(std::unique(broken.begin(), broken.end()), broken.end());
    return broken;
}

}  // namespace tafoni::laws

#endif
