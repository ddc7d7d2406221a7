/// \file
/// Links between cells and their neighbourhood: what percolation walks on.
#ifndef TAFONI_GRAPH_CONCEPTS_HPP
#define TAFONI_GRAPH_CONCEPTS_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace tafoni {

/// How a link takes part in the water's way.
enum class link_state : std::uint8_t {
    bonded,   ///< interior, life > 0, both cells solid
    broken,   ///< interior, life 0, at least one side solid: a conduit
    skin,     ///< one side solid, the other the outside: the input's skin, or a face laid open
    pocket,   ///< one side solid, the other an air pocket without a way out
    gone,     ///< no side solid: no water runs here
};

/// One of the two parts that a broken link leaves.
struct part {
    std::int64_t volume = 0;       ///< fixed point, units of 2^-52 of the network's volume
    std::size_t core_cells = 0;
    cell_index lowest_cell{};      ///< valid where the volumes of a split tie, to break the tie by
};

/// Which parts of a split fall.
enum class falling : std::uint8_t { neither, first, second, both };

/// What a cell is made of [Mateos et al., section 3].
enum class cell_state : std::uint8_t { solid, air, core };

/// One link as a policy sees it, by value. Fields that a policy does not read cost nothing after inlining.
struct link_view {
    link_index id{};
    std::array<cell_index, 2> cells{};  ///< the second is not valid on the input's skin
    vec3 centroid{0, 0, 0};             ///< of the link's area, in the model's frame
    vec3 normal{0, 0, 0};               ///< unit; out of the rock (from solid to air; bonded: from cells[0] to cells[1])
    double area = 0;                    ///< squared length unit, > 0
    double life = 0;                    ///< lambda in [0, 1]; 0 on skin
    double resistance = 0;              ///< rho at the centroid, in [0, 1]; 0 on skin
    link_state state = link_state::bonded;

    /// Flow resistance f_r = lambda rho, dimensionless, in [0, 1]; 0 for broken links and skin [section 5.1].
    [[nodiscard]] double flow_resistance() const noexcept {
        return state == link_state::bonded ? life * resistance : 0.0;
    }
};

namespace detail {
struct link_visitor {
    void operator()(link_index) const;
};
}  // namespace detail

/// Cells joined by links, and links next to links. May be stored (`link_graph`) or computed (`voxel_cells`).
///
/// Laws: link slots are 0 .. link_count() - 1; `has_link(l)` says whether slot l is used, and the
/// other members may only be asked of used slots. `link_cells(l)[0]` is valid; `[1]` is valid for
/// interior links and not valid for the skin. `link_normal` is a unit vector out of cells[0].
/// `for_each_cell_link(c, f)` visits the used links of c once each, `for_each_neighbor(l, f)` visits
/// Neigh(l) of section 4.2 once each, without l, always in the same order; Neigh is symmetric.
template <class N>
concept link_network = requires(N const& n, cell_index c, link_index l, detail::link_visitor f) {
    { n.cell_count() } -> std::same_as<std::size_t>;
    { n.cell_volume(c) } -> std::same_as<double>;
    { n.link_count() } -> std::same_as<std::size_t>;
    { n.has_link(l) } -> std::same_as<bool>;
    { n.link_cells(l) } -> std::same_as<std::array<cell_index, 2>>;
    { n.link_area(l) } -> std::same_as<double>;
    { n.link_centroid(l) } -> std::same_as<vec3>;
    { n.link_normal(l) } -> std::same_as<vec3>;
    { n.for_each_cell_link(c, f) } -> std::same_as<void>;
    { n.for_each_neighbor(l, f) } -> std::same_as<void>;
};

}  // namespace tafoni

#endif
