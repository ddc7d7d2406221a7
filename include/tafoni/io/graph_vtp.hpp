/// \file
/// The links graph, the cells graph and paths of water as lines to look at.
#ifndef TAFONI_IO_GRAPH_VTP_HPP
#define TAFONI_IO_GRAPH_VTP_HPP

#include <tafoni/graph/concepts.hpp>
#include <tafoni/io/polyline_set.hpp>
#include <tafoni/io/write_vtp.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// What a run knows about the links; each is empty or has one entry per link slot.
struct link_channels {
    std::span<double const> life{};
    std::span<link_state const> states{};  ///< written as numbers: 0 bonded, 1 broken, 2 skin, 3 pocket, 4 gone
};

/// One path of water: the links in order, and the water that was left at each.
struct water_path {
    std::span<link_index const> links{};
    std::span<double const> water{};  ///< empty, or as long as `links`
};

namespace detail {

inline void require_length(char const* what, std::size_t got, std::size_t want, std::size_t at_least = 0) {
    if (got == want || (got == 0 && at_least == 0)) return;
    fail<invalid_input>(errc::attribute_length,
                        std::string("graph_vtp: got ") + std::to_string(got) + " entries of " + what + ", wanted " +
                            std::to_string(want),
                        {.kind = entity::attribute, .value = static_cast<double>(got), .limit = static_cast<double>(want)});
}

/// The used links as points with channels, and the way from a slot to its point.
struct link_points {
    static constexpr std::uint32_t none = link_index::none;

    std::vector<std::uint32_t> point_of{};
    std::vector<vec3> positions{};
    std::vector<mesh_channel> channels{};
};

template <class Network>
[[nodiscard]] link_points points_of_links(Network const& n, link_channels const& c) {
    require_length("life", c.life.size(), n.link_count());
    require_length("states", c.states.size(), n.link_count());
    link_points r;
    std::vector<double> life;
    std::vector<double> states;
    std::vector<double> areas;
    std::vector<double> interior;
    std::array<std::vector<double>, 3> normals{};
    r.point_of.assign(n.link_count(), link_points::none);
    for (std::size_t l = 0; l < n.link_count(); ++l) {
        link_index const link{l};
        if (!n.has_link(link)) continue;
        r.point_of[l] = static_cast<std::uint32_t>(r.positions.size());
        r.positions.push_back(n.link_centroid(link));
        if (!c.life.empty()) life.push_back(c.life[l]);
        if (!c.states.empty()) states.push_back(static_cast<double>(c.states[l]));
        areas.push_back(n.link_area(link));
        interior.push_back(n.link_cells(link)[1].valid() ? 1.0 : 0.0);
        vec3 const normal = n.link_normal(link);
        for (std::size_t d = 0; d < 3; ++d) normals[d].push_back(normal[static_cast<Eigen::Index>(d)]);
    }
    if (!c.life.empty()) r.channels.push_back({"life", std::move(life), channel_type::float64});
    if (!c.states.empty()) r.channels.push_back({"state", std::move(states), channel_type::uint8});
    r.channels.push_back({"area", std::move(areas), channel_type::float64});
    r.channels.push_back({"interior", std::move(interior), channel_type::uint8});
    char const* const names[] = {"nx", "ny", "nz"};
    for (std::size_t d = 0; d < 3; ++d) r.channels.push_back({names[d], std::move(normals[d]), channel_type::float32});
    return r;
}

struct write_links_fn {
    /// The links graph: a point per link, with its normal, area, life and state, and a line per pair of
    /// neighbours (Figure 6, right). O(links + neighbours).
    /// \throws invalid_input  `attribute_length`; `io_error` as `write_vtp`.
    template <link_network Network>
    void operator()(std::filesystem::path const& path, Network const& n, link_channels const& channels = {}) const {
        link_points points = points_of_links(n, channels);
        polyline_set lines;
        for (std::size_t l = 0; l < n.link_count(); ++l) {
            if (points.point_of[l] == link_points::none) continue;
            n.for_each_neighbor(link_index{l}, [&](link_index m) {
                if (m.value > l) lines.add_line({points.point_of[l], points.point_of[m.value]});
            });
        }
        lines.positions = std::move(points.positions);
        write_vtp(path, lines, points.channels);
    }
};

struct write_bonds_fn {
    /// The cells graph: a point per cell, a line per interior link with its life and state (Figure 6, left).
    /// `centroids` has one entry per cell. O(links).
    template <link_network Network>
    void operator()(std::filesystem::path const& path, Network const& n, std::span<vec3 const> centroids,
                    link_channels const& channels = {}) const {
        require_length("centroids", centroids.size(), n.cell_count(), 1);
        require_length("life", channels.life.size(), n.link_count());
        require_length("states", channels.states.size(), n.link_count());
        polyline_set lines;
        lines.positions.assign(centroids.begin(), centroids.end());
        mesh_channel life{.name = "life"};
        mesh_channel states{.name = "state", .type = channel_type::uint8};
        for (std::size_t l = 0; l < n.link_count(); ++l) {
            if (!n.has_link(link_index{l})) continue;
            auto const cells = n.link_cells(link_index{l});
            if (!cells[1].valid()) continue;
            lines.add_line({cells[0].value, cells[1].value});
            if (!channels.life.empty()) life.values.push_back(channels.life[l]);
            if (!channels.states.empty()) states.values.push_back(static_cast<double>(channels.states[l]));
        }
        std::vector<mesh_channel> of_lines;
        if (!channels.life.empty()) of_lines.push_back(std::move(life));
        if (!channels.states.empty()) of_lines.push_back(std::move(states));
        write_vtp(path, lines, {}, of_lines);
    }
};

struct write_paths_fn {
    /// Paths of water through the centroids of their links, with the water that was left at each (Figures 7
    /// and 10) and the number of the path. O(links of the paths).
    template <link_network Network>
    void operator()(std::filesystem::path const& path, Network const& n, std::span<water_path const> paths) const {
        polyline_set lines;
        mesh_channel water{.name = "water"};
        mesh_channel number{.name = "path", .type = channel_type::uint32};
        std::vector<std::uint32_t> line;
        for (std::size_t p = 0; p < paths.size(); ++p) {
            require_length("water", paths[p].water.size(), paths[p].links.size());
            line.clear();
            for (std::size_t i = 0; i < paths[p].links.size(); ++i) {
                link_index const l = paths[p].links[i];
                if (l.value >= n.link_count() || !n.has_link(l)) {
                    fail<invalid_input>(errc::index_out_of_range, "graph_vtp: a path runs through a link that is not there",
                                        {.kind = entity::link, .index = l.value});
                }
                line.push_back(static_cast<std::uint32_t>(lines.positions.size()));
                lines.positions.push_back(n.link_centroid(l));
                water.values.push_back(paths[p].water.empty() ? 1.0 : paths[p].water[i]);
            }
            if (line.size() < 2) continue;  // a point is no line
            lines.add_line(line);
            number.values.push_back(static_cast<double>(p));
        }
        write_vtp(path, lines, {std::move(water)}, {std::move(number)});
    }
};

}  // namespace detail

/// `write_links(path, network, {.life = ..., .states = ...})`.
inline constexpr detail::write_links_fn write_links{};
/// `write_bonds(path, network, centroids, {.life = ..., .states = ...})`.
inline constexpr detail::write_bonds_fn write_bonds{};
/// `write_paths(path, network, paths)`.
inline constexpr detail::write_paths_fn write_paths{};

}  // namespace tafoni

#endif
