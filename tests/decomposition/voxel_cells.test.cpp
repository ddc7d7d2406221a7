#include "support/code_of.hpp"

#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/graph/concepts.hpp>

#include <map>
#include <set>

using namespace tafoni;
using tafoni_test::code_of;

static_assert(cell_complex<voxel_cells>);
static_assert(link_network<voxel_cells>);

namespace {

constexpr auto all_rock = [](vec3 const&) { return true; };

voxel_cells random_voxels(std::uint64_t seed) {
    stream random(seed, stage::user, 0);
    voxel_cells_options o{.spacing = {1, 0.5, 2}, .origin = {-3, 7, 100}};
    for (std::size_t& s : o.size) s = 1 + random.index_below(7);
    for (bool& side : o.artificial) side = random.chance(0.3);
    double const share = random.uniform01();
    return voxel_cells::from_predicate(o, [&](vec3 const&) { return random.chance(share); });
}

}  // namespace

TEST_CASE("cells are the rock voxels, numbered x fastest, and found again") {
    std::vector<std::uint8_t> rock(3 * 4 * 5, 0);
    for (std::size_t i = 0; i < rock.size(); i += 3) rock[i] = 1;
    voxel_cells const v = voxel_cells::from_array({.size = {3, 4, 5}, .spacing = {2, 3, 4}, .origin = {10, 20, 30}}, rock);
    REQUIRE(v.cell_count() == 20);
    std::uint32_t next = 0;
    for (std::size_t n = 0; n < rock.size(); ++n) {
        std::size_t const i = n % 3;
        std::size_t const j = n / 3 % 4;
        std::size_t const k = n / 12;
        REQUIRE(v.cell_at(i, j, k).valid() == (rock[n] != 0));
        vec3 const centre = voxel_cells::centre(v.grid(), i, j, k);
        REQUIRE(v.locate(centre) == v.cell_at(i, j, k));
        if (rock[n] == 0) continue;
        REQUIRE(v.cell_at(i, j, k) == cell_index{next});
        REQUIRE(v.voxel_of(cell_index{next}) == std::array<std::uint32_t, 3>{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(k)});
        REQUIRE(v.cell_centroid(cell_index{next}) == centre);
        REQUIRE(v.cell_volume(cell_index{next}) == 24);
        ++next;
    }
    REQUIRE_FALSE(v.locate({9.9, 21, 31}).valid());
    REQUIRE_FALSE(v.locate({16.1, 21, 31}).valid());
    REQUIRE_FALSE(v.locate({std::numeric_limits<double>::quiet_NaN(), 21, 31}).valid());
}

TEST_CASE("around every cell each directed edge has its opposite, and normals lead from front to back") {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        INFO("seed " << seed);
        voxel_cells const v = random_voxels(seed);
        std::vector<std::map<std::pair<std::uint32_t, std::uint32_t>, int>> edges(v.cell_count());
        std::vector<double> six_volumes(v.cell_count(), 0.0);
        for (std::uint32_t f = 0; f < v.face_count(); ++f) {
            auto const cells = v.face_cells(face_index{f});
            auto const loop = v.face_loop(face_index{f}, 0);
            REQUIRE(v.loop_count(face_index{f}) == 1);
            REQUIRE(cells[0].valid());
            REQUIRE((!v.face_patch(face_index{f}).valid() || !cells[1].valid()));
            for (std::size_t k = 0; k < 4; ++k) {
                REQUIRE(loop[k].value < v.vertex_count());
                std::pair const e{loop[k].value, loop[(k + 1) % 4].value};
                ++edges[cells[0].value][e];
                if (cells[1].valid()) ++edges[cells[1].value][{e.second, e.first}];
            }
            for (std::size_t k = 1; k + 1 < 4; ++k) {
                for (std::size_t s = 0; s < 2; ++s) {
                    if (!cells[s].valid()) continue;
                    vec3 const o = v.cell_centroid(cells[s]);
                    double const cone = dot(v.position(loop[0]) - o, cross(v.position(loop[k]) - o, v.position(loop[k + 1]) - o));
                    six_volumes[cells[s].value] += s == 0 ? cone : -cone;
                }
            }
        }
        for (std::uint32_t c = 0; c < v.cell_count(); ++c) {
            REQUIRE(edges[c].size() == 24);
            for (auto const& [e, count] : edges[c]) {
                REQUIRE(count == 1);
                REQUIRE(edges[c].contains({e.second, e.first}));
            }
            REQUIRE(six_volumes[c] == Approx(6 * v.cell_volume(cell_index{c})).epsilon(1e-12));
        }
    }
}

TEST_CASE("links of voxels are symmetric, know their cells, and no link neighbours itself", "[law3]") {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        INFO("seed " << seed);
        voxel_cells const v = random_voxels(seed);
        std::vector<std::set<link_index>> neigh(v.link_count());
        std::vector<int> ends(v.link_count(), 0);
        for (std::uint32_t c = 0; c < v.cell_count(); ++c) {
            v.for_each_cell_link(cell_index{c}, [&](link_index l) {
                REQUIRE(v.has_link(l));
                auto const cells = v.link_cells(l);
                REQUIRE((cells[0] == cell_index{c} || cells[1] == cell_index{c}));
                ++ends[l.value];
            });
        }
        for (std::uint32_t l = 0; l < v.link_count(); ++l) {
            link_index const link{l};
            REQUIRE(v.has_link(link) == (ends[l] > 0));
            if (!v.has_link(link)) continue;
            REQUIRE(ends[l] == (v.link_cells(link)[1].valid() ? 2 : 1));
            REQUIRE(length(v.link_normal(link)) == 1);
            auto const cells = v.link_cells(link);
            REQUIRE(dot(v.link_normal(link), v.link_centroid(link) - v.cell_centroid(cells[0])) > 0);
            if (cells[1].valid()) REQUIRE(dot(v.link_normal(link), v.link_centroid(link) - v.cell_centroid(cells[1])) < 0);
            v.for_each_neighbor(link, [&](link_index m) {
                REQUIRE(m != link);
                REQUIRE(v.has_link(m));
                REQUIRE(neigh[l].insert(m).second);
            });
        }
        for (std::uint32_t l = 0; l < v.link_count(); ++l) {
            for (link_index const m : neigh[l]) REQUIRE(neigh[m.value].contains(link_index{l}));
        }
    }
}

