/// \file
/// The links graph and the cells graph as Boost.Graph sees them.
#ifndef TAFONI_GRAPH_BOOST_VIEW_HPP
#define TAFONI_GRAPH_BOOST_VIEW_HPP

#include <tafoni/graph/link_graph.hpp>

#include <boost/graph/graph_traits.hpp>
#include <boost/graph/properties.hpp>
#include <boost/iterator/counting_iterator.hpp>
#include <boost/iterator/transform_iterator.hpp>
#include <boost/property_map/property_map.hpp>

#include <cstdint>
#include <limits>
#include <utility>

namespace tafoni {

namespace detail {

/// An edge seen from one end; `id` tells parallel edges apart.
struct boost_edge {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t id = 0;
    friend bool operator==(boost_edge const& a, boost_edge const& b) noexcept {
        // An undirected edge is the same from both ends.
        return a.id == b.id && ((a.from == b.from && a.to == b.to) || (a.from == b.to && a.to == b.from));
    }
};

struct boost_view_category : boost::vertex_list_graph_tag,
                             boost::incidence_graph_tag,
                             boost::adjacency_graph_tag {};

/// What both views share: vertices 0 .. n-1 and lists of `link_index` around each.
template <class Derived>
struct boost_view_types {
    using vertex_descriptor = std::uint32_t;
    using edge_descriptor = boost_edge;
    using directed_category = boost::undirected_tag;
    using edge_parallel_category = boost::allow_parallel_edge_tag;
    using traversal_category = boost_view_category;
    using vertices_size_type = std::size_t;
    using degree_size_type = std::size_t;
    using edges_size_type = std::size_t;
    using vertex_iterator = boost::counting_iterator<std::uint32_t>;

    struct to_edge {
        Derived const* view = nullptr;
        std::uint32_t from = 0;
        boost_edge operator()(link_index l) const noexcept { return view->edge_at(from, l); }
    };
    struct to_vertex {
        Derived const* view = nullptr;
        std::uint32_t from = 0;
        std::uint32_t operator()(link_index l) const noexcept { return view->edge_at(from, l).to; }
    };
    using out_edge_iterator = boost::transform_iterator<to_edge, link_index const*, boost_edge, boost_edge>;
    using adjacency_iterator = boost::transform_iterator<to_vertex, link_index const*, std::uint32_t, std::uint32_t>;
    using edge_iterator = void;
    using in_edge_iterator = void;

    static vertex_descriptor null_vertex() noexcept { return std::numeric_limits<std::uint32_t>::max(); }
};

}  // namespace detail

/// Links as vertices, pairs of neighbours as edges: G_L of the paper. Valid while the graph lives.
/// Models Boost's VertexListGraph, IncidenceGraph and AdjacencyGraph; descriptors are `std::uint32_t`.
struct links_graph_view : detail::boost_view_types<links_graph_view> {
    link_graph const* graph = nullptr;

    explicit links_graph_view(link_graph const& g) noexcept : graph(&g) {}
    [[nodiscard]] std::size_t size() const noexcept { return graph->link_count(); }
    [[nodiscard]] std::span<link_index const> around(std::uint32_t v) const noexcept {
        return graph->neighbors(link_index{v});
    }
    [[nodiscard]] detail::boost_edge edge_at(std::uint32_t from, link_index l) const noexcept { return {from, l.value, 0}; }
};

/// Cells as vertices, interior links as edges: G_C of the paper, a multigraph. Edge `id` is the link.
struct cells_graph_view : detail::boost_view_types<cells_graph_view> {
    link_graph const* graph = nullptr;

    explicit cells_graph_view(link_graph const& g) noexcept : graph(&g) {}
    [[nodiscard]] std::size_t size() const noexcept { return graph->cell_count(); }
    [[nodiscard]] std::span<link_index const> around(std::uint32_t v) const noexcept {
        return graph->bonds_of(cell_index{v});
    }
    [[nodiscard]] detail::boost_edge edge_at(std::uint32_t from, link_index l) const noexcept {
        return {from, graph->other_cell(l, cell_index{from}).value, l.value};
    }
};

namespace detail {

/// Boost finds these by argument-dependent lookup.
template <class View>
concept boost_view = std::same_as<View, links_graph_view> || std::same_as<View, cells_graph_view>;

}  // namespace detail

template <detail::boost_view V>
[[nodiscard]] std::size_t num_vertices(V const& g) noexcept {
    return g.size();
}
template <detail::boost_view V>
[[nodiscard]] auto vertices(V const& g) noexcept {
    using iterator = typename V::vertex_iterator;
    return std::pair{iterator{0}, iterator{static_cast<std::uint32_t>(g.size())}};
}
template <detail::boost_view V>
[[nodiscard]] std::size_t out_degree(std::uint32_t v, V const& g) noexcept {
    return g.around(v).size();
}
template <detail::boost_view V>
[[nodiscard]] auto out_edges(std::uint32_t v, V const& g) noexcept {
    using iterator = typename V::out_edge_iterator;
    auto const links = g.around(v);
    typename V::to_edge const f{&g, v};
    return std::pair{iterator{links.data(), f}, iterator{links.data() + links.size(), f}};
}
template <detail::boost_view V>
[[nodiscard]] auto adjacent_vertices(std::uint32_t v, V const& g) noexcept {
    using iterator = typename V::adjacency_iterator;
    auto const links = g.around(v);
    typename V::to_vertex const f{&g, v};
    return std::pair{iterator{links.data(), f}, iterator{links.data() + links.size(), f}};
}
template <detail::boost_view V>
[[nodiscard]] std::uint32_t source(detail::boost_edge const& e, V const&) noexcept {
    return e.from;
}
template <detail::boost_view V>
[[nodiscard]] std::uint32_t target(detail::boost_edge const& e, V const&) noexcept {
    return e.to;
}
template <detail::boost_view V>
[[nodiscard]] boost::typed_identity_property_map<std::uint32_t> get(boost::vertex_index_t, V const&) noexcept {
    return {};
}

}  // namespace tafoni

namespace boost {

template <>
struct property_map<tafoni::links_graph_view, vertex_index_t> {
    using type = typed_identity_property_map<std::uint32_t>;
    using const_type = type;
};
template <>
struct property_map<tafoni::cells_graph_view, vertex_index_t> {
    using type = typed_identity_property_map<std::uint32_t>;
    using const_type = type;
};

}  // namespace boost

#endif
