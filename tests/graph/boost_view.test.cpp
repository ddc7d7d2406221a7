#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/voxel_cells.hpp>
#include <tafoni/graph/boost_view.hpp>
#include <tafoni/graph/connectivity.hpp>
#include <tafoni/graph/make_link_graph.hpp>

#include <boost/concept/assert.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/graph_concepts.hpp>

using namespace tafoni;

BOOST_CONCEPT_ASSERT((boost::VertexListGraphConcept<links_graph_view>));
BOOST_CONCEPT_ASSERT((boost::IncidenceGraphConcept<links_graph_view>));
BOOST_CONCEPT_ASSERT((boost::AdjacencyGraphConcept<links_graph_view>));
BOOST_CONCEPT_ASSERT((boost::VertexListGraphConcept<cells_graph_view>));
BOOST_CONCEPT_ASSERT((boost::IncidenceGraphConcept<cells_graph_view>));
BOOST_CONCEPT_ASSERT((boost::AdjacencyGraphConcept<cells_graph_view>));

namespace {

link_graph sparse_rock(std::uint64_t seed) {
    stream random(seed, stage::user, 0);
    return make_link_graph(
        voxel_cells::from_predicate({.size = {8, 7, 6}}, [&](vec3 const&) { return random.chance(0.35); }));
}

/// Steps from one vertex to all others, by Boost's own search.
template <class View>
std::vector<int> steps_from(View const& g, std::uint32_t start) {
    std::vector<int> steps(num_vertices(g), -1);
    steps[start] = 0;
    auto const by = [&](auto const& index) {
        return boost::make_iterator_property_map(steps.begin(), index);
    };
    boost::breadth_first_search(
        g, start,
        boost::visitor(boost::make_bfs_visitor(boost::record_distances(by(get(boost::vertex_index, g)), boost::on_tree_edge()))));
    return steps;
}

}  // namespace

TEST_CASE("Boost's connected components of the cells graph are those of connectivity") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        link_graph const graph = sparse_rock(seed);
        cells_graph_view const g(graph);
        std::vector<int> label(num_vertices(g));
        boost::connected_components(g, label.data());
        connectivity const c(graph);
        for (std::uint32_t a = 0; a < graph.cell_count(); ++a) {
            for (std::uint32_t b = 0; b < a; ++b) {
                REQUIRE((label[a] == label[b]) == (c.component_of(cell_index{a}) == c.component_of(cell_index{b})));
            }
        }
    }
}

TEST_CASE("Boost's components of the links graph are one per piece of rock joined by edges of cells") {
    link_graph const graph = make_link_graph(
        voxel_cells::from_indices({.size = {5, 1, 1}}, [](std::size_t i, std::size_t, std::size_t) { return i != 2; }));
    links_graph_view const g(graph);
    std::vector<int> label(num_vertices(g));
    REQUIRE(boost::connected_components(g, label.data()) == 2);
}

TEST_CASE("Boost's breadth-first search counts steps as the lattice does") {
    auto const rock = voxel_cells::from_predicate({.size = {4, 5, 6}}, [](vec3 const&) { return true; });
    link_graph const graph = make_link_graph(rock);
    auto const steps = steps_from(cells_graph_view(graph), 0);
    for (std::uint32_t c = 0; c < graph.cell_count(); ++c) {
        auto const v = rock.voxel_of(cell_index{c});
        REQUIRE(steps[c] == static_cast<int>(v[0] + v[1] + v[2]));
    }
    auto const along_links = steps_from(links_graph_view(graph), 0);
    for (link_index const n : graph.neighbors(link_index{0U})) REQUIRE(along_links[n.value] == 1);
    REQUIRE(*std::min_element(along_links.begin(), along_links.end()) == 0);
}

TEST_CASE("edges of the views are the links and the pairs of neighbours") {
    link_graph const graph = sparse_rock(3);
    cells_graph_view const cells(graph);
    std::size_t ends = 0;
    for (auto [v, last] = vertices(cells); v != last; ++v) {
        for (auto [e, end] = out_edges(*v, cells); e != end; ++e) {
            REQUIRE(source(*e, cells) == *v);
            REQUIRE(graph.other_cell(link_index{(*e).id}, cell_index{*v}).value == target(*e, cells));
            ++ends;
        }
    }
    REQUIRE(ends == 2 * graph.interior_link_count());
}