TEST_CASE("the sum of skin areas, artificial sides included or not, is that of the box") {
    voxel_cells_options o{.size = {3, 4, 5}, .spacing = {1, 0.5, 2}};
    auto const skin = [](voxel_cells const& v) {
        double area = 0;
        for (std::uint32_t l = 0; l < v.link_count(); ++l) {
            if (v.has_link(link_index{l}) && !v.link_cells(link_index{l})[1].valid()) area += v.link_area(link_index{l});
        }
        return area;
    };
    REQUIRE(skin(voxel_cells::from_predicate(o, all_rock)) == 2 * (3 * 2 + 3 * 10 + 2 * 10));
    o.artificial = {false, false, false, true, true, false};  // +y and -z
    REQUIRE(skin(voxel_cells::from_predicate(o, all_rock)) == 2 * (3 * 2 + 3 * 10 + 2 * 10) - 3 * 10 - 3 * 2);
    // Only rock that is cut off by the box is artificial there; skin inside the grid stays skin.
    auto const lower = voxel_cells::from_predicate(o, [](vec3 const& p) { return p[2] > 2; });
    REQUIRE(skin(lower) == 2 * (3 * 2 + 3 * 8 + 2 * 8) - 3 * 8);
}

TEST_CASE("one voxel, no rock, full rock, checkerboard and voxels that touch by an edge are fine") {
    auto const one = voxel_cells::from_predicate({.size = {1, 1, 1}}, all_rock);
    REQUIRE(one.cell_count() == 1);
    REQUIRE(one.face_count() == 6);
    REQUIRE(one.vertex_count() == 8);
    REQUIRE(one.model_size() == Approx(std::sqrt(3.0)));
    auto const none = voxel_cells::from_predicate({.size = {5, 5, 5}}, [](vec3 const&) { return false; });
    REQUIRE(none.cell_count() == 0);
    REQUIRE(none.face_count() == 0);
    auto const check = voxel_cells::from_indices({.size = {6, 6, 6}}, [](std::size_t i, std::size_t j, std::size_t k) {
        return (i + j + k) % 2 == 0;
    });
    REQUIRE(check.cell_count() == 108);
    REQUIRE(check.face_count() == 648);
    auto const edge = voxel_cells::from_indices({.size = {2, 2, 1}}, [](std::size_t i, std::size_t j, std::size_t) { return i == j; });
    REQUIRE(edge.face_count() == 12);
    for (std::uint32_t l = 0; l < edge.link_count(); ++l) {
        if (!edge.has_link(link_index{l})) continue;
        edge.for_each_neighbor(link_index{l}, [&](link_index m) {
            REQUIRE(edge.link_cells(m)[0] == edge.link_cells(link_index{l})[0]);
        });
    }
}

TEST_CASE("voxel grids refuse no size, too much size, bad spacing and buffers of another length") {
    REQUIRE(code_of([] { voxel_cells::from_predicate({.size = {4, 0, 4}}, all_rock); }) == errc::bad_parameter);
    std::size_t const huge = 0xFFFFFFFFU;
    REQUIRE(code_of([&] { voxel_cells::from_predicate({.size = {huge, huge, huge}}, all_rock); }) == errc::size_overflow);
    REQUIRE(code_of([&] { voxel_cells::from_predicate({.size = {~std::size_t{0}, 1, 1}}, all_rock); }) == errc::size_overflow);
    REQUIRE(code_of([&] { voxel_cells::from_predicate({.size = {1200, 1200, 1200}}, all_rock); }) == errc::size_overflow);
    for (double const bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        REQUIRE(code_of([&] { voxel_cells::from_predicate({.size = {1, 1, 1}, .spacing = {1, bad, 1}}, all_rock); }) ==
                errc::bad_parameter);
    }
    REQUIRE(code_of([] {
                voxel_cells::from_predicate({.size = {1, 1, 1}, .origin = {0, 0, std::numeric_limits<double>::infinity()}}, all_rock);
            }) == errc::bad_parameter);
    std::vector<std::uint8_t> const buffer(7, 1);
    REQUIRE(code_of([&] { voxel_cells::from_array({.size = {2, 2, 2}}, buffer); }) == errc::attribute_length);
    // Anisotropic grids of 1 : 1e6 are fine.
    REQUIRE(voxel_cells::from_predicate({.size = {2, 2, 2}, .spacing = {1, 1e-6, 1}}, all_rock).cell_volume(cell_index{0U}) == 1e-6);
}

TEST_CASE("a million voxels take less than six bytes each") {
    auto const v = voxel_cells::from_predicate({.size = {100, 100, 100}}, all_rock);
    REQUIRE(v.bytes() < 6000000);
}
